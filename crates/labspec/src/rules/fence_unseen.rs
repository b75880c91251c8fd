use labspec_finding::{Example, Layer, Rule, Severity};

/// A fence that Markdown does not see.
pub const FENCE_UNSEEN: &Rule = &Rule {
    code: "fence-unseen",
    severity: Severity::Error,
    layer: Layer::Source,
    summary: "Markdown does not take an opening line for a fence",
    why: "a fence line must hold no further backtick and must not stand inside of HTML; the block is shown as text",
    bad: Example::Lesson("<div>\n⟦```lab simlab⟧\n{\"model\": \"ball\"}\n```\n</div>\n"),
    good: Example::Lesson("<div>\n\n```lab simlab\n{\"model\": \"ball\"}\n```\n\n</div>\n"),
};
