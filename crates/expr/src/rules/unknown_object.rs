use labspec_finding::{Example, Layer, Rule, Severity};

/// There is no object of this name.
pub const UNKNOWN_OBJECT: &Rule = &Rule {
    code: "unknown-object",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "there is no object of this name",
    why: "JavaScript throws there",
    bad: Example::OfHost,
    good: Example::OfHost,
};
