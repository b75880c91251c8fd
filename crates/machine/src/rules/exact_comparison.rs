use labspec_finding::{Example, Layer, Rule, Severity};

/// A number that changes in small steps is compared for equality.
pub const EXACT_COMPARISON: &Rule = &Rule {
    code: "exact-comparison",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a number that changes in small steps is compared for equality",
    why: "the time and the state advance by fractions, which are rounded: the number almost never has exactly this value",
    bad: Example::Statements("if (⟦data.time === 0.05⟧) ctx.late = 1"),
    good: Example::Statements("if (data.time >= 0.05) ctx.late = 1"),
};
