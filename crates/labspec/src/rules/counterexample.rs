use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `hold_over_range` in `verify/over.rs`.
pub const COUNTEREXAMPLE: &Rule = &Rule {
    code: "counterexample",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Claim,
    summary: "an answer is false in part of the range that it is claimed for",
    why: "a student can set the lab to such a value, and sees something different from the keyed answer",
    bad: Example::Question(
        r#"{"kind": "mcq", "q": "How high is the ball after 0.3 s?", "options": ["Above 0.5 m", "Below 0.5 m"], "answer": ⟦0⟧, "verify": {"lab": {"xml": "<mujoco><worldbody><body name='ball' pos='0 0 1'><freejoint/><geom size='.05' mass='1'/></body></worldbody></mujoco>", "controls": [{"label": "gravity", "apply": "model.opt.gravity[2] = -value", "min": 1, "max": 20, "step": 1, "value": 10, "reset": true}]}, "runs": {"fall": {"until": 0.3}}, "measure": {"height": "final(data.qpos[2])"}, "options": ["fall.height > 0.5", "fall.height < 0.5"], "over": {"gravity": [1, 20]}}}"#,
    ),
    good: Example::Question(
        r#"{"kind": "mcq", "q": "How high is the ball after 0.3 s?", "options": ["Above 0.5 m", "Below 0.5 m"], "answer": 0, "verify": {"lab": {"xml": "<mujoco><worldbody><body name='ball' pos='0 0 1'><freejoint/><geom size='.05' mass='1'/></body></worldbody></mujoco>", "controls": [{"label": "gravity", "apply": "model.opt.gravity[2] = -value", "min": 1, "max": 20, "step": 1, "value": 10, "reset": true}]}, "runs": {"fall": {"until": 0.3}}, "measure": {"height": "final(data.qpos[2])"}, "options": ["fall.height > 0.5", "fall.height < 0.5"], "over": {"gravity": [1, 10]}}}"#,
    ),
};
