use labspec_finding::{Example, Layer, Rule, Severity};

/// The expression is nested deeper than the language accepts.
pub const TOO_DEEP: &Rule = &Rule {
    code: "too-deep",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "the expression is nested deeper than the language accepts",
    why: "a limit keeps a program responsive whatever it is given",
    bad: Example::OfHost,
    good: Example::OfHost,
};
