//! What `check` and `verify` print for programs: findings, the summary, every lesson, and the ledger.

use super::course::CourseResults;
use labspec::check::{Checked, Claim, Divergence, RanLab, SnapshotResult};
use labspec::ledger::{Count, Entry, Evidence, Outcome, State, Subject};
use labspec::report::{self, key, set_number, set_place};
use labspec::source::SourceFile;
use labspec::verify::{Answer, Measured, Quote};
use serde_json::{Map, Value, json};

/// The whole report, and what it comes to. `sources` are the files that places lie in.
pub(super) fn value(name: &str, outcome: Outcome, results: &CourseResults, sources: &[&SourceFile]) -> Value {
    let CourseResults { checked, ledger, suppressed, .. } = results;
    let mut value = report::json(&results.findings, sources);
    value["summary"]["outcome"] = json!(outcome.as_str());
    value["summary"]["claims"] =
        Subject::ALL.iter().map(|s| (key(s.as_str()), count(&ledger.count(*s)))).collect();
    let allowed = suppressed.allowed.iter().map(|a| {
        let mut value = json!({"code": a.finding.code, "why": a.why});
        set_place(&mut value, sources, &a.finding.path, &a.finding.span);
        value
    });
    value["aside"] = json!({
        "ignored": suppressed.ignored.len(), "known": suppressed.baselined.len(), "allowed": allowed.collect::<Vec<_>>(),
    });
    value["lessons"] = checked.iter().map(lesson).collect();
    value["ledger"] = ledger.entries().iter().map(|e| entry(e, sources)).collect();
    report::report(name, value)
}

fn count(c: &Count) -> Value {
    json!({
        "simulated": c.simulated, "computed": c.computed, "false": c.wrong, "unchecked": c.unchecked,
        "leftOut": c.left_out, "known": c.baselined, "notClaimed": c.not_claimed,
    })
}

fn entry(e: &Entry, sources: &[&SourceFile]) -> Value {
    let evidence = match e.state {
        State::True(Evidence::Simulated) => json!("simulated"),
        State::True(Evidence::Computed) => json!("computed"),
        _ => Value::Null,
    };
    let mut value = json!({"subject": key(e.subject.as_str()), "owner": e.owner, "what": e.what});
    set_place(&mut value, sources, &e.path, &e.span);
    value["state"] = json!(key(e.state.as_str()));
    value["evidence"] = evidence;
    value["word"] = json!(e.word);
    value["remark"] = json!(e.remark);
    value
}

fn lesson(c: &Checked) -> Value {
    let labs: Vec<Value> = c.labs.iter().map(lab).collect();
    let claims: Vec<Value> = c.claims.iter().map(|of| claim(of, c)).collect();
    let snapshots: Vec<Value> = c.snapshots.iter().map(snapshot_json).collect();
    json!({"file": &**c.lesson.file.path(), "labs": labs, "claims": claims, "snapshots": snapshots})
}

/// What became of the snapshot of a lab.
pub(super) fn snapshot_json(k: &SnapshotResult) -> Value {
    let first = |d: &Divergence| {
        let mut value = json!({"run": d.run, "trace": d.trace, "time": null});
        set_number(&mut value, "time", d.time);
        value["stored"] = json!(d.stored);
        value["now"] = json!(d.now);
        value["tolerance"] = json!(d.tolerance);
        value["line"] = json!(d.line);
        value
    };
    json!({
        "lab": k.lab, "state": key(k.state.as_str()), "changes": k.changes, "rows": k.rows,
        "divergence": k.divergence.as_ref().map(first), "reason": k.reason,
    })
}

fn lab(l: &RanLab) -> Value {
    let tried = l.tried.as_ref();
    let mut value = json!({
        "address": l.address.to_string(), "title": l.title, "runs": l.runs, "ran": l.ran,
        "broke": tried.map(|t| t.broke), "seconds": null, "covered": null, "skipped": tried.map(|t| t.skipped),
        "ended": tried.and_then(|t| t.ended.clone()),
    });
    if let Some(t) = tried {
        set_number(&mut value, "seconds", t.wanted);
        set_number(&mut value, "covered", t.covered);
    }
    value
}

fn claim(claim: &Claim, c: &Checked) -> Value {
    let j = &claim.judgement;
    let mut value = json!({"name": claim.name});
    set_place(&mut value, &[&c.lesson.file], c.lesson.file.path(), &claim.span);
    value["answer"] = j.answer.as_ref().map_or(Value::Null, answer);
    value["quotes"] = j.quotes.iter().map(quote).collect();
    let exact = j.exact.iter();
    value["closedForms"] = exact
        .map(|e| json!({"trace": e.trace, "state": key(e.state.as_str()), "reason": e.remark}))
        .collect();
    let runs = j.runs.iter();
    value["runs"] = runs.map(|r| json!({"name": r.name, "broke": r.broke, "expected": r.expected})).collect();
    let measures: Map<String, Value> = j.measures.iter().map(|m| (m.name.clone(), measure(m))).collect();
    value["measures"] = Value::Object(measures);
    value
}

fn answer(a: &Answer) -> Value {
    let option = |w: &labspec::verify::Weight| {
        let mut value = json!({"option": w.option, "holds": w.holds, "margin": null, "spread": null});
        for (key, x) in [("margin", w.margin), ("spread", w.spread)] {
            if let Some(x) = x {
                set_number(&mut value, key, x);
            }
        }
        value
    };
    let options: Vec<Value> = a.weights.iter().map(option).collect();
    json!({"verdict": a.verdict.as_str(), "reason": a.reason, "options": options})
}

fn quote(q: &Quote) -> Value {
    let mut value = json!({"text": q.text, "verdict": q.verdict(), "reason": q.reason});
    set_number(&mut value, "computed", q.computed);
    value
}

fn measure(m: &Measured) -> Value {
    let mut value = json!({"value": null, "halved": null});
    set_number(&mut value, "value", m.value);
    if let Some(halved) = m.halved {
        set_number(&mut value, "halved", halved);
    }
    value
}
