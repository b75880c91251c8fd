use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `judge` in `check/setconst/findings.rs`.
pub const SHAPE_ALONE: &Rule = &Rule {
    code: "shape-alone",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Run,
    summary: "a program changes the size or the position of a geom but not the values that follow from it",
    why: "MuJoCo finds contacts within the bounding radius, and turns a body by its inertia about its centre of mass: without the first a larger geom passes through others, without the others the body turns as before. The finding states what differs in a run with these values corrected",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom type='plane' size='2 2 1'/><body pos='0 0 1'><freejoint/><geom size='.05' mass='1'/></body></worldbody></mujoco>", "stopAt": 1, "controls": [{"label": "radius (m)", "apply": "⟦model.geom_size[3] = value⟧", "reset": true, "min": 0.05, "max": 0.3, "value": 0.05, "step": 0.05}], "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom type='plane' size='2 2 1'/><body pos='0 0 1'><freejoint/><geom size='.05' mass='1'/></body></worldbody></mujoco>", "stopAt": 1, "controls": [{"label": "radius (m)", "apply": "model.geom_size[3] = value; model.geom_rbound[1] = value; for (let i = 3; i < 6; i++) model.body_inertia[i] = 0.4 * model.body_mass[1] * value * value; mj.mj_setConst(model, data)", "reset": true, "min": 0.05, "max": 0.3, "value": 0.05, "step": 0.05}], "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}]}"#,
    ),
};
