use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `chaotic` in `verify/quote/messages.rs`.
pub const QUOTE_CHAOTIC: &Rule = &Rule {
    code: "quote-chaotic",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Claim,
    summary: "the digits of a quoted number change when the start changes by less than rounding",
    why: "no reader can reproduce them on another computer or with another version of the simulator",
    bad: Example::Lesson(
        r##"```lab simlab
{"xml": "<mujoco><option integrator='RK4'/><worldbody><body pos='0 0 3'><joint name='a' axis='0 1 0'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/><body pos='0 0 -1'><joint name='b' axis='0 1 0'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></body></worldbody></mujoco>", "title": "Falling", "readouts": [{"label": "time (s)", "expr": "data.time"}]}
```

```quiz
{"id": "fall", "questions": [{"kind": "mcq", "q": "Where does it go?", "options": ["Down", "Up"], "answer": 0, "explain": "After a minute its angle is ⟦12.345 rad⟧.", "verify": {"lab": "#1", "runs": {"run": {"setup": "data.qpos[0] = 3; data.qpos[1] = 0.1", "until": 60}}, "measure": {"a": "final(data.qpos[0])"}, "options": ["run.a < 1000", "run.a > 1000"], "says": [["12.345 rad", "run.a"]]}}]}
```
"##,
    ),
    good: Example::Lesson(
        r##"```lab simlab
{"xml": "<mujoco><option integrator='RK4'/><worldbody><body pos='0 0 3'><joint name='a' axis='0 1 0'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/><body pos='0 0 -1'><joint name='b' axis='0 1 0'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></body></worldbody></mujoco>", "title": "Falling", "readouts": [{"label": "time (s)", "expr": "data.time"}]}
```

```quiz
{"id": "fall", "questions": [{"kind": "mcq", "q": "Where does it go?", "options": ["Down", "Up"], "answer": 0, "explain": "After 0.1 s its angle is 3.0 rad.", "verify": {"lab": "#1", "runs": {"run": {"setup": "data.qpos[0] = 3; data.qpos[1] = 0.1", "until": 0.1}}, "measure": {"a": "final(data.qpos[0])"}, "options": ["run.a < 1000", "run.a > 1000"], "says": [["3.0 rad", "run.a"]]}}]}
```
"##,
    ),
};
