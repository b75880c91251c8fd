use labspec_finding::{Example, Layer, Rule, Severity};

/// The source is longer than the language accepts.
pub const TOO_LONG: &Rule = &Rule {
    code: "too-long",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "the source is longer than the language accepts",
    why: "a limit keeps a program responsive whatever it is given",
    bad: Example::OfHost,
    good: Example::OfHost,
};
