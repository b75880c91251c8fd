use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `observe` in `crates/monitors/src/unsolved.rs`.
pub const SOLVER_STOPS_EARLY: &Rule = &Rule {
    code: "solver-stops-early",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Run,
    summary: "the solver stops before it has found the forces",
    why: "part of the force of contacts, limits and constraints is missing, step after step: a student sees stacks collapse and things slide",
    bad: Example::Lab(
        r#"{"xml": "⟦<mujoco><option solver='CG' iterations='1'/><worldbody><geom name='floor' type='plane' size='1 1 1'/><body pos='0 0 0.1'><freejoint/><geom type='box' size='.1 .1 .1' mass='1'/></body><body pos='0 0 0.3'><freejoint/><geom type='box' size='.1 .1 .1' mass='1'/></body><body pos='0 0 0.5'><freejoint/><geom type='box' size='.1 .1 .1' mass='1'/></body><body pos='0 0 0.7'><freejoint/><geom type='box' size='.1 .1 .1' mass='1'/></body><body pos='0 0 0.9'><freejoint/><geom type='box' size='.1 .1 .1' mass='1'/></body><body pos='0 0 1.1'><freejoint/><geom type='box' size='.1 .1 .1' mass='1'/></body><body pos='0 0 1.3'><freejoint/><geom type='box' size='.1 .1 .1' mass='1'/></body><body pos='0 0 1.5'><freejoint/><geom type='box' size='.1 .1 .1' mass='1'/></body><body pos='0 0 1.7'><freejoint/><geom type='box' size='.1 .1 .1' mass='1'/></body><body pos='0 0 1.9'><freejoint/><geom type='box' size='.1 .1 .1' mass='1'/></body><body pos='0 0 2.1'><freejoint/><geom type='box' size='.1 .1 .1' mass='1'/></body><body pos='0 0 2.3'><freejoint/><geom type='box' size='.1 .1 .1' mass='1'/></body></worldbody></mujoco>⟧", "stopAt": 1, "readouts": [{"label": "shown", "expr": "data.qpos[0]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><option solver='CG' iterations='100'/><worldbody><geom name='floor' type='plane' size='1 1 1'/><body pos='0 0 0.1'><freejoint/><geom type='box' size='.1 .1 .1' mass='1'/></body><body pos='0 0 0.3'><freejoint/><geom type='box' size='.1 .1 .1' mass='1'/></body><body pos='0 0 0.5'><freejoint/><geom type='box' size='.1 .1 .1' mass='1'/></body><body pos='0 0 0.7'><freejoint/><geom type='box' size='.1 .1 .1' mass='1'/></body><body pos='0 0 0.9'><freejoint/><geom type='box' size='.1 .1 .1' mass='1'/></body><body pos='0 0 1.1'><freejoint/><geom type='box' size='.1 .1 .1' mass='1'/></body><body pos='0 0 1.3'><freejoint/><geom type='box' size='.1 .1 .1' mass='1'/></body><body pos='0 0 1.5'><freejoint/><geom type='box' size='.1 .1 .1' mass='1'/></body><body pos='0 0 1.7'><freejoint/><geom type='box' size='.1 .1 .1' mass='1'/></body><body pos='0 0 1.9'><freejoint/><geom type='box' size='.1 .1 .1' mass='1'/></body><body pos='0 0 2.1'><freejoint/><geom type='box' size='.1 .1 .1' mass='1'/></body><body pos='0 0 2.3'><freejoint/><geom type='box' size='.1 .1 .1' mass='1'/></body></worldbody></mujoco>", "stopAt": 1, "readouts": [{"label": "shown", "expr": "data.qpos[0]"}]}"#,
    ),
};
