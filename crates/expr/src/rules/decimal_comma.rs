use labspec_finding::{Example, Layer, Rule, Severity};

/// A decimal comma.
pub const DECIMAL_COMMA: &Rule = &Rule {
    code: "decimal-comma",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "a decimal comma",
    why: "a comma separates things; the decimal sign is a point",
    bad: Example::OfHost,
    good: Example::OfHost,
};
