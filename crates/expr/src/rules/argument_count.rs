use labspec_finding::{Example, Layer, Rule, Severity};

/// A function gets too few or too many arguments.
pub const ARGUMENT_COUNT: &Rule = &Rule {
    code: "argument-count",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "a function gets too few or too many arguments",
    why: "what is missing is undefined, what is too much is not looked at",
    bad: Example::OfHost,
    good: Example::OfHost,
};
