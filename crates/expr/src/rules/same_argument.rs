use labspec_finding::{Example, Layer, Rule, Severity};

/// One argument stands twice.
pub const SAME_ARGUMENT: &Rule = &Rule {
    code: "same-argument",
    severity: Severity::Warning,
    layer: Layer::Program,
    summary: "a length, a largest or a smallest of one number twice",
    why: "an index that was copied and not changed: the length of a velocity with x twice and y never",
    bad: Example::Statements("ctx.speed = Math.hypot(data.qvel[0], ⟦data.qvel[0]⟧)"),
    good: Example::Statements("ctx.speed = Math.hypot(data.qvel[0], data.qvel[1])"),
};
