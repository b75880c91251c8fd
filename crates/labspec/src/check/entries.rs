//! Writes the ledger: one entry for each claim.

use super::claims::{self, Owner};
use super::{Checked, Claim, RanLab};
use crate::finding::{Finding, Severity};
use crate::ledger::{Entry, Evidence, Ledger, State, Subject};
use crate::printable::counted;
use crate::source::Text;
use crate::verify::{Measured, Quote, QuoteState, RunReport, Weight, significant};
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

/// The ledger of a course. `findings` contains all findings in lessons and models: a file with an error or a warning is not
/// in order, even if all its claims are true.
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
    // Model files, and files that could not be read.
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
    let remark = if faults == 0 { String::new() } else { counted(faults, "finding") };
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

/// Whether a lab ran, but not to its end or not with every control.
pub(crate) fn is_unfinished(ran: &RanLab) -> bool {
    ran.tried.is_some() && lab(ran).0 == State::Unchecked
}

/// Adds the entries of one lesson.
fn lesson(c: &Checked, ledger: &mut Ledger) {
    let mut all = Vec::new();
    let mut entries = LessonEntries { checked: c, entries: &mut all };
    entries.add_labs();
    entries.add_unread_questions();
    entries.add_widgets();
    entries.add_snapshots();
    entries.add_claims();
    entries.add_listings();
    entries.add_printed_numbers();
    add_skipped_parts(c, &mut all);
    for mut entry in all {
        // A page cannot read a block with invalid JSON, even if the parser recovered from the errors.
        if matches!(entry.state, State::True(_)) && c.lesson.is_broken(&entry.span) {
            (entry.state, entry.word) = (State::Unchecked, "broken JSON");
            entry.remark = "a page cannot read it".into();
        }
        ledger.add(entry);
    }
}

/// The entries of one lesson, one for each claim.
struct LessonEntries<'c> {
    checked: &'c Checked,
    entries: &'c mut Vec<Entry>,
}

impl LessonEntries<'_> {
    /// An entry without details.
    fn entry(
        &self,
        subject: Subject,
        owner: &str,
        span: &Range<usize>,
        state: State,
        word: &'static str,
    ) -> Entry {
        Entry {
            subject,
            owner: owner.to_string(),
            path: self.checked.lesson.file.path().clone(),
            span: span.clone(),
            state,
            word,
            what: String::new(),
            remark: String::new(),
        }
    }

    /// Adds the labs that ran, and those that could not be read.
    fn add_labs(&mut self) {
        let lesson = &self.checked.lesson;
        for ran in &self.checked.labs {
            let of_lesson = lesson.lab(&ran.address);
            let span = of_lesson.map_or(0..0, |lab| lab.span.clone());
            let (state, word, remark) = match of_lesson.and_then(|lab| lab.unread_key) {
                // It was run without what the key says.
                Some(key) => (State::Unchecked, "in part", format!("its `{key}` cannot be read")),
                None => lab(ran),
            };
            let owner = format!("lab {}", ran.address);
            let about = self.entry(Subject::Lab, &owner, &span, state, word);
            self.entries.push(Entry { what: ran.title.clone(), remark, ..about });
        }
        for lab in lesson.labs.iter().filter(|entry| entry.lab.is_none()) {
            let owner = format!("lab #{}", lab.number);
            self.add_unread(Subject::Lab, &owner, &lab.span);
        }
    }

    /// Adds the questions that could not be read.
    fn add_unread_questions(&mut self) {
        for quiz in &self.checked.lesson.quizzes {
            let id = quiz.id.as_ref().map_or("", |t| t.as_str());
            for (i, _) in quiz.questions.iter().enumerate().filter(|(_, q)| q.is_none()) {
                let owner = format!("quiz {id}, question {}", i + 1);
                self.add_unread(Subject::Answer, &owner, &quiz.span);
            }
        }
    }

    fn add_unread(&mut self, subject: Subject, owner: &str, span: &Range<usize>) {
        let about = self.entry(subject, owner, span, State::Unchecked, "unread");
        self.entries.push(Entry { remark: "it cannot be read".into(), ..about });
    }

    /// Adds the widgets of other libraries. If only the claims are verified, they are not reported as unknown.
    fn add_widgets(&mut self) {
        let level = &self.checked.level;
        for widget in &self.checked.lesson.widgets {
            let owner = format!("widget {}", widget.name);
            let (state, word, remark) = match level.claims && !level.labs {
                true => (State::NotClaimed, "not run", String::new()),
                false => (State::Skipped, "unknown", unknown_widget(&widget.name)),
            };
            let about = self.entry(Subject::Widget, &owner, &widget.span, state, word);
            self.entries.push(Entry { remark, ..about });
        }
    }

    fn add_snapshots(&mut self) {
        for snapshot in &self.checked.snapshots {
            let owner = format!("lab {}", snapshot.lab);
            let about =
                self.entry(Subject::Snapshot, &owner, &snapshot.span, snapshot.state, snapshot.word());
            self.entries.push(Entry { remark: snapshot.remark(), ..about });
        }
    }

    fn add_printed_numbers(&mut self) {
        // What is displayed is a part of the claim of its listing.
        for number in self.checked.printed.iter().filter(|number| !number.is_displayed) {
            let state = State::True(Evidence::Simulated);
            let about = self.entry(Subject::PrintedNumber, &number.listing, &number.span, state, "printed");
            self.entries.push(Entry { what: number.quote.clone(), ..about });
        }
    }

    fn add_listings(&mut self) {
        for listing in &self.checked.listings {
            let about =
                self.entry(Subject::Listing, &listing.name, &listing.span, listing.state, listing.word);
            self.entries.push(Entry { what: listing.file.clone(), remark: listing.remark.clone(), ..about });
        }
    }

    fn add_claims(&mut self) {
        for claim in &self.checked.claims {
            self.add_answer(claim);
            self.add_statements(claim);
        }
    }

    /// Adds the answer of a question, and its undecided options.
    fn add_answer(&mut self, claim: &Claim) {
        let Some(answer) = &claim.judgement.answer else { return };
        let (state, word) = (answer.verdict.state(), answer.verdict.as_str());
        let about = self.entry(Subject::Answer, &claim.name, &claim.span, state, word);
        self.entries.push(Entry { remark: answer.reason.clone(), ..about });
        for open in answer.weights.iter().filter(|w| w.holds.is_none()) {
            let what = open.option.map_or(String::new(), |i| i.to_string());
            let about = self.entry(Subject::Option, &claim.name, &claim.span, State::NotClaimed, "undecided");
            self.entries.push(Entry { what, ..about });
        }
    }

    /// Adds the quotes, the closed forms and the runs of a claim.
    fn add_statements(&mut self, claim: &Claim) {
        let judgement = &claim.judgement;
        for q in &judgement.quotes {
            let (state, word) = quote(q);
            let about = self.entry(Subject::Quote, &claim.name, &q.span, state, word);
            self.entries.push(Entry { what: q.text.clone(), remark: q.reason.clone(), ..about });
        }
        for form in &judgement.exact {
            let word = match form.state {
                State::True(_) => "verified",
                State::False => "refuted",
                _ => "failed",
            };
            let about = self.entry(Subject::ClosedForm, &claim.name, &form.span, form.state, word);
            self.entries.push(Entry { what: form.trace.clone(), remark: form.remark.clone(), ..about });
        }
        for r in &judgement.runs {
            let (state, word, remark) = run(r, judgement.unmade.as_deref());
            let about = self.entry(Subject::Run, &claim.name, &r.span, state, word);
            self.entries.push(Entry { what: r.name.clone(), remark, ..about });
        }
    }
}

/// Adds the labs and claims that the level of the check leaves out. If only the claims are verified, the labs have no
/// entries.
fn add_skipped_parts(c: &Checked, ledger: &mut Vec<Entry>) {
    let entry = |subject, owner: &str, span: Range<usize>, what: &str| Entry {
        subject,
        owner: owner.to_string(),
        path: c.lesson.file.path().clone(),
        span,
        state: State::Skipped,
        word: "left out",
        what: what.to_string(),
        remark: String::new(),
    };
    if !c.level.labs && !c.level.claims {
        for (address, lab) in c.lesson.addressed() {
            ledger.push(entry(Subject::Lab, &format!("lab {address}"), lab.span.clone(), lab.title()));
        }
    }
    let owners = if c.level.claims { Vec::new() } else { claims::owners(&c.lesson) };
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
        verify.says.iter().for_each(|quoted| add(Subject::Quote, &quoted.quote));
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
    let mut remark = counted(tried.runs, "run");
    let mut missing = tried.ended.iter().cloned().collect::<Vec<_>>();
    if tried.skipped > 0 {
        missing.push(format!("{} not made", counted(tried.skipped, "run")));
    }
    if ran.mistakes > 0 {
        missing.push(format!("{} in its code", counted(ran.mistakes, "mistake")));
    }
    for part in &missing {
        remark.push_str(", ");
        remark.push_str(part);
    }
    match (tried.broke, missing.is_empty()) {
        // For a lab that breaks as expected, the runs end there.
        (true, _) if !ran.expect.forbids() && ran.mistakes == 0 => {
            (State::True(Evidence::Simulated), "breaks", remark)
        }
        (false, true) if ran.expect.requires() => (State::False, "does not break", remark),
        (true, _) => (State::False, "broken", remark),
        (false, false) => (State::Unchecked, "in part", remark),
        (false, true) => (State::True(Evidence::Simulated), "run", remark),
    }
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
    let (state, word) = r.outcome();
    (state, word, r.broke.clone().unwrap_or_default())
}

/// The value of every measure of the runs of a claim, in lines.
pub fn measure_lines(claim: &Claim) -> Vec<String> {
    let measure = |m: &Measured| match m.halved {
        Some(x) => {
            format!("{} = {}   ({} at half the timestep)", m.name, significant(m.value), significant(x))
        }
        None => format!("{} = {}", m.name, significant(m.value)),
    };
    claim.judgement.measures.iter().map(measure).collect()
}

/// What the condition of each option gives, in lines.
pub fn option_lines(claim: &Claim) -> Vec<String> {
    let weights = claim.judgement.answer.iter().flat_map(|a| &a.weights);
    let weight = |w: &Weight| match w.option {
        Some(i) => format!("option {i} {}", w.describe()),
        None => format!("the answer {}", w.describe()),
    };
    weights.map(weight).collect()
}
