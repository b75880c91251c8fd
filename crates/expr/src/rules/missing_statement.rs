use labspec_finding::{Example, Layer, Rule, Severity};

/// A condition or a loop has nothing to do.
pub const MISSING_STATEMENT: &Rule = &Rule {
    code: "missing-statement",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "a condition or a loop has nothing to do",
    why: "JavaScript refuses the whole text",
    bad: Example::OfHost,
    good: Example::OfHost,
};
