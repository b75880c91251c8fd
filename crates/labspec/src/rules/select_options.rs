use crate::json::encode;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};
use std::ops::Range;

/// The options of a select are not a list of pairs of text and value.
pub const SELECT_OPTIONS: &Rule = &Rule {
    code: "select-options",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "the options of a select are not a list of [text, value] pairs",
    why: "the page shows the first element and assigns the second",
    bad: Example::Lab(
        r#"{"model": "ball", "controls": [{"type": "select", "label": "integrator", "set": "model.opt.integrator", "options": [⟦"Euler"⟧, ["RK4", 1]], "value": 1}]}"#,
    ),
    good: Example::Lab(
        r#"{"model": "ball", "controls": [{"type": "select", "label": "integrator", "set": "model.opt.integrator", "options": [["Euler", 0], ["RK4", 1]], "value": 1}]}"#,
    ),
};

/// Reports an option that is not a pair: its text, if it is one, and its index.
pub(crate) fn not_a_pair(span: Range<usize>, text: Option<&str>, index: usize) -> Finding {
    Finding::new(SELECT_OPTIONS, span, "an option of a select must be a pair [text, value]").help(
        match text {
            Some(text) => format!("write [\"{}\", {index}], with the value of this option", encode(text)),
            None => "write [\"RK4\", 1]".to_string(),
        },
    )
}

/// Reports a select without options.
pub(crate) fn no_options(span: Range<usize>) -> Finding {
    Finding::new(SELECT_OPTIONS, span, "this select has no options")
        .help("add \"options\": [[\"Euler\", 0], [\"RK4\", 1]]")
}
