use labspec_finding::{Example, Layer, Rule, Severity};

/// The JSON of a block is invalid.
pub const JSON_SYNTAX: &Rule = &Rule {
    code: "json-syntax",
    severity: Severity::Error,
    layer: Layer::Json,
    summary: "the JSON of a block is invalid",
    why: "the page parses the block as a whole, so one wrong character removes the whole lab or quiz",
    bad: Example::Lab(r#"{"model": "ball", "stopAt": 2⟦⟧ "dock": true}"#),
    good: Example::Lab(r#"{"model": "ball", "stopAt": 2, "dock": true}"#),
};
