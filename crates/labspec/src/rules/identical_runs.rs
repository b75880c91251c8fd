use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `check_identical_runs` in `verify/identical_runs.rs`.
pub const IDENTICAL_RUNS: &Rule = &Rule {
    code: "identical-runs",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Run,
    summary: "two runs of a `verify` object have the same settings and measure the same",
    why: "they give the same numbers, so that every comparison between them says that nothing changes. Usually one setting is missing or copied. A value that a control or the model has from the start is not a difference, however it is set, and neither is the length of a run for a measure that is the same number in both",
    bad: Example::Quiz(
        r#"{"id": "moon", "questions": [{"q": "On the moon, the ball falls", "options": ["as long", "longer"], "answer": 0, "verify": {"lab": {"stopAt": 2, "xml": "<mujoco><worldbody><body pos='0 0 1'><freejoint/><geom size='.05'/></body></worldbody></mujoco>", "controls": [{"label": "gravity (m/s²)", "set": "model.opt.gravity[2]", "min": -20, "max": 0, "step": 0.01, "value": -9.81, "reset": true}]}, "runs": {"earth": {}, "⟦moon⟧": {"set": {"gravity (m/s²)": -9.81}}}, "measure": {"t": "crossing(data.qpos[2])"}, "options": ["abs(moon.t - earth.t) < 0.01", "moon.t > 1.1 * earth.t"]}}]}"#,
    ),
    good: Example::Quiz(
        r#"{"id": "moon", "questions": [{"q": "On the moon, the ball falls", "options": ["as long", "longer"], "answer": 1, "verify": {"lab": {"stopAt": 2, "xml": "<mujoco><worldbody><body pos='0 0 1'><freejoint/><geom size='.05'/></body></worldbody></mujoco>", "controls": [{"label": "gravity (m/s²)", "set": "model.opt.gravity[2]", "min": -20, "max": 0, "step": 0.01, "value": -9.81, "reset": true}]}, "runs": {"earth": {}, "moon": {"set": {"gravity (m/s²)": -1.62}}}, "measure": {"t": "crossing(data.qpos[2])"}, "options": ["abs(moon.t - earth.t) < 0.01", "moon.t > 1.1 * earth.t"]}}]}"#,
    ),
};
