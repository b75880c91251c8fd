use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `judge` in `check/setconst/findings.rs`.
pub const INERTIA_ALONE: &Rule = &Rule {
    code: "inertia-alone",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Run,
    summary: "a program gives a body an inertia that no body of its mass and size has",
    why: "a moment of inertia is at most the mass times the squared distance of the farthest part, and at most the sum of the other two moments. The finding states what differs in a run with the matching mass or moments",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><option gravity='4.905 0 -8.496'/><worldbody><geom type='plane' size='9 9 1'/><body name='ball' pos='0 0 .1'><freejoint/><geom size='.1' mass='1'/></body></worldbody></mujoco>", "stopAt": 1, "controls": [{"label": "inertia of the axle (kg m²)", "apply": "⟦model.body_inertia[4] = value; mj.mj_setConst(model, data); data.qvel[3] = 5; data.qvel[5] = 20⟧", "init": true, "min": 0.004, "max": 0.009, "value": 0.004, "step": 0.001}], "readouts": [{"label": "spin (rad/s)", "expr": "data.qvel[3]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><option gravity='4.905 0 -8.496'/><worldbody><geom type='plane' size='9 9 1'/><body name='ball' pos='0 0 .1'><freejoint/><geom size='.1' mass='1'/></body></worldbody></mujoco>", "stopAt": 1, "controls": [{"label": "inertia (kg m²)", "apply": "for (let i = 3; i < 6; i++) model.body_inertia[i] = value; mj.mj_setConst(model, data)", "reset": true, "min": 0.002, "max": 0.009, "value": 0.004, "step": 0.001}], "readouts": [{"label": "speed (m/s)", "expr": "data.qvel[0]"}]}"#,
    ),
};
