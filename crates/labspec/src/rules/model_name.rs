use labspec_finding::{Example, Layer, Rule, Severity};

/// A lab names its model by a path or with an extension.
pub const MODEL_NAME: &Rule = &Rule {
    code: "model-name",
    severity: Severity::Error,
    layer: Layer::Structure,
    summary: "a lab names its model by a path or with an extension",
    why: "a model is a name in the model folder; the checker opens nothing outside that folder",
    bad: Example::Lab(r#"{"model": "⟦../other/ball.xml⟧"}"#),
    good: Example::Lab(r#"{"model": "ball"}"#),
};
