use labspec_finding::{Example, Layer, Rule, Severity};

/// A link or an image leads to a file or a heading that does not exist.
pub const DEAD_LINK: &Rule = &Rule {
    code: "dead-link",
    severity: Severity::Warning,
    layer: Layer::Structure,
    summary: "a link or an image leads to a file or a heading that does not exist",
    why: "a student lands on a missing page, or sees a broken image",
    bad: Example::Lesson("# Falling\n\nSee ⟦[below](#bouncing)⟧.\n"),
    good: Example::Lesson("# Falling\n\nSee [below](#bouncing).\n\n# Bouncing\n\nIt bounces.\n"),
};
