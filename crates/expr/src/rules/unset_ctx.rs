use labspec_finding::{Example, Layer, Rule, Severity};

/// A `ctx` variable is read that nothing stores.
pub const UNSET_GLOBAL: &Rule = &Rule {
    code: "unset-ctx",
    severity: Severity::Warning,
    layer: Layer::Program,
    summary: "a `ctx` variable is read that nothing stores",
    why: "it is undefined, and a computation with it gives NaN",
    bad: Example::Expression("⟦ctx.gain⟧ * data.time"),
    good: Example::Expression("data.time"),
};
