//! Errors of programs during a run.

use crate::source::Text;
use labspec_expr::rules::Rule;

/// An error of a program during a run. JavaScript would have thrown, or continued silently.
#[derive(Clone, Debug, PartialEq)]
pub struct ProgramError {
    /// The violated rule.
    pub rule: &'static Rule,
    /// The text that failed.
    pub text: Text,
    /// The bytes of `text` that failed.
    pub span: std::ops::Range<usize>,
    /// The error message.
    pub message: String,
    /// Simulated time of the first occurrence, s.
    pub time: f64,
}
