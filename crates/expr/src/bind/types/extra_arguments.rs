//! The findings for functions that a method would call with more arguments than they are meant to have.

use crate::rules;
use labspec_finding::{Finding, Span};

/// The finding for a function of `Math` that a method would call with the index and the list as well.
pub(super) fn report_extra_arguments(path: &str, called: &str, span: Span) -> Finding {
    Finding::error(
        rules::ARGUMENT_TYPE,
        span,
        format!("`{path}` would also receive the index and the whole list"),
    )
    .why(format!("`{called}` passes them after the element, and JavaScript converts a list to NaN"))
    .help(format!("write `(a, b) => {path}(a, b)` instead of `{path}`; for all elements of a list, write `{path}(...list)`"))
}

/// The finding for a function of the host whose optional argument would receive the index from a method.
pub(super) fn report_extra_index(name: &str, called: &str, span: Span) -> Finding {
    Finding::error(rules::ARGUMENT_TYPE, span, format!("`{name}` would also receive the index"))
        .why(format!(
            "`{called}` passes it after the element, and the function takes it for its optional argument"
        ))
        .help(format!("write `x => {name}(x)` instead of `{name}`"))
}
