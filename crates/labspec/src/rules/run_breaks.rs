use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `report_runs` in `verify/check_verify.rs`.
pub const RUN_BREAKS: &Rule = &Rule {
    code: "run-breaks",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Claim,
    summary: "a run of a `verify` object breaks",
    why: "it meets a bad number, fails silently (energy from nothing, a body that passes through another one), or an expression throws, so its measures prove nothing",
    bad: Example::Question(
        r##"{"kind": "mcq", "q": "What happens to the ball?", "options": ["It falls", "It rises"], "answer": 0, "explain": "It has a weight.",
 "verify": {"lab": "#1", "runs": {"⟦run⟧": {"setup": "data.qpos[2] = 1e20", "until": 0.3}}, "measure": {"z": "final(data.qpos[2])"}, "options": ["run.z < 1", "run.z > 1"]}}"##,
    ),
    good: Example::Question(
        r##"{"kind": "mcq", "q": "What happens to the ball?", "options": ["It falls", "It rises"], "answer": 0, "explain": "It has a weight.",
 "verify": {"lab": "#1", "runs": {"run": {"until": 0.3}}, "measure": {"z": "final(data.qpos[2])"}, "options": ["run.z < 1", "run.z > 1"]}}"##,
    ),
};
