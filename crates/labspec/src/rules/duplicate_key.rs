use labspec_finding::{Example, Layer, Rule, Severity};

/// A key is written twice in one object.
pub const DUPLICATE_KEY: &Rule = &Rule {
    code: "duplicate-key",
    severity: Severity::Error,
    layer: Layer::Json,
    summary: "a key is written twice in one object",
    why: "only the last value counts; the page silently ignores the others",
    bad: Example::Lab(r#"{"model": "ball", "stopAt": 1, "⟦stopAt⟧": 2}"#),
    good: Example::Lab(r#"{"model": "ball", "stopAt": 2}"#),
};
