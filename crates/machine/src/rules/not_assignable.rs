use labspec_finding::{Example, Layer, Rule, Severity};

/// The left side of `=` cannot hold a value.
pub const NOT_ASSIGNABLE: &Rule = &Rule {
    code: "not-assignable",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "the left side of `=` cannot hold a value",
    why: "JavaScript rejects the whole text, or stores nothing",
    bad: Example::Statements("⟦data.time + 1⟧ = 2"),
    good: Example::Statements("data.time = 2"),
};
