use labspec_finding::{Example, Layer, Rule, Severity};

/// Functions that call each other too deeply.
pub const CALL_DEPTH: &Rule = &Rule {
    code: "calls-too-deep",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "functions that call each other too deeply",
    why: "JavaScript throws there when its stack is full",
    bad: Example::OfHost,
    good: Example::OfHost,
};
