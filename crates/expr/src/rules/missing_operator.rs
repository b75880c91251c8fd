use labspec_finding::{Example, Layer, Rule, Severity};

/// Two values stand beside each other.
pub const MISSING_OPERATOR: &Rule = &Rule {
    code: "missing-operator",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "two values stand beside each other",
    why: "nothing between them says how they belong together: a product needs its `*`",
    bad: Example::OfHost,
    good: Example::OfHost,
};
