//! From what was checked to the ledger: one entry per claim.

use super::claims::{self, Owner};
use super::{Checked, Claim, RanLab};
use crate::finding::{Finding, Severity};
use crate::ledger::{Entry, Evidence, Ledger, State, Subject};
use crate::source::Text;
use crate::verify::{Measured, Quote, QuoteState, RunReport, Weight, significant};
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

/// The ledger of a course. `findings` are all that was found, in lessons and in models: a file with an error or a warning in
/// it is not in order, whatever else is true of it.
pub fn ledger(checked: &[Checked], findings: &[Finding]) -> Ledger {
    let mut ledger = Ledger::default();
    let mut faults: BTreeMap<&Arc<str>, usize> = BTreeMap::new();
    for finding in findings.iter().filter(|f| f.severity != Severity::Note) {
        *faults.entry(&finding.path).or_default() += 1;
    }
    for c in checked {
        let path = c.lesson.file.path();
        ledger.add(file(path, faults.remove(path).unwrap_or(0)));
        lesson(c, &mut ledger);
    }
    // Model files, and files that could not be read at all.
    for (path, count) in faults {
        ledger.add(file(path, count));
    }
    ledger
}

fn file(path: &Arc<str>, faults: usize) -> Entry {
    let (state, word) = match faults {
        0 => (State::True(Evidence::Computed), "in order"),
        _ => (State::False, "has faults"),
    };
    let remark = if faults == 0 { String::new() } else { plural(faults, "finding") };
    Entry {
        subject: Subject::File,
        owner: path.to_string(),
        path: path.clone(),
        span: 0..0,
        state,
        word,
        what: String::new(),
        remark,
    }
}

/// Everything that stands in one lesson.
fn lesson(c: &Checked, ledger: &mut Ledger) {
    let mut all = Vec::new();
    claimed(c, &mut all);
    left_out(c, &mut all);
    for mut entry in all {
        // A page cannot read a block whose JSON is broken, whatever was found by reading on behind the mistakes.
        if matches!(entry.state, State::True(_)) && c.lesson.is_broken(&entry.span) {
            (entry.state, entry.word) = (State::Unchecked, "broken JSON");
            entry.remark = "a page cannot read it".into();
        }
        ledger.add(entry);
    }
}

fn claimed(c: &Checked, ledger: &mut Vec<Entry>) {
    let path = c.lesson.file.path();
    let entry = |subject, owner: &str, span: &Range<usize>, state, word| Entry {
        subject,
        owner: owner.to_string(),
        path: path.clone(),
        span: span.clone(),
        state,
        word,
        what: String::new(),
        remark: String::new(),
    };
    for ran in &c.labs {
        let span = c.lesson.lab(&ran.address).map_or(0..0, |lab| lab.span.clone());
        let (state, word, remark) = lab(ran);
        let owner = format!("lab {}", ran.address);
        ledger.push(Entry {
            what: ran.title.clone(),
            remark,
            ..entry(Subject::Lab, &owner, &span, state, word)
        });
    }
    for lab in c.lesson.labs.iter().filter(|entry| entry.lab.is_none()) {
        let owner = format!("lab #{}", lab.number);
        let remark = "it cannot be read".into();
        ledger.push(Entry { remark, ..entry(Subject::Lab, &owner, &lab.span, State::Unchecked, "unread") });
    }
    for quiz in &c.lesson.quizzes {
        let id = quiz.id.as_ref().map_or("", |t| t.as_str());
        for (i, _) in quiz.questions.iter().enumerate().filter(|(_, q)| q.is_none()) {
            let owner = format!("quiz {id}, question {}", i + 1);
            let remark = "it cannot be read".into();
            ledger.push(Entry {
                remark,
                ..entry(Subject::Answer, &owner, &quiz.span, State::Unchecked, "unread")
            });
        }
    }
    for widget in &c.lesson.widgets {
        let owner = format!("widget {}", widget.name);
        // Where the claims alone are verified, nothing is said of what the page shows.
        let (state, word, remark) = match c.depth.claims && !c.depth.labs {
            true => (State::NotClaimed, "not run", String::new()),
            false => (State::LeftOut, "unknown", unknown_widget(&widget.name)),
        };
        ledger.push(Entry { remark, ..entry(Subject::Widget, &owner, &widget.span, state, word) });
    }
    for kept in &c.snapshots {
        let owner = format!("lab {}", kept.lab);
        let about = entry(Subject::Snapshot, &owner, &kept.span, kept.state, kept.word());
        ledger.push(Entry { remark: kept.remark(), ..about });
    }
    for claim in &c.claims {
        let judgement = &claim.judgement;
        if let Some(answer) = &judgement.answer {
            let (state, word) = (answer.verdict.state(), answer.verdict.as_str());
            let remark = answer.reason.clone();
            ledger.push(Entry { remark, ..entry(Subject::Answer, &claim.name, &claim.span, state, word) });
            for open in answer.weights.iter().filter(|w| w.holds.is_none()) {
                let what = open.option.map_or(String::new(), |i| i.to_string());
                let about = entry(Subject::Option, &claim.name, &claim.span, State::NotClaimed, "undecided");
                ledger.push(Entry { what, ..about });
            }
        }
        for q in &judgement.quotes {
            let (state, word) = quote(q);
            let (what, remark) = (q.text.clone(), q.reason.clone());
            ledger.push(Entry { what, remark, ..entry(Subject::Quote, &claim.name, &q.span, state, word) });
        }
        for form in &judgement.exact {
            let word = match form.state {
                State::True(_) => "verified",
                State::False => "refuted",
                _ => "failed",
            };
            let (what, remark) = (form.trace.clone(), form.remark.clone());
            let about = entry(Subject::ClosedForm, &claim.name, &form.span, form.state, word);
            ledger.push(Entry { what, remark, ..about });
        }
        for r in &judgement.runs {
            let (state, word, remark) = run(r, judgement.unmade.as_deref());
            let what = r.name.clone();
            ledger.push(Entry { what, remark, ..entry(Subject::Run, &claim.name, &r.span, state, word) });
        }
    }
}

/// What could be run and judged, and was not, because nobody asked for it. Where the claims alone are verified, nothing is said
/// of the labs.
fn left_out(c: &Checked, ledger: &mut Vec<Entry>) {
    let entry = |subject, owner: &str, span: Range<usize>, what: &str| Entry {
        subject,
        owner: owner.to_string(),
        path: c.lesson.file.path().clone(),
        span,
        state: State::LeftOut,
        word: "left out",
        what: what.to_string(),
        remark: String::new(),
    };
    if !c.depth.labs && !c.depth.claims {
        for (address, lab) in c.lesson.addressed() {
            ledger.push(entry(Subject::Lab, &format!("lab {address}"), lab.span.clone(), lab.title()));
        }
    }
    let owners = if c.depth.claims { Vec::new() } else { claims::owners(&c.lesson) };
    for (name, owner) in owners {
        if let Owner::Question(question) = owner
            && let Some(answer) = claims::unclaimed(question)
        {
            let span = question.verify.as_ref().map_or(&question.span, |v| &v.span).clone();
            let (state, word) = (answer.verdict.state(), answer.verdict.as_str());
            let about = entry(Subject::Answer, &name, span, "");
            ledger.push(Entry { state, word, remark: answer.reason, ..about });
        }
        let Some((verify, _, question)) = owner.claim(&c.lesson) else { continue };
        if question.is_some() && verify.claims_answer() {
            ledger.push(entry(Subject::Answer, &name, verify.span.clone(), ""));
        }
        let mut add = |subject, text: &Text| ledger.push(entry(subject, &name, text.span(), text.as_str()));
        verify.says.iter().for_each(|said| add(Subject::Quote, &said.quote));
        verify.table.iter().for_each(|column| add(Subject::Quote, &column.column));
        verify.exact.iter().for_each(|exact| add(Subject::ClosedForm, &exact.trace));
        verify.runs.iter().for_each(|run| add(Subject::Run, &run.name));
    }
}

fn unknown_widget(name: &str) -> String {
    format!("not checked; if the page has it, add it to labspec.toml: widgets = [\"{name}\"]")
}

fn lab(ran: &RanLab) -> (State, &'static str, String) {
    let Some(tried) = ran.tried.as_ref().filter(|_| ran.ran) else {
        return (State::Unchecked, "not run", "it could not run".into());
    };
    let mut remark = plural(tried.runs, "run");
    let mut missing = tried.ended.iter().cloned().collect::<Vec<_>>();
    if tried.skipped > 0 {
        missing.push(format!("{} not made", plural(tried.skipped, "run")));
    }
    if ran.mistakes > 0 {
        missing.push(format!("{} in its code", plural(ran.mistakes, "mistake")));
    }
    for part in &missing {
        remark.push_str(", ");
        remark.push_str(part);
    }
    match (tried.broke, missing.is_empty()) {
        // The runs of a lab that breaks as it should end there.
        (true, _) if ran.expected && ran.mistakes == 0 => {
            (State::True(Evidence::Simulated), "breaks", remark)
        }
        (false, true) if ran.expected => (State::False, "does not break", remark),
        (true, _) => (State::False, "broken", remark),
        (false, false) => (State::Unchecked, "in part", remark),
        (false, true) => (State::True(Evidence::Simulated), "run", remark),
    }
}

fn plural(n: usize, one: &str) -> String {
    if n == 1 { format!("1 {one}") } else { format!("{n} {one}s") }
}

fn quote(q: &Quote) -> (State, &'static str) {
    let state = match q.state {
        QuoteState::Right => State::True(q.evidence),
        QuoteState::Wrong => State::False,
        QuoteState::Unclear => State::Unchecked,
    };
    (state, q.verdict())
}

fn run(r: &RunReport, unmade: Option<&str>) -> (State, &'static str, String) {
    if let Some(reason) = unmade {
        return (State::Unchecked, "not made", reason.to_string());
    }
    match (&r.broke, r.expected) {
        (Some(how), true) => (State::True(Evidence::Simulated), "breaks", how.clone()),
        (Some(how), false) => (State::False, "broken", how.clone()),
        (None, true) => (State::False, "does not break", String::new()),
        (None, false) => (State::True(Evidence::Simulated), "made", String::new()),
    }
}

/// The lines under a claim that show how it was found: measures with their value at half the timestep, and how each
/// condition held.
pub fn evidence(claim: &Claim) -> Vec<String> {
    let measure = |m: &Measured| match m.halved {
        Some(x) => {
            format!("{} = {}   ({} at half the timestep)", m.name, significant(m.value), significant(x))
        }
        None => format!("{} = {}", m.name, significant(m.value)),
    };
    let weights = claim.judgement.answer.iter().flat_map(|a| &a.weights);
    let weight = |w: &Weight| match w.option {
        Some(i) => format!("option {i} {}", w.describe()),
        None => format!("the answer {}", w.describe()),
    };
    claim.judgement.measures.iter().map(measure).chain(weights.map(weight)).collect()
}
