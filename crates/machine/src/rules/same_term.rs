use labspec_finding::{Example, Layer, Rule, Severity};

/// A sum contains the same product twice.
pub const SAME_TERM: &Rule = &Rule {
    code: "same-term",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a sum contains the same product or square twice",
    why: "an index was copied and not changed: the sum of squares uses y twice and z never",
    bad: Example::Expression("Math.sqrt(data.qvel[0] ** 2 + data.qvel[1] ** 2 + ⟦data.qvel[1] ** 2⟧)"),
    good: Example::Expression("Math.sqrt(data.qvel[0] ** 2 + data.qvel[1] ** 2 + data.qvel[2] ** 2)"),
};
