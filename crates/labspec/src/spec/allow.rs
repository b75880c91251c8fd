//! Findings that an author suppresses: `"lint": {"allow": […], "why": "…"}` in a lab, a quiz or a question, and `<!--
//! labspec allow CODE, CODE: reason -->` before a block of prose.

use super::fields::Fields;
use super::format::LINT;
use super::problem::Problem;
use super::read as values;
use crate::json::Node;
use crate::source::Text;
use std::ops::Range;

/// Suppressed codes for a range of a lesson.
#[derive(Clone, Debug, PartialEq)]
pub struct Allowance {
    /// Bytes of the object or the comment.
    pub span: Range<usize>,
    /// The codes with their spans.
    pub codes: Vec<(String, Range<usize>)>,
    /// The reason; empty where there is none.
    pub why: String,
    /// Bytes of the file to which it applies.
    pub over: Range<usize>,
}

/// Reads `lint` of an object with the range `over`.
pub(super) fn read_allowance(
    node: Option<&Node>,
    over: Range<usize>,
    problems: &mut Vec<Problem>,
) -> Option<Allowance> {
    let mut fields = Fields::open(node?, &LINT, problems)?;
    let codes: Vec<Text> =
        fields.list("allow").iter().filter_map(|n| values::text(n, "a code", fields.problems)).collect();
    let why = fields.text("why").map_or(String::new(), |t| t.value.trim().to_string());
    let span = fields.span();
    fields.finish();
    let codes = codes.into_iter().map(|t| (t.value.clone(), t.span())).collect();
    Some(Allowance { span, codes, why, over })
}
