use labspec_finding::{Example, Layer, Rule, Severity};

/// JSON or code on the opening line.
pub const FENCE_LINE: &Rule = &Rule {
    code: "fence-line",
    severity: Severity::Error,
    layer: Layer::Source,
    summary: "JSON or code stands on the opening line of a fence",
    why: "what stands on that line is the name of the fence's kind, not its content, so it is lost",
    bad: Example::Lesson("```lab simlab ⟦{⟧\"model\": \"ball\"}\n```\n"),
    good: Example::Lesson("```lab simlab\n{\"model\": \"ball\"}\n```\n"),
};
