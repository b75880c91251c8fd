use labspec_finding::{Example, Layer, Rule, Severity};

/// The result of `indexOf` is used as a condition.
pub const INDEX_AS_CONDITION: &Rule = &Rule {
    code: "index-as-condition",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Program,
    summary: "the result of `indexOf` is used as a condition",
    why: "`indexOf` returns -1 for a value that is not there, which counts as true, and 0 for the first one, which counts as false",
    bad: Example::Expression("⟦lib.contactPairs().indexOf('floor / ball')⟧ ? 'yes' : 'no'"),
    good: Example::Expression("lib.contactPairs().includes('floor / ball') ? 'yes' : 'no'"),
};
