use labspec_finding::{Example, Layer, Rule, Severity};

/// A statement that changes nothing.
pub const UNUSED_RESULT: &Rule = &Rule {
    code: "unused-result",
    severity: Severity::Warning,
    layer: Layer::Program,
    summary: "a statement that changes nothing",
    why: "a value is computed and thrown away",
    bad: Example::OfHost,
    good: Example::OfHost,
};
