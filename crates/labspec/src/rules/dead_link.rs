use labspec_finding::{Example, Layer, Rule, Severity};

/// A link that leads to nothing.
pub const DEAD_LINK: &Rule = &Rule {
    code: "dead-link",
    severity: Severity::Warning,
    layer: Layer::Structure,
    summary: "a link or a picture of the course leads to a file or a heading that is not there",
    why: "a student comes to an empty page, or sees a broken picture",
    bad: Example::Lesson("# Falling\n\nSee ⟦[below](#bouncing)⟧.\n"),
    good: Example::Lesson("# Falling\n\nSee [below](#bouncing).\n\n# Bouncing\n\nIt bounces.\n"),
};
