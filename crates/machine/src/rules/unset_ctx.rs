use labspec_finding::{Example, Layer, Rule, Severity};

/// An expression reads a `ctx` variable that nothing stores.
pub const UNSET_GLOBAL: &Rule = &Rule {
    code: "unset-ctx",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Program,
    summary: "an expression reads a `ctx` variable that nothing stores",
    why: "the variable is undefined, and a computation with it gives NaN",
    bad: Example::Expression("⟦ctx.gain⟧ * data.time"),
    good: Example::Expression("data.time"),
};
