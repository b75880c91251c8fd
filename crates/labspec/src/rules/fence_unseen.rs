use labspec_finding::{Example, Layer, Rule, Severity};

/// Markdown does not read an opening line as a fence.
pub const FENCE_UNSEEN: &Rule = &Rule {
    code: "fence-unseen",
    severity: Severity::Error,
    layer: Layer::Source,
    summary: "Markdown does not read an opening line as a fence",
    why: "a fence line must not contain another backtick and must not be inside HTML; the page shows the block as text",
    bad: Example::Lesson("<div>\n⟦```lab simlab⟧\n{\"model\": \"ball\"}\n```\n</div>\n"),
    good: Example::Lesson("<div>\n\n```lab simlab\n{\"model\": \"ball\"}\n```\n\n</div>\n"),
};
