use labspec_finding::{Example, Layer, Rule, Severity};

/// Gravity pulls upward, or along the floor.
pub const GRAVITY: &Rule = &Rule {
    code: "mjcf-gravity",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Model,
    summary: "gravity pulls upward, or along the floor",
    why: "z points up: without the minus sign bodies fall upward, and in a model from a program where y points up they fall along the floor",
    bad: Example::Model(
        "<mujoco><option gravity='⟦0 0 9.81⟧'/><worldbody><geom type='plane' size='1 1 1'/><body pos='0 0 1'><freejoint/><geom size='.1'/></body></worldbody></mujoco>",
    ),
    good: Example::Model(
        "<mujoco><option gravity='0 0 -9.81'/><worldbody><geom type='plane' size='1 1 1'/><body pos='0 0 1'><freejoint/><geom size='.1'/></body></worldbody></mujoco>",
    ),
};
