use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `judge` in `verify/judge/mod.rs`.
pub const ENGINE_DEPENDENT: &Rule = &Rule {
    code: "engine-dependent",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Claim,
    summary: "a claim has a different verdict with the recorded numbers of MuJoCo (--judge)",
    why: "an answer that depends on the engine or its version is wrong for every reader who uses another one",
    bad: Example::Files(&[("fall.md", MARKED.as_bytes()), ("judge.json", WRONG_LESSON.as_bytes())]),
    good: Example::Files(&[("fall.md", LESSON.as_bytes()), ("judge.json", RIGHT_LESSON.as_bytes())]),
};

const MARKED: &str = r##"# A fall

```lab
{"xml": "<mujoco><worldbody><body pos='0 0 1'><freejoint/><geom size='.1'/></body></worldbody></mujoco>", "title": "A fall", "stopAt": 0.2, "readouts": [{"label": "height (m)", "expr": "data.qpos[2]", "digits": 3}],
 "verify": {"runs": {"fall": {"until": 0.2}}, "measure": {"height": "final(shown('height (m)'))"}, "says": [["⟦0.80 m⟧", "fall.height"]]}}
```

After 0.2 s it is at 0.80 m.
"##;
const LESSON: &str = r##"# A fall

```lab
{"xml": "<mujoco><worldbody><body pos='0 0 1'><freejoint/><geom size='.1'/></body></worldbody></mujoco>", "title": "A fall", "stopAt": 0.2, "readouts": [{"label": "height (m)", "expr": "data.qpos[2]", "digits": 3}],
 "verify": {"runs": {"fall": {"until": 0.2}}, "measure": {"height": "final(shown('height (m)'))"}, "says": [["0.80 m", "fall.height"]]}}
```

After 0.2 s it is at 0.80 m.
"##;
const WRONG_LESSON: &str = r#"{"recording": "judge", "version": 1, "engine": "MuJoCo 9.9.9", "runs": [
 {"file": "fall.md", "claim": "lab #1", "run": "fall", "hash": "ec4753daaee7cf8d", "values": {"height": 0.811}}]}
"#;
const RIGHT_LESSON: &str = r#"{"recording": "judge", "version": 1, "engine": "MuJoCo 3.14.0", "runs": [
 {"file": "fall.md", "claim": "lab #1", "run": "fall", "hash": "ec4753daaee7cf8d", "values": {"height": 0.802}}]}
"#;
