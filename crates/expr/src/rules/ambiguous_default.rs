use labspec_finding::{Example, Layer, Rule, Severity};

/// `??` beside `||` or `&&` without brackets.
pub const AMBIGUOUS_DEFAULT: &Rule = &Rule {
    code: "ambiguous-default",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "`??` beside `||` or `&&` without brackets",
    why: "JavaScript refuses it, because it could mean either of two things",
    bad: Example::OfHost,
    good: Example::OfHost,
};
