use labspec_finding::{Example, Layer, Rule, Severity};

/// A member or an element of something that has none.
pub const NO_PARTS: &Rule = &Rule {
    code: "no-parts",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "a member or an element of something that has none",
    why: "JavaScript throws there, and stops the whole text",
    bad: Example::OfHost,
    good: Example::OfHost,
};
