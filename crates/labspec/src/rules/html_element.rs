use labspec_finding::{Example, Layer, Rule, Severity};

/// A text of a lab or a quiz has a tag that HTML does not have.
pub const HTML_ELEMENT: &Rule = &Rule {
    code: "html-element",
    severity: Severity::Warning,
    layer: Layer::Structure,
    summary: "a text of a lab or a quiz has a tag that HTML does not have",
    why: "a browser reads it as an unknown element, and does not show the text between `<` and `>`",
    bad: Example::Quiz(
        r#"{"id": "fall", "questions": [{"kind": "open", "q": "Is ⟦<strnog>⟧it the same?"}]}"#,
    ),
    good: Example::Quiz(
        r#"{"id": "fall", "questions": [{"kind": "open", "q": "Is <strong>it</strong> the same?"}]}"#,
    ),
};
