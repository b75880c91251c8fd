//! What a program of a lab did wrong while it ran.

use crate::source::Text;
use labspec_expr::rules::Rule;

/// Something that went wrong in a program while the lab ran; JavaScript would have thrown, or said nothing.
#[derive(Clone, Debug, PartialEq)]
pub struct Trouble {
    /// What was broken.
    pub rule: &'static Rule,
    /// The text and the bytes of it that failed.
    pub text: Text,
    /// Bytes of `text`.
    pub span: std::ops::Range<usize>,
    /// What happened.
    pub message: String,
    /// Simulated time of the first occurrence, s.
    pub time: f64,
}
