use labspec_finding::{Example, Finding, Layer, Rule, Severity};
use std::ops::Range;

/// An object lacks a key that it needs.
pub const MISSING_KEY: &Rule = &Rule {
    code: "missing-key",
    severity: Severity::Error,
    exceptions: &[(Severity::Warning, "if the page works without the key")],
    layer: Layer::Structure,
    summary: "an object lacks a key that it needs",
    why: "the page shows an empty place, or stops there",
    bad: Example::Lab(r#"{"model": "ball", "readouts": [⟦{⟧"label": "time (s)"}]}"#),
    good: Example::Lab(r#"{"model": "ball", "readouts": [{"label": "time (s)", "expr": "data.time"}]}"#),
};

/// Reports a missing key. `advised`: the key is recommended, not required. `example` is a possible value.
pub(crate) fn describe_missing(
    span: Range<usize>,
    object: &str,
    key: &str,
    why: &'static str,
    advised: bool,
    example: &str,
) -> Finding {
    Finding::new(MISSING_KEY, span, format!("{object} needs `{key}`"))
        .severity(if advised { Severity::Warning } else { Severity::Error })
        .why(why)
        .help(match example {
            "" => format!("add \"{key}\": …"),
            example => format!("add \"{key}\": …, such as `\"{key}\": {example}`"),
        })
}
