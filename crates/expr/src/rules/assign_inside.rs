use labspec_finding::{Example, Layer, Rule, Severity};

/// `=` inside an expression.
pub const ASSIGN_INSIDE: &Rule = &Rule {
    code: "assign-inside",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "`=` inside an expression",
    why: "it stores; a comparison was probably meant",
    bad: Example::OfHost,
    good: Example::OfHost,
};
