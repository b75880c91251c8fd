//! What the runs gave.

use super::measure::Doubt;
use crate::run::StepVariant;

/// The measures of one run.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct RunOutcome {
    pub(super) name: String,
    /// The value that it has of what is swept, and its place in the sweep.
    pub(super) swept: Option<(usize, f64)>,
    pub(super) measures: Vec<(String, f64)>,
    /// Why measures have no value where samples had no number, by name.
    pub(super) doubts: Vec<(String, Doubt)>,
    /// Number of warnings of the engine.
    pub(super) warnings: usize,
    /// What broke in it, in one clause; what it measured is then evidence of nothing.
    pub(super) broke: Option<String>,
}

impl RunOutcome {
    /// How conditions call it: `fall`, `fall[2]`.
    pub(super) fn title(&self) -> String {
        match self.swept {
            Some((i, _)) => format!("{}[{i}]", self.name),
            None => self.name.clone(),
        }
    }
}

/// The measures of all runs.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Outcome {
    pub(super) runs: Vec<RunOutcome>,
    /// Values that were searched for.
    pub(super) found: Vec<(String, f64)>,
    /// Where each was looked for, in words.
    pub(super) looked: Vec<String>,
    pub(super) numerics: StepVariant,
    /// Expressions that look at the samples themselves, measured by somebody else; empty where we measure.
    pub(super) elsewhere: Vec<(String, f64)>,
}

impl Outcome {
    /// What somebody else measured with this expression.
    pub(super) fn measured_elsewhere(&self, text: &str) -> Option<f64> {
        self.elsewhere.iter().find(|(text_of_run, _)| text_of_run == text).map(|(_, x)| *x)
    }

    /// All measures, named as conditions read them.
    pub(super) fn list(&self) -> Vec<(String, f64)> {
        let short = self.runs.len() == 1;
        let each = |r: &RunOutcome| {
            let name = |m: &str| match r.swept {
                _ if short => m.to_string(),
                Some((i, _)) => format!("{}.{m}[{i}]", r.name),
                None => format!("{}.{m}", r.name),
            };
            r.measures.iter().map(|(m, x)| (name(m), *x)).collect::<Vec<_>>()
        };
        self.runs.iter().flat_map(each).chain(self.found.iter().cloned()).collect()
    }
}
