use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `check_tolerance` in `verify/loose_tolerance.rs`.
pub const LOOSE_TOLERANCE: &Rule = &Rule {
    code: "loose-tolerance",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Run,
    summary: "two measured values are called equal, but the tolerance is larger than the values, or they clearly differ",
    why: "the condition would hold for nearly any result: the momentum of a falling ball is then \"conserved\". Values that differ by more than 3 % are not \"the same\", and those that differ by more than 25 % not \"about the same\", unless the text has a number that says how equal they are",
    bad: Example::Quiz(
        r#"{"id": "fall", "questions": [{"q": "The speed of a falling ball", "options": ["stays the same", "changes"], "answer": 0, "verify": {"lab": {"stopAt": 0.3, "xml": "<mujoco><worldbody><body pos='0 0 1'><freejoint/><geom size='.05'/></body></worldbody></mujoco>", "setup": "data.qvel[2] = -1"}, "measure": {"v0": "initial(data.qvel[2])", "v1": "final(data.qvel[2])"}, "options": ["⟦abs(v1 - v0) < 5⟧", "abs(v1 - v0) > 5"]}}]}"#,
    ),
    good: Example::Quiz(
        r#"{"id": "fall", "questions": [{"q": "The speed of a falling ball", "options": ["stays the same", "changes"], "answer": 1, "verify": {"lab": {"stopAt": 0.3, "xml": "<mujoco><worldbody><body pos='0 0 1'><freejoint/><geom size='.05'/></body></worldbody></mujoco>", "setup": "data.qvel[2] = -1"}, "measure": {"v0": "initial(data.qvel[2])", "v1": "final(data.qvel[2])"}, "options": ["abs(v1 - v0) < 0.1", "abs(v1 - v0) > 0.1"]}}]}"#,
    ),
};
