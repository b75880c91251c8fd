use labspec_finding::{Example, Layer, Rule, Severity};

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
