use super::Check;
use crate::spec::{ChoiceStyle, Lesson, Question, QuestionKind};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// Predictions have no `verify`, so nothing checks their answers.
pub const PREDICTION_UNCHECKED: &Rule = &Rule {
    code: "prediction-unchecked",
    severity: Severity::Note,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "predictions have no `verify`, so nothing checks their answers",
    why: "the lab that decides them is available: every check runs a `verify`, and reports when a change of the model makes an answer false",
    bad: Example::Quiz(
        r#"{"id": "fall", "questions": [⟦{"kind": "predict", "q": "Does mass matter?", "options": ["yes", "no"], "answer": 1, "sim": {"model": "ball", "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}]}}⟧, {"kind": "predict", "q": "Does height matter?", "options": ["yes", "no"], "answer": 0, "sim": {"model": "ball", "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}]}}]}"#,
    ),
    good: Example::Quiz(
        r#"{"id": "fall", "questions": [{"kind": "mcq", "q": "Does mass matter?", "options": ["yes", "no"], "answer": 1}]}"#,
    ),
};

pub(super) const CHECK: Check = Check::Lesson(check_lesson);

/// Reports one note for a lesson, with the count, at the first prediction.
fn check_lesson(lesson: &Lesson, findings: &mut Vec<Finding>) {
    let all = lesson.quizzes.iter().flat_map(|q| q.numbered()).map(|(_, q)| q);
    let predictions: Vec<&Question> = all
        .filter(|q| matches!(&q.kind, QuestionKind::Choice { style: ChoiceStyle::Predict, sim: Some(_), .. }))
        .collect();
    let open: Vec<&&Question> = predictions.iter().filter(|q| q.verify.is_none()).collect();
    // A single prediction is not reported, but counted among the unchecked answers.
    let Some(first) = open.first().filter(|_| predictions.len() > 1) else { return };
    let (count, total) = (open.len(), predictions.len());
    let message = format!("{count} of {total} predictions have no `verify`; this is the first one");
    findings.push(
        Finding::new(PREDICTION_UNCHECKED, first.span.clone(), message).help(
            "add a `verify` with what to measure in the lab of the question and one condition per option",
        ),
    );
}
