use super::Check;
use crate::spec::{AnswerHash, KeyValue, Question};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// A hash is not 64 hexadecimal digits, or its salt is too long.
pub const HASH_FORM: &Rule = &Rule {
    code: "hash-form",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "a hash is not 64 hexadecimal digits, or its salt is too long",
    why: "no answer has this hash, so every student is graded as wrong",
    bad: Example::Quiz(
        r#"{"id": "fall", "questions": [{"q": "Does mass matter?", "options": ["yes", "no"], "hash": {"salt": "fall", "sha256": "⟦6b86b273⟧"}}]}"#,
    ),
    good: Example::Quiz(
        r#"{"id": "fall", "questions": [{"q": "Does mass matter?", "options": ["yes", "no"], "hash": {"salt": "fall", "sha256": "c2b13ffa5d46ef6535899ba40be9e4490faad74ee58ea5aaed7c2eecf7da4cfb"}}]}"#,
    ),
};

pub(super) const CHECK: Check = Check::Question(check_question);

fn check_question(question: &Question, findings: &mut Vec<Finding>) {
    let Some(KeyValue::Hash(hash)) = question.key().map(|key| &key.value) else { return };
    if !hash.has_digits() {
        findings.push(
            Finding::new(HASH_FORM, hash.sha256.span(), "`sha256` is not 64 hexadecimal digits")
                .help("write the SHA-256 of the salt, a colon and the answer"),
        );
    }
    if !hash.has_salt() {
        let message = format!("this salt is longer than {} bytes", AnswerHash::MOST_SALT);
        findings.push(Finding::new(HASH_FORM, hash.salt.span(), message).help("write a shorter salt"));
    }
}
