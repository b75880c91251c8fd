//! The results of the runs.

use super::list_measure::measure_of_element;
use super::measure::NoValue;
use crate::run::StepVariant;

/// The place of a run in a sweep.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SweepMember {
    /// Its index among the runs of the sweep.
    pub(super) index: usize,
    /// The value of each axis.
    pub(super) values: Vec<f64>,
}

/// The measures of one run.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct MeasuredRun {
    pub(super) name: String,
    /// Its place in a sweep.
    pub(super) swept: Option<SweepMember>,
    pub(super) measures: Vec<(String, f64)>,
    /// Why measures have no value, by name.
    pub(super) without_value: Vec<(String, NoValue)>,
    /// Measures with an event that happens at the first sample: the name, and the aggregate as written.
    pub(super) at_start: Vec<(String, String)>,
    /// The time of its end, s.
    pub(super) end: f64,
    /// Number of warnings of the engine.
    pub(super) warnings: usize,
    /// How it broke, in one clause. The measures of a broken run are not evidence.
    pub(super) broke: Option<String>,
}

impl MeasuredRun {
    /// The name of the run in conditions: `fall`, `fall[2]`.
    pub(super) fn title(&self) -> String {
        match &self.swept {
            Some(member) => format!("{}[{}]", self.name, member.index),
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
    /// The other end of the bracket of each search: its true limit is anywhere between the result and this end.
    pub(super) other_ends: Vec<f64>,
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

    /// The ends of the bracket of a search, its result first; `None` if it has no result.
    pub(super) fn bracket(&self, search: usize) -> Option<[f64; 2]> {
        let (_, value) = self.found.get(search)?;
        let ends = [*value, *self.other_ends.get(search)?];
        (ends.iter().all(|x| x.is_finite()) && ends[0] != ends[1]).then_some(ends)
    }

    /// All measures, with their names in conditions.
    pub(super) fn list(&self) -> Vec<(String, f64)> {
        let short = self.runs.len() == 1;
        let each = |r: &MeasuredRun| {
            let name = |m: &str| match (&r.swept, measure_of_element(m)) {
                _ if short => m.to_string(),
                (Some(member), Some((list, element))) => {
                    // The elements of all runs follow each other.
                    let is_of_list = |(other, _): &&(String, f64)| {
                        measure_of_element(other).is_some_and(|(name, _)| name == list)
                    };
                    let elements = r.measures.iter().filter(is_of_list).count();
                    format!("{}.{list}[{}]", r.name, member.index * elements + element)
                }
                (Some(member), None) => format!("{}.{m}[{}]", r.name, member.index),
                (None, _) => format!("{}.{m}", r.name),
            };
            r.measures.iter().map(|(m, x)| (name(m), *x)).collect::<Vec<_>>()
        };
        self.runs.iter().flat_map(each).chain(self.found.iter().cloned()).collect()
    }
}
