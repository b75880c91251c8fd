use crate::json::{MAX_DEPTH, MAX_VALUES};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};
use std::ops::Range;

/// The JSON is nested too deeply or holds too many values.
pub const JSON_LIMIT: &Rule = &Rule {
    code: "json-limit",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Json,
    summary: "the JSON is nested too deeply or holds too many values",
    why: "limits keep the checker and the page responsive for any input",
    bad: Example::Lab(
        r#"{"model": [[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[⟦[⟧"ball"]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]}"#,
    ),
    good: Example::Lab(r#"{"model": "ball"}"#),
};

/// Reports too deeply nested brackets.
pub(crate) fn too_deep(span: Range<usize>) -> Finding {
    Finding::new(JSON_LIMIT, span, format!("the JSON has more than {MAX_DEPTH} nested brackets"))
        .help("look for a bracket that is not closed: a lab needs about eight levels")
}

/// Reports more values than the limit.
pub(crate) fn too_many(span: Range<usize>) -> Finding {
    Finding::new(JSON_LIMIT, span, format!("the JSON has more than {MAX_VALUES} values"))
        .help("split it into several labs")
}
