use labspec_finding::{Example, Layer, Rule, Severity};

/// A fence without its closing line.
pub const FENCE_UNCLOSED: &Rule = &Rule {
    code: "fence-unclosed",
    severity: Severity::Error,
    layer: Layer::Source,
    summary: "the closing line of a fence is missing",
    why: "everything below it counts as part of the fence: text, labs and quizzes disappear from the page",
    bad: Example::Lesson("⟦```lab simlab⟧\n{\"model\": \"ball\"}\n\nNow press play.\n"),
    good: Example::Lesson("```lab simlab\n{\"model\": \"ball\"}\n```\n\nNow press play.\n"),
};
