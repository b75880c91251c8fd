use labspec_finding::{Example, Layer, Rule, Severity};

/// Something stands where it has no place.
pub const MISPLACED: &Rule = &Rule {
    code: "misplaced",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "something stands where it has no place",
    why: "JavaScript refuses the whole text",
    bad: Example::OfHost,
    good: Example::OfHost,
};
