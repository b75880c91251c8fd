use labspec_finding::{Example, Layer, Rule, Severity};

/// An object has a key that the format does not know.
pub const UNKNOWN_KEY: &Rule = &Rule {
    code: "unknown-key",
    severity: Severity::Error,
    layer: Layer::Structure,
    summary: "an object has a key that the format does not know",
    why: "the page ignores it, so what it should do does not happen",
    bad: Example::Lab(
        r#"{"model": "ball", "readouts": [{"label": "t", "⟦exp⟧": "data.time", "expr": "data.time"}]}"#,
    ),
    good: Example::Lab(r#"{"model": "ball", "readouts": [{"label": "t", "expr": "data.time"}]}"#),
};
