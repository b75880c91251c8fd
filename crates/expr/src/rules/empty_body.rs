use labspec_finding::{Example, Layer, Rule, Severity};

/// A `;` directly behind the head of a condition or a loop.
pub const EMPTY_BODY: &Rule = &Rule {
    code: "empty-body",
    severity: Severity::Warning,
    layer: Layer::Program,
    summary: "a `;` directly behind the head of a condition or a loop",
    why: "the condition decides nothing: what follows always happens",
    bad: Example::OfHost,
    good: Example::OfHost,
};
