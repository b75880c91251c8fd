use labspec_finding::{Example, Layer, Rule, Severity};

/// The host rejects a stored value.
pub const HOST_STORE: &Rule = &Rule {
    code: "store-failed",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "the model rejects a stored value",
    why: "nothing is stored, and the page shows no error",
    bad: Example::Statements("⟦model.opt.timestep = 0⟧"),
    good: Example::Statements("model.opt.timestep = 0.001"),
};
