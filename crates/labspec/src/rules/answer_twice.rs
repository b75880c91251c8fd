use super::Check;
use crate::spec::{KeyValue, Question};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// `answer` lists an option twice.
pub const ANSWER_TWICE: &Rule = &Rule {
    code: "answer-twice",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "`answer` lists an option twice",
    why: "one of the two was probably meant to be another option, which is graded as wrong",
    bad: Example::Quiz(
        r#"{"id": "fall", "questions": [{"kind": "multiple", "q": "What falls?", "options": ["a ball", "a cube", "a planet"], "answer": [0, ⟦0⟧]}]}"#,
    ),
    good: Example::Quiz(
        r#"{"id": "fall", "questions": [{"kind": "multiple", "q": "What falls?", "options": ["a ball", "a cube", "a planet"], "answer": [0, 1]}]}"#,
    ),
};

pub(super) const CHECK: Check = Check::Question(check_question);

fn check_question(question: &Question, findings: &mut Vec<Finding>) {
    let Some(KeyValue::Options(indexes)) = question.key().map(|key| &key.value) else { return };
    let mut first: std::collections::BTreeMap<u64, &crate::json::Number> = Default::default();
    for index in indexes {
        match first.get(&index.value.to_bits()) {
            Some(before) => findings.push(
                Finding::new(
                    ANSWER_TWICE,
                    index.span.clone(),
                    format!("`answer` lists the option {} twice", index.value),
                )
                .related(before.span.clone(), "the first time")
                .help("delete it, or write the index of another option"),
            ),
            None => {
                first.insert(index.value.to_bits(), index);
            }
        }
    }
}
