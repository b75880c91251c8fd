use labspec_finding::{Example, Layer, Rule, Severity};

/// A tag of no element of HTML.
pub const HTML_ELEMENT: &Rule = &Rule {
    code: "html-element",
    severity: Severity::Warning,
    layer: Layer::Structure,
    summary: "a text of a lab or a quiz has a tag of an element that HTML does not have",
    why: "a browser takes it for an element without a meaning, and what stands between `<` and `>` is not shown",
    bad: Example::Quiz(
        r#"{"id": "fall", "questions": [{"kind": "open", "q": "Is ⟦<strnog>⟧it the same?"}]}"#,
    ),
    good: Example::Quiz(
        r#"{"id": "fall", "questions": [{"kind": "open", "q": "Is <strong>it</strong> the same?"}]}"#,
    ),
};
