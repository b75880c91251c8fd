use labspec_finding::{Example, Layer, Rule, Severity};

/// A declaration alone behind a condition or a loop.
pub const LONE_DECLARATION: &Rule = &Rule {
    code: "lone-declaration",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "a declaration alone behind a condition or a loop",
    why: "the name would be gone at once; JavaScript refuses it",
    bad: Example::OfHost,
    good: Example::OfHost,
};
