//! The result of one run of a `verify` object.

use super::measure::Sampled;

/// The result of one run.
#[derive(Clone, Debug)]
pub(crate) struct RunResult {
    pub(super) values: Vec<Sampled>,
    /// The time of its end, s.
    pub(super) end: f64,
    /// Number of warnings of the engine.
    pub(super) warnings: usize,
    /// How it broke.
    pub(super) broke: Option<String>,
    /// Whether a constraint acted in some step, so that the solver affects the result.
    pub(super) solved: bool,
    /// Whether a program, or a modification of the model, changed a parameter without the parameters coupled to it.
    pub(super) has_uncoupled_change: bool,
}
