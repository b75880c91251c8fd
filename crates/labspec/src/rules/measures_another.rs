use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `check_words_of_measure` in `verify/measures_another/mod.rs`.
pub const MEASURES_ANOTHER: &Rule = &Rule {
    code: "measures-another",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Run,
    summary: "the words of a text name another object, setting, time or extreme value than the expression beside it reads, and that one has another value",
    why: "the number is right, but for something else: a student who computes what the text says gets another number. The other value is measured in the same run, or is that of the run with the setting",
    bad: Example::Quiz(
        r#"{"id": "balls", "questions": [{"kind": "numeric", "q": "⟦How high is the cork ball at the end?⟧", "answer": 0.56, "tol": 0.01, "unit": "m", "verify": {"lab": {"stopAt": 0.3, "xml": "<mujoco><worldbody><body name='iron' pos='0 0 1'><freejoint/><geom size='.05'/></body><body name='cork' pos='0 0 2'><freejoint/><geom size='.05'/></body></worldbody></mujoco>"}, "measure": {"h": "final(data.body('iron').xpos[2])"}, "value": "h"}}]}"#,
    ),
    good: Example::Quiz(
        r#"{"id": "balls", "questions": [{"kind": "numeric", "q": "How high is the cork ball at the end?", "answer": 1.56, "tol": 0.01, "unit": "m", "verify": {"lab": {"stopAt": 0.3, "xml": "<mujoco><worldbody><body name='iron' pos='0 0 1'><freejoint/><geom size='.05'/></body><body name='cork' pos='0 0 2'><freejoint/><geom size='.05'/></body></worldbody></mujoco>"}, "measure": {"h": "final(data.body('cork').xpos[2])"}, "value": "h"}}]}"#,
    ),
};
