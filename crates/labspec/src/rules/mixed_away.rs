use labspec_finding::{Example, Layer, Rule, Severity};

/// A control sets a contact parameter of one geom, but the contact has another value.
pub const MIXED_AWAY: &Rule = &Rule {
    code: "mixed-away",
    severity: Severity::Warning,
    layer: Layer::Run,
    summary: "a control sets a contact parameter of one geom, but the contact has another value",
    why: "a contact takes the larger friction of its two geoms and a mean of their `solref`, so it does not do what the slider says",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><option gravity='2 0 -9.81'/><worldbody><geom name='floor' type='plane' size='1 1 1' friction='.5'/><body name='box' pos='0 0 .05'><freejoint/><geom name='box' type='box' size='.05 .05 .05' mass='1' friction='.5'/></body></worldbody></mujoco>", "stopAt": 0.5, "controls": [{"label": "friction", "set": "⟦model.geom_friction[3]⟧", "min": 0.1, "max": 0.9, "value": 0.5}], "readouts": [{"label": "place (m)", "expr": "data.qpos[0]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><option gravity='2 0 -9.81'/><worldbody><geom name='floor' type='plane' size='1 1 1' friction='.5'/><body name='box' pos='0 0 .05'><freejoint/><geom name='box' type='box' size='.05 .05 .05' mass='1' friction='.5'/></body></worldbody></mujoco>", "stopAt": 0.5, "controls": [{"label": "friction", "apply": "model.geom_friction[0] = value; model.geom_friction[3] = value", "min": 0.05, "max": 0.3, "value": 0.1, "step": 0.05}], "readouts": [{"label": "place (m)", "expr": "data.qpos[0]"}]}"#,
    ),
};
