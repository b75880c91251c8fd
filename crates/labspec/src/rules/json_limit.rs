use labspec_finding::{Example, Layer, Rule, Severity};

/// The JSON is nested too deeply or holds too many values.
pub const JSON_LIMIT: &Rule = &Rule {
    code: "json-limit",
    severity: Severity::Error,
    layer: Layer::Json,
    summary: "the JSON is nested too deeply or holds too many values",
    why: "limits keep the checker and the page responsive for any input",
    bad: Example::Lab(
        r#"{"model": [[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[⟦[⟧"ball"]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]}"#,
    ),
    good: Example::Lab(r#"{"model": "ball"}"#),
};
