use super::Check;
use crate::spec::Question;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// A question has both `answer` and `hash`.
pub const ANSWER_AND_HASH: &Rule = &Rule {
    code: "answer-and-hash",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "a question has both `answer` and `hash`",
    why: "the page grades by the hash, and `answer` shows what the hash is meant to hide",
    bad: Example::Quiz(
        r#"{"id": "fall", "questions": [{"q": "Does mass matter?", "options": ["yes", "no"], "answer": 1, "hash": ⟦{"salt": "fall", "sha256": "c2b13ffa5d46ef6535899ba40be9e4490faad74ee58ea5aaed7c2eecf7da4cfb"}⟧}]}"#,
    ),
    good: Example::Quiz(
        r#"{"id": "fall", "questions": [{"q": "Does mass matter?", "options": ["yes", "no"], "hash": {"salt": "fall", "sha256": "c2b13ffa5d46ef6535899ba40be9e4490faad74ee58ea5aaed7c2eecf7da4cfb"}}]}"#,
    ),
};

pub(super) const CHECK: Check = Check::Question(check_question);

fn check_question(question: &Question, findings: &mut Vec<Finding>) {
    let Some(key) = question.key() else { return };
    if let Some(hash) = &key.hash_beside {
        findings.push(
            Finding::new(ANSWER_AND_HASH, hash.clone(), "this question has both `answer` and `hash`")
                .related(key.span.clone(), "the answer")
                .help("delete one of the two"),
        );
    }
}
