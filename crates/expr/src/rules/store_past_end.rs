use labspec_finding::{Example, Layer, Rule, Severity};

/// An element past the end was assigned.
pub const STORE_PAST_END: &Rule = &Rule {
    code: "store-past-end",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "an element past the end was assigned",
    why: "nothing is stored, and nobody is told",
    bad: Example::OfHost,
    good: Example::OfHost,
};
