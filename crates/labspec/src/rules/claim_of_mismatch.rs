use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `settle` in `check/partners/mod.rs`.
pub const CLAIM_OF_MISMATCH: &Rule = &Rule {
    code: "claim-of-mismatch",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Claim,
    summary: "a claim holds only because a program changes a parameter without the parameter that depends on it",
    why: "a heavier ball with the inertia of a light one rolls faster than any real ball: the claim is checked again with the other parameter corrected, and then it is false",
    bad: Example::Lesson(WRONG_LESSON),
    good: Example::Lesson(RIGHT_LESSON),
};

const WRONG_LESSON: &str = r##"```lab simlab
{"xml": "<mujoco><option gravity='4.905 0 -8.496'/><worldbody><geom type='plane' size='9 9 1'/><body name='ball' pos='0 0 .1'><freejoint/><geom size='.1' mass='1'/></body></worldbody></mujoco>", "stopAt": 1, "controls": [{"label": "mass (kg)", "apply": "model.body_mass[1] = value; mj.mj_setConst(model, data)", "reset": true, "min": 1, "max": 10, "value": 1}], "readouts": [{"label": "speed (m/s)", "expr": "data.qvel[0]"}]}
```

```quiz
{"id": "ramp", "title": "A ramp", "questions": [{"kind": "mcq", "q": "Which ball is faster after one second, that of 1 kg or that of 10 kg?", "options": ["The heavy one", "Neither"], "answer": 0, "explain": "Compare both.",
 "verify": {"lab": "#1", "runs": {"light": {"set": {"mass (kg)": 1}, "until": 1}, "heavy": {"set": {"mass (kg)": 10}, "until": 1}}, "measure": {"v": "final(data.qvel[0])"},
 "options": ["⟦heavy.v > light.v + 0.1⟧", "abs(heavy.v - light.v) < 0.05"]}}]}
```
"##;

const RIGHT_LESSON: &str = r##"```lab simlab
{"xml": "<mujoco><option gravity='4.905 0 -8.496'/><worldbody><geom type='plane' size='9 9 1'/><body name='ball' pos='0 0 .1'><freejoint/><geom size='.1' mass='1'/></body></worldbody></mujoco>", "stopAt": 1, "controls": [{"label": "mass (kg)", "apply": "const f = value / model.body_mass[1]; model.body_mass[1] = value; for (let i = 3; i < 6; i++) model.body_inertia[i] *= f; mj.mj_setConst(model, data)", "reset": true, "min": 1, "max": 10, "value": 1}], "readouts": [{"label": "speed (m/s)", "expr": "data.qvel[0]"}]}
```

```quiz
{"id": "ramp", "title": "A ramp", "questions": [{"kind": "mcq", "q": "Which ball is faster after one second, that of 1 kg or that of 10 kg?", "options": ["The heavy one", "Neither"], "answer": 1, "explain": "Compare both.",
 "verify": {"lab": "#1", "runs": {"light": {"set": {"mass (kg)": 1}, "until": 1}, "heavy": {"set": {"mass (kg)": 10}, "until": 1}}, "measure": {"v": "final(data.qvel[0])"},
 "options": ["heavy.v > light.v + 0.1", "abs(heavy.v - light.v) < 0.05"]}}]}
```
"##;
