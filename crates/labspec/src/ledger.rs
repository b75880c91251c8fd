//! The ledger of claims: everything that a course states and that a check can test, each with its state.
//!
//! Summaries, verdicts and exit codes are computed from the ledger and from nothing else. A claim is true only if it was
//! found true in this run. A claim that could not be checked is an entry with the reason.

use crate::printable::counted;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::fmt::Write;
use std::ops::Range;
use std::sync::Arc;

/// The kind of a claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Subject {
    /// A file was read, and has no errors or warnings.
    File,
    /// A model that was checked alone can be loaded.
    Model,
    /// A lab runs: as loaded, and with its controls moved, for as long as a student watches it.
    Lab,
    /// A block of another widget, which labspec cannot run.
    Widget,
    /// A run of a `verify` object can be executed, and does not break.
    Run,
    /// The keyed answer of a question is right.
    Answer,
    /// An option of a question that is undecided.
    Option,
    /// A number quoted in the text equals that of the simulation.
    Quote,
    /// A trace follows its closed form.
    ClosedForm,
    /// The traces and readouts of a lab equal those in the snapshot of its lesson.
    Snapshot,
    /// A listing prints the output that the lesson displays below it.
    Listing,
    /// A number in the text is in the output of a listing, which the listing prints.
    PrintedNumber,
}

impl Subject {
    /// The subjects that a lesson claims: each is true or false on its own, and has its own findings.
    pub const CLAIMS: [Subject; 6] = [
        Subject::Answer,
        Subject::Option,
        Subject::Quote,
        Subject::ClosedForm,
        Subject::Run,
        Subject::Listing,
    ];

    /// Every subject, in the order of summaries.
    pub const ALL: [Subject; 12] = [
        Subject::File,
        Subject::Model,
        Subject::Lab,
        Subject::Widget,
        Subject::Run,
        Subject::Answer,
        Subject::Option,
        Subject::Quote,
        Subject::ClosedForm,
        Subject::Snapshot,
        Subject::Listing,
        Subject::PrintedNumber,
    ];

    /// The singular in words.
    pub fn as_str(self) -> &'static str {
        match self {
            Subject::File => "file",
            Subject::Model => "model",
            Subject::Lab => "lab",
            Subject::Widget => "other widget",
            Subject::Run => "run",
            Subject::Answer => "answer",
            Subject::Option => "option",
            Subject::Quote => "quoted number",
            Subject::ClosedForm => "closed form",
            Subject::Snapshot => "snapshot",
            Subject::Listing => "listing",
            Subject::PrintedNumber => "printed number",
        }
    }
}

/// How a claim was found true.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum Evidence {
    /// Without a simulation: by a formula, or by the structure.
    Computed,
    /// By a simulation in this run.
    Simulated,
}

/// The state of a claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum State {
    /// Checked, and true.
    True(Evidence),
    /// Checked, and false.
    False,
    /// Could not be checked.
    Unchecked,
    /// Skipped in this check: it was not requested, or it is an unknown widget.
    Skipped,
    /// False or unchecked, as recorded in the baseline.
    #[serde(rename = "Known")]
    Baselined,
    /// Not claimed, so nothing was checked.
    NotClaimed,
}

impl State {
    /// Every state; of a true claim, with each evidence.
    pub const ALL: [State; 7] = [
        State::True(Evidence::Computed),
        State::True(Evidence::Simulated),
        State::False,
        State::Unchecked,
        State::Skipped,
        State::Baselined,
        State::NotClaimed,
    ];

    /// The state in words, for programs: `true`, `false`, `unchecked`, `left out`, `known`, `not claimed`.
    pub fn as_str(self) -> &'static str {
        match self {
            State::True(_) => "true",
            State::False => "false",
            State::Unchecked => "unchecked",
            State::Skipped => "left out",
            State::Baselined => "known",
            State::NotClaimed => "not claimed",
        }
    }
}

/// One claim.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// Its kind.
    pub subject: Subject,
    /// The owner: a path, `lab #1`, `quiz fall, question 2`.
    pub owner: String,
    /// The file, in the form that is printed.
    pub path: Arc<str>,
    /// Bytes of that file.
    pub span: Range<usize>,
    /// Its state.
    pub state: State,
    /// The state in one word: `verified`, `refuted`, `ran`, …
    pub word: &'static str,
    /// The claim among several of the owner: a quote, the name of a run, a trace.
    pub what: String,
    /// The reason why it is not true, or the coverage; empty when there is nothing to add.
    pub remark: String,
}

/// All claims of a check, in the order of the files.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Ledger {
    entries: Vec<Entry>,
}

/// Claims of one subject, by what became of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "camelCase")]
#[cfg_attr(feature = "report", derive(schemars::JsonSchema))]
pub struct Count {
    /// True: a simulation shows it.
    pub simulated: usize,
    /// True: worked out without a simulation.
    pub computed: usize,
    /// False.
    #[serde(rename = "false")]
    pub wrong: usize,
    /// Could not be checked.
    pub unchecked: usize,
    /// Skipped in this check: `--no-run`, an ignored error, or an unknown widget.
    #[serde(rename = "leftOut")]
    pub skipped: usize,
    /// False or not checked, as in the baseline.
    #[serde(rename = "known")]
    pub baselined: usize,
    /// Not claimed by anybody.
    pub not_claimed: usize,
}

/// The outcome of a whole check.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// Every claim was checked and is true.
    Clean,
    /// A claim is false, or could not be checked.
    Findings,
    /// Everything that was checked is true, and some claims were left out.
    Partial,
    /// All false and unchecked claims are in the baseline; the others are true.
    Baselined,
    /// There was nothing to check.
    Nothing,
}

impl Outcome {
    /// Every outcome.
    pub const ALL: [Outcome; 5] =
        [Outcome::Clean, Outcome::Findings, Outcome::Partial, Outcome::Baselined, Outcome::Nothing];

    /// The outcome in a word: `clean`, `findings`, `partial`, `known` or `nothing`.
    pub fn as_str(self) -> &'static str {
        match self {
            Outcome::Clean => "clean",
            Outcome::Findings => "findings",
            Outcome::Partial => "partial",
            Outcome::Baselined => "known",
            Outcome::Nothing => "nothing",
        }
    }
}

impl FromIterator<Entry> for Ledger {
    fn from_iter<I: IntoIterator<Item = Entry>>(entries: I) -> Ledger {
        Ledger { entries: entries.into_iter().collect() }
    }
}

impl Ledger {
    /// Adds a claim.
    pub fn add(&mut self, entry: Entry) {
        self.entries.push(entry);
    }

    /// Adds all claims of another ledger.
    pub fn append(&mut self, other: Ledger) {
        self.entries.extend(other.entries);
    }

    /// The claims, in order.
    pub fn entries(&self) -> &[Entry] {
        &self.entries
    }

    /// Counts the claims of a subject.
    pub fn count(&self, subject: Subject) -> Count {
        let mut count = Count::default();
        for entry in self.entries.iter().filter(|e| e.subject == subject) {
            *match entry.state {
                State::True(Evidence::Simulated) => &mut count.simulated,
                State::True(Evidence::Computed) => &mut count.computed,
                State::False => &mut count.wrong,
                State::Unchecked => &mut count.unchecked,
                State::Skipped => &mut count.skipped,
                State::Baselined => &mut count.baselined,
                State::NotClaimed => &mut count.not_claimed,
            } += 1;
        }
        count
    }

    /// The overall outcome. A file without checkable content is not evidence.
    pub fn outcome(&self) -> Outcome {
        let bad = |e: &Entry| matches!(e.state, State::False | State::Unchecked);
        let good = |e: &Entry| match e.subject {
            Subject::File | Subject::Option => false,
            Subject::Widget => matches!(e.state, State::True(_)),
            _ => true,
        };
        if self.entries.iter().any(bad) {
            Outcome::Findings
        } else if self.entries.iter().any(|e| e.state == State::Skipped) {
            Outcome::Partial
        } else if self.entries.iter().any(|e| e.state == State::Baselined) {
            Outcome::Baselined
        } else if self.entries.iter().any(good) {
            Outcome::Clean
        } else {
            Outcome::Nothing
        }
    }

    /// The number of claims in a state. Files are not counted, because their state follows from their content.
    fn in_state(&self, state: State) -> usize {
        self.entries.iter().filter(|e| e.state == state && e.subject != Subject::File).count()
    }

    /// The outcome in a sentence for people: false claims first, then unchecked ones, then the counts of findings
    /// (`findings`, empty where there are none), then whether claims were left out, then the baseline.
    pub fn conclusion(&self, findings: &str) -> String {
        let claims = |n: usize, one: &str, more: &str| match n {
            1 => format!("1 claim {one}"),
            n => format!("{n} claims {more}"),
        };
        let [wrong, open] = [State::False, State::Unchecked].map(|state| self.in_state(state));
        let mut parts = Vec::new();
        if wrong > 0 {
            parts.push(claims(wrong, "is false", "are false"));
        }
        if open > 0 {
            parts.push(claims(open, "could not be checked", "could not be checked"));
        }
        let any = |state| self.entries.iter().any(|e| e.state == state);
        let is_wrong = any(State::False) || any(State::Unchecked);
        match (is_wrong, findings) {
            // The problems of a file without claims.
            (true, "") if parts.is_empty() => parts.push("a file has problems".into()),
            (true, findings) if !findings.is_empty() => parts.push(findings.into()),
            _ => {}
        }
        if any(State::Skipped) {
            let all_is_well = parts.is_empty();
            parts.push(match all_is_well {
                true => "the checked part has no problems, but not everything was checked".into(),
                false => "not everything was checked".into(),
            });
        }
        if any(State::Baselined) {
            parts.push(match parts.is_empty() {
                true => "no problems outside the baseline".into(),
                false => format!("{} already in the baseline", self.baselined()),
            });
        }
        match (parts.is_empty(), self.outcome()) {
            (false, _) => {}
            (true, Outcome::Nothing) => parts.push("nothing to check".into()),
            (true, _) => parts.push("no problems found".into()),
        }
        // Notes alone are not a problem.
        if !is_wrong && !findings.is_empty() {
            parts.push(findings.into());
        }
        parts.join(", ")
    }

    fn baselined(&self) -> usize {
        self.entries.iter().filter(|e| e.state == State::Baselined).count()
    }

    /// The counts in a sentence: `2 files, 4 labs run, 3 answers verified, 2 without a check, 29 quoted numbers verified`.
    pub fn summary(&self) -> String {
        let mut parts = Vec::new();
        for subject in Subject::ALL {
            for counts in summary_counts(subject, &self.count(subject)) {
                push_counts(&mut parts, subject, counts);
            }
        }
        let baselined = self.baselined();
        if baselined > 0 {
            parts.push(format!("{baselined} already in the baseline"));
        }
        parts.join(", ")
    }

    /// Gives widgets of the page, which labspec does not run, the state and the word that `declared` returns for the widget
    /// at this place. `None` leaves a widget unknown.
    pub fn accept_widgets(
        &mut self,
        declared: impl Fn(&Arc<str>, &Range<usize>) -> Option<(State, &'static str)>,
    ) {
        for entry in
            self.entries.iter_mut().filter(|e| e.subject == Subject::Widget && e.state == State::Skipped)
        {
            if let Some((state, word)) = declared(&entry.path, &entry.span) {
                (entry.state, entry.word) = (state, word);
                entry.remark.clear();
            }
        }
    }

    /// Marks the claims that were left out of interrupted lessons as unchecked.
    pub fn break_off(&mut self, is_broken_off: impl Fn(&Arc<str>) -> bool) {
        for entry in self.entries.iter_mut().filter(|e| e.state == State::Skipped && is_broken_off(&e.path)) {
            (entry.state, entry.word) = (State::Unchecked, "unchecked");
            entry.remark = "the check of this lesson was interrupted".into();
        }
    }

    /// Marks unchecked entries as baselined, by their indexes.
    pub fn mark_baselined_at(&mut self, indexes: &BTreeSet<usize>) {
        for (i, entry) in self.entries.iter_mut().enumerate() {
            if entry.state == State::Unchecked && indexes.contains(&i) {
                (entry.state, entry.word) = (State::Baselined, "known");
            }
        }
    }

    /// Marks false and unchecked entries as baselined where `baselined` returns true, and the files of such entries.
    pub fn mark_baselined(&mut self, baselined: impl Fn(&Entry) -> bool) {
        for entry in &mut self.entries {
            let bad = matches!(entry.state, State::False | State::Unchecked);
            let file = entry.subject == Subject::File && matches!(entry.state, State::True(_));
            if (bad || file) && baselined(entry) {
                (entry.state, entry.word) = (State::Baselined, "known");
            }
        }
    }
}

/// The counts of a subject in the summary, in pairs, each with the words after the number.
fn summary_counts(subject: Subject, c: &Count) -> Vec<[(usize, &'static str); 2]> {
    match subject {
        Subject::File => vec![[(c.simulated + c.computed + c.wrong + c.unchecked, ""), (0, "")]],
        // Runs are means of the claims that read them, so only broken and impossible ones are reported.
        Subject::Run => {
            vec![[(c.wrong, "broken"), (c.unchecked, "impossible")], [(c.skipped, "left out"), (0, "")]]
        }
        Subject::Widget => vec![
            [(c.computed, "valid"), (c.wrong + c.unchecked, "invalid")],
            [(c.not_claimed, "not run"), (c.skipped, "not checked")],
        ],
        Subject::Model => vec![[(c.computed, "loaded"), (c.wrong + c.unchecked, "refused")]],
        Subject::Lab => vec![
            [(c.simulated, "run"), (c.wrong, "broken")],
            [(c.unchecked, "not run in full"), (c.skipped, "left out")],
        ],
        Subject::Option => vec![[(c.not_claimed, "not decided"), (0, "")]],
        Subject::Snapshot => vec![
            [(c.simulated, "as stored"), (c.wrong, "not as stored")],
            [(c.unchecked, "could not be checked"), (c.skipped, "left out")],
        ],
        Subject::Listing => vec![
            [(c.simulated, "as displayed"), (c.wrong, "not as displayed")],
            [(c.unchecked, "could not be checked"), (c.skipped, "left out")],
        ],
        Subject::PrintedNumber => vec![[(c.simulated, "in the output of listings"), (0, "")]],
        Subject::Answer | Subject::Quote | Subject::ClosedForm => vec![
            [(c.simulated, "verified"), (c.computed, "computed")],
            [(c.wrong, "wrong"), (c.unchecked, "could not be checked")],
            [(c.not_claimed, "without a check"), (c.skipped, "left out")],
        ],
    }
}

fn push_counts(parts: &mut Vec<String>, subject: Subject, counts: [(usize, &str); 2]) {
    for (n, word) in counts.into_iter().filter(|(n, _)| *n > 0) {
        let mut part = match subject {
            Subject::PrintedNumber => counted(n, "number"),
            subject => counted(n, subject.as_str()),
        };
        let space = if word.is_empty() { "" } else { " " };
        let _ = write!(part, "{space}{word}");
        parts.push(part);
    }
}

#[cfg(test)]
mod tests;
