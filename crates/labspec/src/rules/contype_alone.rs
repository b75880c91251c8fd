use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `judge` in `check/setconst/findings.rs`.
pub const CONTYPE_ALONE: &Rule = &Rule {
    code: "contype-alone",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Run,
    summary: "a program switches the contacts of a geom on but not the contact bits of its body",
    why: "MuJoCo tests the contact bits of bodies before those of geoms, and computes them when the model is compiled: a geom that is switched on alone still passes through everything. The finding states what differs in a run with both",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom type='plane' size='2 2 1'/><body pos='0 0 .5'><freejoint/><geom type='box' size='.1 .1 .1' contype='0' conaffinity='0'/></body></worldbody></mujoco>", "stopAt": 1, "controls": [{"type": "button", "label": "solid", "run": "⟦model.geom_contype[1] = 1⟧"}], "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom type='plane' size='2 2 1'/><body pos='0 0 .5'><freejoint/><geom type='box' size='.1 .1 .1' contype='0' conaffinity='0'/></body></worldbody></mujoco>", "stopAt": 1, "controls": [{"type": "button", "label": "solid", "run": "model.geom_contype[1] = 1; model.body_contype[1] = 1"}], "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}]}"#,
    ),
};
