use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `check_one_sample` in `verify/one_sample.rs`.
pub const ONE_SAMPLE: &Rule = &Rule {
    code: "one-sample",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Run,
    summary: "a text says that something never happens, but its condition reads only the end of the run, and does not hold for extreme values",
    why: "the value at the end says nothing about the time before: a ball that has come to rest may have been far deeper in the floor when it landed",
    bad: Example::Quiz(
        r#"{"id": "fall", "questions": [{"kind": "truefalse", "q": "The ball never sinks into the floor by more than 1 cm.", "answer": true, "verify": {"lab": {"stopAt": 2, "xml": "<mujoco><worldbody><geom type='plane' size='1 1 .1'/><body pos='0 0 1'><freejoint/><geom size='.05'/></body></worldbody></mujoco>"}, "measure": {"depth": "0.05 - final(data.qpos[2])"}, "options": ["⟦depth < 0.01⟧"]}}]}"#,
    ),
    good: Example::Quiz(
        r#"{"id": "fall", "questions": [{"kind": "truefalse", "q": "The ball never sinks into the floor by more than 1 cm.", "answer": false, "verify": {"lab": {"stopAt": 2, "xml": "<mujoco><worldbody><geom type='plane' size='1 1 .1'/><body pos='0 0 1'><freejoint/><geom size='.05'/></body></worldbody></mujoco>"}, "measure": {"depth": "0.05 - min(data.qpos[2])"}, "options": ["depth < 0.01"]}}]}"#,
    ),
};
