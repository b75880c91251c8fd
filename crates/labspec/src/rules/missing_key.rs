use labspec_finding::{Example, Finding, Layer, Rule, Severity};
use std::ops::Range;

/// An object lacks a key that it needs.
pub const MISSING_KEY: &Rule = &Rule {
    code: "missing-key",
    severity: Severity::Error,
    layer: Layer::Structure,
    summary: "an object lacks a key that it needs",
    why: "the page shows an empty place, or stops there",
    bad: Example::Lab(r#"{"model": "ball", "readouts": [⟦{⟧"label": "time (s)"}]}"#),
    good: Example::Lab(r#"{"model": "ball", "readouts": [{"label": "time (s)", "expr": "data.time"}]}"#),
};

/// Reports a missing key. `advised`: the key is recommended, not required.
pub(crate) fn describe_missing(
    span: Range<usize>,
    object: &str,
    key: &str,
    why: &'static str,
    advised: bool,
) -> Finding {
    Finding::new(MISSING_KEY, span, format!("{object} needs `{key}`"))
        .severity(if advised { Severity::Warning } else { Severity::Error })
        .why(why)
        .help(format!("add \"{key}\": …"))
}
