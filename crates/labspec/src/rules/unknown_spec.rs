use labspec_finding::{Example, Layer, Rule, Severity};

/// A JSON file holds neither a lab nor a quiz.
pub const UNKNOWN_SPEC: &Rule = &Rule {
    code: "unknown-spec",
    severity: Severity::Error,
    layer: Layer::Source,
    summary: "a JSON file holds neither a lab nor a quiz",
    why: "the page can show nothing of it",
    bad: Example::Json(r#"⟦{⟧"title": "Falling"}"#),
    good: Example::Json(r#"{"title": "Falling", "model": "ball"}"#),
};
