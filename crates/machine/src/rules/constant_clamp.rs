use labspec_finding::{Example, Layer, Rule, Severity};

/// The limits of a number are exchanged.
pub const CONSTANT_CLAMP: &Rule = &Rule {
    code: "constant-clamp",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Program,
    summary: "the limits of a clamp are swapped, so the result is always the same",
    why: "`Math.min(-2, Math.max(2, x))` is -2 for every `x`",
    bad: Example::Statements("data.ctrl[0] = ⟦Math.min(Math.max(data.qvel[6], 2), -2)⟧"),
    good: Example::Statements("data.ctrl[0] = Math.min(Math.max(data.qvel[6], -2), 2)"),
};
