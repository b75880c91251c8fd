use labspec_finding::{Example, Layer, Rule, Severity};

/// JSON beyond the limits.
pub const JSON_LIMIT: &Rule = &Rule {
    code: "json-limit",
    severity: Severity::Error,
    layer: Layer::Json,
    summary: "the JSON is nested too deeply or holds too many values",
    why: "limits keep a checker and a page responsive whatever they are given",
    bad: Example::Lab(
        r#"{"model": [[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[⟦[⟧"ball"]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]}"#,
    ),
    good: Example::Lab(r#"{"model": "ball"}"#),
};
