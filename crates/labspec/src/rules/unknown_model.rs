use labspec_finding::{Example, Layer, Rule, Severity};

/// The model is not in the model folder.
pub const UNKNOWN_MODEL: &Rule = &Rule {
    code: "unknown-model",
    severity: Severity::Error,
    layer: Layer::Structure,
    summary: "the model is not in the model folder",
    why: "the page cannot load it, and shows an empty lab",
    bad: Example::Lab(r#"{"model": "⟦bal⟧"}"#),
    good: Example::Lab(r#"{"model": "ball"}"#),
};
