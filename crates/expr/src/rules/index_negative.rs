use labspec_finding::{Example, Layer, Rule, Severity};

/// An index below zero.
pub const INDEX_NEGATIVE: &Rule = &Rule {
    code: "index-negative",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "an index below zero",
    why: "JavaScript gives undefined there: indexes count from 0, and never from the end",
    bad: Example::OfHost,
    good: Example::OfHost,
};
