use labspec_finding::{Example, Layer, Rule, Severity};

/// An expression compares with NaN.
pub const COMPARE_NAN: &Rule = &Rule {
    code: "compare-nan",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Program,
    summary: "an expression compares with NaN",
    why: "NaN equals nothing, not even itself",
    bad: Example::Expression("⟦data.time === NaN⟧"),
    good: Example::Expression("Number.isNaN(data.time)"),
};
