use labspec_finding::{Example, Layer, Rule, Severity};

/// The limits of a number are exchanged.
pub const CONSTANT_CLAMP: &Rule = &Rule {
    code: "constant-clamp",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Program,
    summary: "the limits of a number are exchanged, so that the result is always the same",
    why: "the smallest of a number that is at least 2, and -2, is -2",
    bad: Example::Statements("data.ctrl[0] = ⟦Math.min(Math.max(data.qvel[6], 2), -2)⟧"),
    good: Example::Statements("data.ctrl[0] = Math.min(Math.max(data.qvel[6], -2), 2)"),
};
