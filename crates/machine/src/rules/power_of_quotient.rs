use labspec_finding::{Example, Layer, Rule, Severity};

/// A quotient after `**` is not in parentheses.
pub const POWER_OF_QUOTIENT: &Rule = &Rule {
    code: "power-of-quotient",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a quotient after `**` is not in parentheses",
    why: "`**` binds more tightly than `/`: `x ** 1/2` is half of x, not its root",
    bad: Example::Expression("⟦data.qpos[2] ** 1/2⟧"),
    good: Example::Expression("data.qpos[2] ** (1/2)"),
};
