use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `check_exchanged_runs` in `verify/named_run.rs`.
pub const QUOTE_OF_ANOTHER_RUN: &Rule = &Rule {
    code: "quote-of-another-run",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Claim,
    summary: "two numbers of the text are swapped: each belongs to the run that the clause of the other one names",
    why: "both numbers are right, but the text assigns them to the wrong runs. The rule compares the names of runs with the words after an article or a preposition, and with the first cells of table rows",
    bad: Example::Quiz(
        r#"{"id": "swing", "questions": [{"kind": "truefalse", "q": "A wide swing takes longer than a small one.", "answer": true, "explain": "The small swing takes ⟦1.65 s⟧, the wide one ⟦1.42 s⟧.", "verify": {"lab": {"stopAt": 6, "xml": "<mujoco><worldbody><body><joint name='j' axis='0 1 0'/><geom size='.05' pos='0 0 -.5'/></body></worldbody></mujoco>", "setup": "data.qpos[0] = ctx.q", "controls": [{"label": "start (rad)", "param": "q", "min": 0, "max": 2, "step": 0.1, "value": 0.1, "reset": true}]}, "runs": {"small": {"set": {"start (rad)": 0.1}}, "wide": {"set": {"start (rad)": 1.5}}}, "measure": {"T": "period(data.qpos[0])"}, "options": ["wide.T > small.T"], "says": [["1.65 s", "wide.T"], ["1.42 s", "small.T"]]}}]}"#,
    ),
    good: Example::Quiz(
        r#"{"id": "swing", "questions": [{"kind": "truefalse", "q": "A wide swing takes longer than a small one.", "answer": true, "explain": "The small swing takes 1.42 s, the wide one 1.65 s.", "verify": {"lab": {"stopAt": 6, "xml": "<mujoco><worldbody><body><joint name='j' axis='0 1 0'/><geom size='.05' pos='0 0 -.5'/></body></worldbody></mujoco>", "setup": "data.qpos[0] = ctx.q", "controls": [{"label": "start (rad)", "param": "q", "min": 0, "max": 2, "step": 0.1, "value": 0.1, "reset": true}]}, "runs": {"small": {"set": {"start (rad)": 0.1}}, "wide": {"set": {"start (rad)": 1.5}}}, "measure": {"T": "period(data.qpos[0])"}, "options": ["wide.T > small.T"], "says": [["1.65 s", "wide.T"], ["1.42 s", "small.T"]]}}]}"#,
    ),
};
