use labspec_finding::{Example, Layer, Rule, Severity};

/// A sign before `**`.
pub const AMBIGUOUS_POWER: &Rule = &Rule {
    code: "ambiguous-power",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "a sign before `**`",
    why: "JavaScript refuses it, because it could mean either of two numbers",
    bad: Example::OfHost,
    good: Example::OfHost,
};
