use labspec_finding::{Example, Layer, Rule, Severity};

/// An element that is not closed, or not where it should be.
pub const HTML_NESTING: &Rule = &Rule {
    code: "html-nesting",
    severity: Severity::Warning,
    layer: Layer::Structure,
    summary: "elements of HTML in a lab or a quiz are not closed in the order in which they are opened",
    why: "a browser guesses where they end, and what follows may look like code, or like a heading, to the end of the page",
    bad: Example::Quiz(
        r#"{"id": "fall", "questions": [{"kind": "open", "q": "<p>What is ⟦<code>⟧qpos?</p>"}]}"#,
    ),
    good: Example::Quiz(
        r#"{"id": "fall", "questions": [{"kind": "open", "q": "<p>What is <code>qpos</code>?</p>"}]}"#,
    ),
};
