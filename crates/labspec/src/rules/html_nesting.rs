use labspec_finding::{Example, Layer, Rule, Severity};

/// HTML elements in a lab or a quiz are not closed in the order in which they are opened.
pub const HTML_NESTING: &Rule = &Rule {
    code: "html-nesting",
    severity: Severity::Warning,
    layer: Layer::Structure,
    summary: "HTML elements in a lab or a quiz are not closed in the order in which they are opened",
    why: "a browser guesses where they end, and the rest of the page may look like code or a heading",
    bad: Example::Quiz(
        r#"{"id": "fall", "questions": [{"kind": "open", "q": "<p>What is ⟦<code>⟧qpos?</p>"}]}"#,
    ),
    good: Example::Quiz(
        r#"{"id": "fall", "questions": [{"kind": "open", "q": "<p>What is <code>qpos</code>?</p>"}]}"#,
    ),
};
