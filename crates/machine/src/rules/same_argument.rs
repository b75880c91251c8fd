use labspec_finding::{Example, Layer, Rule, Severity};

/// A length, a maximum or a minimum takes the same number twice.
pub const SAME_ARGUMENT: &Rule = &Rule {
    code: "same-argument",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a length, a maximum or a minimum takes the same number twice",
    why: "an index was copied and not changed: the length of a velocity uses x twice and y never",
    bad: Example::Statements("ctx.speed = Math.hypot(data.qvel[0], ⟦data.qvel[0]⟧)"),
    good: Example::Statements("ctx.speed = Math.hypot(data.qvel[0], data.qvel[1])"),
};
