use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `report_undecided` in `verify/grounded.rs`.
pub const COMPARES_NAN: &Rule = &Rule {
    code: "compares-nan",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Claim,
    summary: "a condition compares NaN",
    why: "a comparison with NaN is never true, so it says nothing about the answer; zero divided by zero is NaN",
    bad: Example::Question(
        r##"{"kind": "mcq", "q": "What happens to the ball?", "options": ["It falls", "It rises"], "answer": 0, "explain": "It has a weight.",
 "verify": {"lab": "#1", "runs": {"run": {"until": 0.3}}, "measure": {"z": "final(data.qpos[2])", "x": "final(data.qpos[0])"}, "options": ["⟦run.x / (run.x * run.z) > 2⟧", "run.z > 1"]}}"##,
    ),
    good: Example::Question(
        r##"{"kind": "mcq", "q": "What happens to the ball?", "options": ["It falls", "It rises"], "answer": 0, "explain": "It has a weight.",
 "verify": {"lab": "#1", "runs": {"run": {"until": 0.3}}, "measure": {"z": "final(data.qpos[2])"}, "options": ["run.z < 0.9", "run.z > 1"]}}"##,
    ),
};
