use labspec_finding::{Example, Layer, Rule, Severity};

/// A model named by a path.
pub const MODEL_NAME: &Rule = &Rule {
    code: "model-name",
    severity: Severity::Error,
    layer: Layer::Structure,
    summary: "a model is named by a path or with its extension",
    why: "a model is a name in the folder of models; nothing outside that folder is opened",
    bad: Example::Lab(r#"{"model": "⟦../other/ball.xml⟧"}"#),
    good: Example::Lab(r#"{"model": "ball"}"#),
};
