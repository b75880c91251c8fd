use labspec_finding::{Example, Layer, Rule, Severity};

/// A quantity that is never negative is displayed below zero.
pub const BELOW_ZERO: &Rule = &Rule {
    code: "below-zero",
    severity: Severity::Warning,
    layer: Layer::Run,
    summary: "a quantity that is never negative is displayed below zero",
    why: "an elapsed time, a number of contacts, a kinetic energy, a mass, a normal force and a magnitude are never negative: the sign or a subtracted term is wrong",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "stopAt": 0.3, "readouts": [{"label": "kinetic energy (J)", "expr": "⟦-lib.energy().kinetic⟧"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "stopAt": 0.3, "readouts": [{"label": "kinetic energy (J)", "expr": "lib.energy().kinetic"}]}"#,
    ),
};
