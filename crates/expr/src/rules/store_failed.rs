use labspec_finding::{Example, Layer, Rule, Severity};

/// The host refused to store a value.
pub const HOST_STORE: &Rule = &Rule {
    code: "store-failed",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "the host refused to store a value",
    why: "nothing is stored, and nobody is told",
    bad: Example::OfHost,
    good: Example::OfHost,
};
