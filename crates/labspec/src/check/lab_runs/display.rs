//! A trace or a readout during the runs of a lab.

use crate::bind::Bound;

/// A trace or a readout during all runs.
pub(crate) struct WatchedDisplay<'a> {
    pub(crate) bound: &'a Bound,
    /// Its index in a row of samples.
    pub(crate) column: usize,
    pub(crate) name: String,
    pub(crate) trace: bool,
    /// Whether its text itself contains NaN, for a gap.
    pub(crate) mentions_gap: bool,
    pub(crate) says_infinite: bool,
    /// Whether it was a number, a text or a boolean in any run.
    pub(crate) ever: bool,
    /// Whether it had a gap that may be intended.
    pub(crate) gap: bool,
    /// Codes of the rules that it violates.
    pub(crate) reported: Vec<&'static str>,
}

impl WatchedDisplay<'_> {
    /// The consequence of a NaN for a student.
    pub(crate) fn consequence(&self) -> &'static str {
        match self.trace {
            true => "the curve has a gap there, and nothing explains it",
            false => "a student cannot tell whether the lab or the physics is broken",
        }
    }
}

/// The time of an observation, in words.
pub(crate) fn moment(time: f64, done: &str) -> String {
    format!("{done}, at t = {} s", crate::run::time(time))
}
