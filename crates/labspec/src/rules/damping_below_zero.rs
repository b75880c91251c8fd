use labspec_finding::{Example, Layer, Rule, Severity};

/// A damper is below zero.
pub const DAMPING_BELOW_ZERO: &Rule = &Rule {
    code: "damping-below-zero",
    severity: Severity::Warning,
    layer: Layer::Run,
    summary: "a damper is below zero, and pushes",
    why: "A damper takes energy from what moves; with a number below zero it gives energy. Friction, a limit or a motor may hide it for a while. Where a control sets the damping, or the lab says that it is negative, nothing is said",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><joint type='slide' axis='0 0 1'/><joint type='hinge' axis='0 1 0'/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "setup": "⟦model.dof_damping.fill(-0.5)⟧", "stopAt": 0.3, "readouts": [{"label": "height (m)", "expr": "data.xpos[5]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><joint type='slide' axis='0 0 1'/><joint type='hinge' axis='0 1 0'/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "setup": "model.dof_damping.fill(0.5)", "stopAt": 0.3, "readouts": [{"label": "height (m)", "expr": "data.xpos[5]"}]}"#,
    ),
};
