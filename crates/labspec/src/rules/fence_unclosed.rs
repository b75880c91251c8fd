use labspec_finding::{Example, Layer, Rule, Severity};

/// A fence has no closing line.
pub const FENCE_UNCLOSED: &Rule = &Rule {
    code: "fence-unclosed",
    severity: Severity::Error,
    layer: Layer::Source,
    summary: "a fence has no closing line",
    why: "the page reads everything below it as part of the fence: text, labs and quizzes disappear",
    bad: Example::Lesson("⟦```lab simlab⟧\n{\"model\": \"ball\"}\n\nNow press play.\n"),
    good: Example::Lesson("```lab simlab\n{\"model\": \"ball\"}\n```\n\nNow press play.\n"),
};
