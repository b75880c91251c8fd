use labspec_finding::{Example, Layer, Rule, Severity};

/// A damping is negative.
pub const DAMPING_BELOW_ZERO: &Rule = &Rule {
    code: "damping-below-zero",
    severity: Severity::Warning,
    layer: Layer::Run,
    summary: "a damping is negative",
    why: "a damper takes energy from a moving part; a negative damping adds energy. Friction, a limit or a motor may hide it for a while. The rule skips a damping that a control sets, or that the lab calls negative",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><joint type='slide' axis='0 0 1'/><joint type='hinge' axis='0 1 0'/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "setup": "⟦model.dof_damping.fill(-0.5)⟧", "stopAt": 0.3, "readouts": [{"label": "height (m)", "expr": "data.xpos[5]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><joint type='slide' axis='0 0 1'/><joint type='hinge' axis='0 1 0'/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "setup": "model.dof_damping.fill(0.5)", "stopAt": 0.3, "readouts": [{"label": "height (m)", "expr": "data.xpos[5]"}]}"#,
    ),
};
