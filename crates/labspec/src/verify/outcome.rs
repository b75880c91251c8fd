//! The results of the runs.

use super::measure::MissingSamples;
use crate::run::StepVariant;

/// The measures of one run.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct MeasuredRun {
    pub(super) name: String,
    /// Its index and value in a sweep.
    pub(super) swept: Option<(usize, f64)>,
    pub(super) measures: Vec<(String, f64)>,
    /// Why measures have no value because samples had no number, by name.
    pub(super) missing_samples: Vec<(String, MissingSamples)>,
    /// Number of warnings of the engine.
    pub(super) warnings: usize,
    /// How it broke, in one clause. The measures of a broken run are not evidence.
    pub(super) broke: Option<String>,
}

impl MeasuredRun {
    /// The name of the run in conditions: `fall`, `fall[2]`.
    pub(super) fn title(&self) -> String {
        match self.swept {
            Some((i, _)) => format!("{}[{i}]", self.name),
            None => self.name.clone(),
        }
    }
}

/// The measures of all runs.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct MeasuredRuns {
    pub(super) runs: Vec<MeasuredRun>,
    /// Results of searches.
    pub(super) found: Vec<(String, f64)>,
    /// The searched range of each, in words.
    pub(super) looked: Vec<String>,
    pub(super) numerics: StepVariant,
    /// Values of expressions with their own aggregates, recorded by a reference engine; empty for our own outcomes.
    pub(super) elsewhere: Vec<(String, f64)>,
}

impl MeasuredRuns {
    /// The value that a reference engine recorded for this expression.
    pub(super) fn measured_elsewhere(&self, text: &str) -> Option<f64> {
        self.elsewhere.iter().find(|(text_of_run, _)| text_of_run == text).map(|(_, x)| *x)
    }

    /// All measures, with their names in conditions.
    pub(super) fn list(&self) -> Vec<(String, f64)> {
        let short = self.runs.len() == 1;
        let each = |r: &MeasuredRun| {
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
