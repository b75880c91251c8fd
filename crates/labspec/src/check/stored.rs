//! What was found in a lesson, written down and read back, bit for bit.
//!
//! Reading takes nothing for granted: what is not exactly what was written gives `None`.

use super::{Claim, Divergence, LabOutcome, RanLab, SnapshotResult, Tried};
use crate::finding::{Applicability, ClaimId, Finding, Fix, Place, Severity};
use crate::ledger::{Evidence, State};
use crate::rules;
use crate::spec::LabAddress;
use crate::verify::{Answer, ClosedForm, Judgement, Measured, Quote, QuoteState, RunReport, Verdict, Weight};
use labspec_finding::Position;
use serde_json::{Value, json};
use std::ops::Range;
use std::sync::Arc;

const SEVERITIES: [Severity; 3] = [Severity::Error, Severity::Warning, Severity::Note];
const APPLICABILITIES: [Applicability; 3] =
    [Applicability::Safe, Applicability::Unsafe, Applicability::Display];
const EVIDENCE: [Evidence; 2] = [Evidence::Computed, Evidence::Simulated];
const STATES: [State; 6] = [
    State::True(Evidence::Computed),
    State::True(Evidence::Simulated),
    State::False,
    State::Unchecked,
    State::LeftOut,
    State::NotClaimed,
];
const QUOTES: [QuoteState; 3] = [QuoteState::Right, QuoteState::Wrong, QuoteState::Unclear];
const VERDICTS: [Verdict; 7] = [
    Verdict::Verified,
    Verdict::Computed,
    Verdict::Fragile,
    Verdict::Ambiguous,
    Verdict::Refuted,
    Verdict::Failed,
    Verdict::Unverified,
];

/// Everything that was found, as JSON; `None` for what could not be read back as it is.
pub fn write(found: &LabOutcome) -> Option<Value> {
    let value = written(found);
    let again = read(&value)?;
    (written(&again) == value).then_some(value)
}

fn written(found: &LabOutcome) -> Value {
    json!([
        found.findings.iter().map(finding).collect::<Vec<_>>(),
        found.labs.iter().map(lab).collect::<Vec<_>>(),
        found.claims.iter().map(claim).collect::<Vec<_>>(),
        found.snapshots.iter().map(snapshot_json).collect::<Vec<_>>(),
    ])
}

/// What was written.
pub fn read(value: &Value) -> Option<LabOutcome> {
    let [findings, labs, claims, snapshots] = parts(value)?;
    Some(LabOutcome {
        findings: list(findings, read_finding)?,
        labs: list(labs, read_lab)?,
        claims: list(claims, read_claim)?,
        snapshots: list(snapshots, read_kept)?,
    })
}

fn finding(f: &Finding) -> Value {
    let fix = |fix: &Fix| json!([span(&fix.span), fix.text, place_in(&APPLICABILITIES, &fix.applicability)]);
    let related: Vec<Value> = f.related.iter().map(|p| json!([&*p.path, span(&p.span), p.label])).collect();
    json!([
        f.code,
        place_in(&SEVERITIES, &f.severity),
        &*f.path,
        span(&f.span),
        f.position.map(|p| [p.line, p.column]),
        f.message,
        f.why,
        f.help,
        f.fix.as_ref().map(fix),
        related,
        f.claim.as_ref().map(|c| [&c.owner, &c.part, &c.result])
    ])
}

fn read_finding(value: &Value) -> Option<Finding> {
    let [code, severity, path, at, position, message, why, help, fix, related, claim] = parts(value)?;
    let read_fix = |value: &Value| {
        let [at, written, who] = parts(value)?;
        Some(Fix {
            span: read_span(at)?,
            text: text(written)?,
            applicability: one_of(&APPLICABILITIES, who)?,
        })
    };
    let place = |value: &Value| {
        let [path, at, label] = parts(value)?;
        Some(Place { path: Arc::from(path.as_str()?), span: read_span(at)?, label: text(label)? })
    };
    let read_claim = |value: &Value| {
        let [owner, part, result] = parts(value)?;
        Some(Box::new(ClaimId { owner: text(owner)?, part: text(part)?, result: text(result)? }))
    };
    let read_position = |value: &Value| {
        let [line, column] = parts(value)?;
        Some(Position { line: count(line)?, column: count(column)? })
    };
    Some(Finding {
        code: rules::find(code.as_str()?)?.code,
        severity: one_of(&SEVERITIES, severity)?,
        path: Arc::from(path.as_str()?),
        span: read_span(at)?,
        position: maybe(position, read_position)?,
        message: text(message)?,
        why: maybe(why, text)?,
        help: maybe(help, text)?,
        fix: maybe(fix, read_fix)?,
        related: list(related, place)?,
        claim: maybe(claim, read_claim)?,
    })
}

fn lab(l: &RanLab) -> Value {
    let address = match &l.address {
        LabAddress::Lab(n) => json!([null, n]),
        LabAddress::Sim { quiz, question } => json!([quiz, question]),
    };
    let tried = |t: &Tried| json!([t.runs, bits(t.wanted), bits(t.covered), t.skipped, t.broke, t.ended]);
    json!([address, l.title, l.runs, l.ran, l.tried.as_ref().map(tried), l.mistakes, l.expected])
}

fn read_lab(value: &Value) -> Option<RanLab> {
    let [address, title, runs, ran, tried, mistakes, expected] = parts(value)?;
    let [quiz, number] = parts(address)?;
    let number = count(number)?;
    let read_tried = |value: &Value| {
        let [runs, wanted, covered, skipped, broke, ended] = parts(value)?;
        Some(Tried {
            runs: count(runs)?,
            wanted: number_of(wanted)?,
            covered: number_of(covered)?,
            skipped: count(skipped)?,
            broke: broke.as_bool()?,
            ended: maybe(ended, text)?,
        })
    };
    Some(RanLab {
        address: match maybe(quiz, text)? {
            None => LabAddress::Lab(number),
            Some(quiz) => LabAddress::Sim { quiz, question: number },
        },
        title: text(title)?,
        runs: count(runs)?,
        ran: ran.as_bool()?,
        tried: maybe(tried, read_tried)?,
        mistakes: count(mistakes)?,
        expected: expected.as_bool()?,
    })
}

fn snapshot_json(k: &SnapshotResult) -> Value {
    let divergence = |d: &Divergence| {
        json!([d.run, d.trace, bits(d.time), d.stored, d.now, d.tolerance.map(bits), d.line, d.picture])
    };
    let state = place_in(&STATES, &k.state);
    json!([k.lab, span(&k.span), state, k.changes, k.divergence.as_ref().map(divergence), k.rows, k.reason])
}

fn read_kept(value: &Value) -> Option<SnapshotResult> {
    let [lab, at, state, changes, divergence, rows, reason] = parts(value)?;
    let read_divergence = |value: &Value| {
        let [run, trace, time, stored, now, tolerance, line, picture] = parts(value)?;
        Some(Divergence {
            run: text(run)?,
            trace: text(trace)?,
            time: number_of(time)?,
            stored: text(stored)?,
            now: text(now)?,
            tolerance: maybe(tolerance, number_of)?,
            line: count(line)?,
            picture: list(picture, text)?,
        })
    };
    Some(SnapshotResult {
        lab: text(lab)?,
        span: read_span(at)?,
        state: one_of(&STATES, state)?,
        changes: list(changes, text)?,
        divergence: maybe(divergence, read_divergence)?,
        rows: count(rows)?,
        reason: text(reason)?,
    })
}

fn claim(c: &Claim) -> Value {
    let j = &c.judgement;
    let weight = |w: &Weight| json!([w.option, w.holds, w.margin.map(bits), w.spread.map(bits)]);
    let answer = |a: &Answer| {
        let weights: Vec<Value> = a.weights.iter().map(weight).collect();
        json!([place_in(&VERDICTS, &a.verdict), a.reason, weights])
    };
    let quote = |q: &Quote| {
        let [state, evidence] = [place_in(&QUOTES, &q.state), place_in(&EVIDENCE, &q.evidence)];
        json!([q.text, span(&q.span), state, evidence, q.reason, bits(q.computed)])
    };
    let form = |e: &ClosedForm| json!([e.trace, span(&e.span), place_in(&STATES, &e.state), e.remark]);
    let run = |r: &RunReport| json!([r.name, span(&r.span), r.broke, r.expected]);
    let measure = |m: &Measured| json!([m.name, bits(m.value), m.halved.map(bits)]);
    json!([
        c.name,
        span(&c.span),
        j.answer.as_ref().map(answer),
        j.quotes.iter().map(quote).collect::<Vec<_>>(),
        j.exact.iter().map(form).collect::<Vec<_>>(),
        j.runs.iter().map(run).collect::<Vec<_>>(),
        j.measures.iter().map(measure).collect::<Vec<_>>(),
        j.unmade
    ])
}

fn read_claim(value: &Value) -> Option<Claim> {
    let [name, at, answer, quotes, exact, runs, measures, unmade] = parts(value)?;
    let judgement = Judgement {
        answer: maybe(answer, read_answer)?,
        quotes: list(quotes, read_quote)?,
        exact: list(exact, |value| {
            let [trace, at, state, remark] = parts(value)?;
            let (trace, remark) = (text(trace)?, text(remark)?);
            Some(ClosedForm { trace, span: read_span(at)?, state: one_of(&STATES, state)?, remark })
        })?,
        runs: list(runs, |value| {
            let [name, at, broke, expected] = parts(value)?;
            let (broke, expected) = (maybe(broke, text)?, expected.as_bool()?);
            Some(RunReport { name: text(name)?, span: read_span(at)?, broke, expected })
        })?,
        measures: list(measures, |value| {
            let [name, x, halved] = parts(value)?;
            Some(Measured { name: text(name)?, value: number_of(x)?, halved: maybe(halved, number_of)? })
        })?,
        unmade: maybe(unmade, text)?,
    };
    Some(Claim { name: text(name)?, span: read_span(at)?, judgement })
}

fn read_answer(value: &Value) -> Option<Answer> {
    let [verdict, reason, weights] = parts(value)?;
    let weight = |value: &Value| {
        let [option, holds, margin, spread] = parts(value)?;
        let (option, margin) = (maybe(option, count)?, maybe(margin, number_of)?);
        let spread = maybe(spread, number_of)?;
        Some(Weight { option, holds: maybe(holds, Value::as_bool)?, margin, spread })
    };
    Some(Answer {
        verdict: one_of(&VERDICTS, verdict)?,
        reason: text(reason)?,
        weights: list(weights, weight)?,
    })
}

fn read_quote(value: &Value) -> Option<Quote> {
    let [quoted, at, state, evidence, reason, computed] = parts(value)?;
    Some(Quote {
        text: text(quoted)?,
        span: read_span(at)?,
        state: one_of(&QUOTES, state)?,
        evidence: one_of(&EVIDENCE, evidence)?,
        reason: text(reason)?,
        computed: number_of(computed)?,
    })
}

fn span(range: &Range<usize>) -> Value {
    json!([range.start, range.end])
}

fn read_span(value: &Value) -> Option<Range<usize>> {
    let [start, end] = parts(value)?;
    Some(count(start)?..count(end)?)
}

/// A number by its bits, because JSON has no NaN.
fn bits(x: f64) -> u64 {
    x.to_bits()
}

fn number_of(value: &Value) -> Option<f64> {
    value.as_u64().map(f64::from_bits)
}

fn count(value: &Value) -> Option<usize> {
    usize::try_from(value.as_u64()?).ok()
}

fn text(value: &Value) -> Option<String> {
    value.as_str().map(str::to_string)
}

/// The place of a value in the list of all there are.
fn place_in<T: PartialEq>(all: &[T], one: &T) -> Value {
    json!(all.iter().position(|other| other == one))
}

fn one_of<T: Copy>(all: &[T], value: &Value) -> Option<T> {
    all.get(count(value)?).copied()
}

/// `null`, or something that must be right.
fn maybe<T>(value: &Value, read: impl Fn(&Value) -> Option<T>) -> Option<Option<T>> {
    if value.is_null() { Some(None) } else { read(value).map(Some) }
}

fn list<T>(value: &Value, read: impl Fn(&Value) -> Option<T>) -> Option<Vec<T>> {
    value.as_array()?.iter().map(read).collect()
}

/// The values of a list of known length.
fn parts<const N: usize>(value: &Value) -> Option<&[Value; N]> {
    value.as_array()?.as_slice().try_into().ok()
}
