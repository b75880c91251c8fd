use labspec_finding::{Example, Layer, Rule, Severity};

/// An object has no member of this name.
pub const UNKNOWN_FIELD: &Rule = &Rule {
    code: "unknown-field",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "an object has no member of this name",
    why: "JavaScript gives undefined, and a computation with it gives NaN",
    bad: Example::Expression("data.⟦qpso⟧[7]"),
    good: Example::Expression("data.qpos[7]"),
};
