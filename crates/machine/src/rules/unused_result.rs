use labspec_finding::{Example, Layer, Rule, Severity};

/// A statement has no effect.
pub const UNUSED_RESULT: &Rule = &Rule {
    code: "unused-result",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a statement has no effect",
    why: "it computes a value and discards it",
    bad: Example::Statements("⟦data.qpos[7] + 1⟧"),
    good: Example::Statements("data.qpos[7] += 1"),
};
