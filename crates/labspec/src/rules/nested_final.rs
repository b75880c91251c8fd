use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `nested_finals` in `verify/nested_final.rs`.
pub const NESTED_FINAL: &Rule = &Rule {
    code: "nested-final",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Claim,
    summary: "a measure has `final` in the arguments of another aggregate",
    why: "an aggregate in an argument covers only the samples so far, so `final(x)` equals `x`: `settles(x, final(x), 0.05)` is 0 in every run",
    bad: Example::Quiz(
        r#"{"id": "swing", "questions": [{"kind": "truefalse", "q": "The pendulum comes to rest within five seconds.", "answer": true, "verify": {"lab": {"stopAt": 6, "setup": "data.qpos[0] = 0.5", "xml": "<mujoco><worldbody><body><joint axis='0 1 0' damping='0.2'/><geom size='.05' pos='0 0 -.5'/></body></worldbody></mujoco>"}, "measure": {"rest": "settles(data.qpos[0], ⟦final(data.qpos[0])⟧, 0.05)"}, "options": ["rest < 5"]}}]}"#,
    ),
    good: Example::Quiz(
        r#"{"id": "swing", "questions": [{"kind": "truefalse", "q": "The pendulum comes to rest within five seconds.", "answer": true, "verify": {"lab": {"stopAt": 6, "setup": "data.qpos[0] = 0.5", "xml": "<mujoco><worldbody><body><joint axis='0 1 0' damping='2'/><geom size='.05' pos='0 0 -.5'/></body></worldbody></mujoco>"}, "measure": {"rest": "settles(data.qpos[0], 0, 0.05)"}, "options": ["rest < 5"]}}]}"#,
    ),
};
