use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `check_one_sided` in `verify/one_sided.rs`.
pub const ONE_SIDED_TOLERANCE: &Rule = &Rule {
    code: "one-sided-tolerance",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Run,
    summary: "a condition compares two measured values with a tolerance on one side only",
    why: "`earth.t - moon.t < 0.01` holds for any `earth.t` that is smaller, so that it does not say that both are equal; `a.v > b.v - 0.01` holds for equal values, so that it does not say that one is larger",
    bad: Example::Quiz(
        r#"{"id": "moon", "questions": [{"q": "On the moon, the ball falls", "options": ["as long", "longer"], "answer": 0, "verify": {"lab": {"stopAt": 2, "xml": "<mujoco><worldbody><body pos='0 0 1'><freejoint/><geom size='.05'/></body></worldbody></mujoco>", "controls": [{"label": "gravity (m/s²)", "set": "model.opt.gravity[2]", "min": -20, "max": 0, "step": 0.01, "value": -9.81, "reset": true}]}, "runs": {"earth": {}, "moon": {"set": {"gravity (m/s²)": -1.62}}}, "measure": {"t": "crossing(data.qpos[2])"}, "options": ["⟦earth.t - moon.t < 0.01⟧", "moon.t > 9 * earth.t"]}}]}"#,
    ),
    good: Example::Quiz(
        r#"{"id": "moon", "questions": [{"q": "On the moon, the ball falls", "options": ["as long", "longer"], "answer": 1, "verify": {"lab": {"stopAt": 2, "xml": "<mujoco><worldbody><body pos='0 0 1'><freejoint/><geom size='.05'/></body></worldbody></mujoco>", "controls": [{"label": "gravity (m/s²)", "set": "model.opt.gravity[2]", "min": -20, "max": 0, "step": 0.01, "value": -9.81, "reset": true}]}, "runs": {"earth": {}, "moon": {"set": {"gravity (m/s²)": -1.62}}}, "measure": {"t": "crossing(data.qpos[2])"}, "options": ["abs(earth.t - moon.t) < 0.01", "moon.t > 1.1 * earth.t"]}}]}"#,
    ),
};
