//! What came of one run of a `verify` object.

use super::measure::Sampled;

/// What came of one run.
#[derive(Clone, Debug)]
pub(crate) struct RunResult {
    pub(super) values: Vec<Sampled>,
    /// Number of warnings of the engine.
    pub(super) warnings: usize,
    /// What broke in it.
    pub(super) broke: Option<String>,
    /// A program of it, or a change of its model, left behind what belongs to a parameter.
    pub(super) left_behind: bool,
}
