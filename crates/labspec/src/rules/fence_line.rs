use labspec_finding::{Example, Layer, Rule, Severity};

/// The opening line of a fence contains JSON or code.
pub const FENCE_LINE: &Rule = &Rule {
    code: "fence-line",
    severity: Severity::Error,
    layer: Layer::Source,
    summary: "the opening line of a fence contains JSON or code",
    why: "the page reads that line as the kind of the fence, so the content on it is lost",
    bad: Example::Lesson("```lab simlab ⟦{⟧\"model\": \"ball\"}\n```\n"),
    good: Example::Lesson("```lab simlab\n{\"model\": \"ball\"}\n```\n"),
};
