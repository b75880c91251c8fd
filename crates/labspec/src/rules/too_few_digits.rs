use labspec_finding::{Example, Layer, Rule, Severity};

/// A readout prints nearly the same number although its value changes.
pub const TOO_FEW_DIGITS: &Rule = &Rule {
    code: "too-few-digits",
    severity: Severity::Warning,
    layer: Layer::Run,
    summary: "a readout prints nearly the same number although its value changes",
    why: "a student sees a number that does not move, or jumps once: it is printed with too few decimals",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "stopAt": 0.3, "readouts": [{"label": "fallen (m)", "expr": "⟦1 - data.qpos[2]⟧", "digits": 0}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "stopAt": 0.3, "readouts": [{"label": "fallen (m)", "expr": "1 - data.qpos[2]", "digits": 2}]}"#,
    ),
};
