//! A trace or a readout, as it is watched through the runs of a lab.

use crate::bind::Bound;

/// A trace or a readout through all runs.
pub(crate) struct WatchedDisplay<'a> {
    pub(crate) bound: &'a Bound,
    /// Its place in a row of samples.
    pub(crate) column: usize,
    pub(crate) name: String,
    pub(crate) trace: bool,
    /// The text itself says that there may be gaps.
    pub(crate) says_gap: bool,
    pub(crate) says_infinite: bool,
    /// Whether it was a number, a text or a truth value in any run.
    pub(crate) ever: bool,
    /// Whether it had a gap that may be meant.
    pub(crate) gap: bool,
    /// Codes of the rules that it breaks.
    pub(crate) reported: Vec<&'static str>,
}

impl WatchedDisplay<'_> {
    /// What a student makes of a value that is no number.
    pub(crate) fn consequence(&self) -> &'static str {
        match self.trace {
            true => "the curve has a gap there, and nothing explains it",
            false => "a student cannot tell whether the lab or the physics is broken",
        }
    }
}

/// When something was displayed, in words.
pub(crate) fn moment(time: f64, done: &str) -> String {
    format!("{done}, at t = {} s", crate::run::time(time))
}
