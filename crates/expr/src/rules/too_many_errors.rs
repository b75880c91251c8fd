use labspec_finding::{Example, Layer, Rule, Severity};

/// So many mistakes that the rest was not read.
pub const TOO_MANY_ERRORS: &Rule = &Rule {
    code: "too-many-errors",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "so many mistakes that the rest was not read",
    why: "the first mistakes explain most of the others",
    bad: Example::OfHost,
    good: Example::OfHost,
};
