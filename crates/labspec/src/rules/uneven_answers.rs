use super::positions::at_least;
use crate::finding::{Finding, InFile};
use crate::spec::{Lesson, QuestionKind};
use labspec_finding::{Example, Layer, Rule, Severity};

/// The correct options of a course share one position so often that guessing pays.
pub const UNEVEN_ANSWERS: &Rule = &Rule {
    code: "uneven-answers",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "the correct options of a course share one position so often that guessing pays",
    why: "a student who always picks that position scores as if they had understood half of it",
    bad: Example::Json(
        r#"{"id": "fall", "questions": [{"q": "1?", "options": ["a", "b", "c", "d"], "answer": ⟦1⟧}, {"q": "2?", "options": ["a", "b", "c", "d"], "answer": 1}, {"q": "3?", "options": ["a", "b", "c", "d"], "answer": 1}, {"q": "4?", "options": ["a", "b", "c", "d"], "answer": 1}, {"q": "5?", "options": ["a", "b", "c", "d"], "answer": 1}, {"q": "6?", "options": ["a", "b", "c", "d"], "answer": 1}, {"q": "7?", "options": ["a", "b", "c", "d"], "answer": 1}]}"#,
    ),
    good: Example::Json(
        r#"{"id": "fall", "questions": [{"q": "1?", "options": ["a", "b", "c", "d"], "answer": 1}, {"q": "2?", "options": ["a", "b", "c", "d"], "answer": 0}, {"q": "3?", "options": ["a", "b", "c", "d"], "answer": 3}, {"q": "4?", "options": ["a", "b", "c", "d"], "answer": 2}, {"q": "5?", "options": ["a", "b", "c", "d"], "answer": 1}, {"q": "6?", "options": ["a", "b", "c", "d"], "answer": 0}, {"q": "7?", "options": ["a", "b", "c", "d"], "answer": 3}]}"#,
    ),
};

/// The threshold probability: one course in a thousand by chance.
const MAX_PROBABILITY: f64 = 1e-3;
/// The maximum number of questions that are counted.
const MAX_QUESTIONS: usize = 3000;
/// The maximum number of positions that are counted.
const MAX_POSITIONS: usize = 26;

/// Checks the whole course. Reports once, at the first question with the answer at that position.
pub(super) fn across(lessons: &[&Lesson]) -> Vec<Finding> {
    let mut keys = Vec::new();
    for lesson in lessons {
        for (_, question) in lesson.quizzes.iter().flat_map(|q| q.numbered()) {
            if let QuestionKind::Choice { options, key: Some(key), .. } = &question.kind
                && let Some(right) = question.right_option()
                && options.len() >= 2
            {
                keys.push((right, options.len(), &lesson.file, key.span.clone()));
            }
        }
    }
    keys.truncate(MAX_QUESTIONS);
    let places = keys.iter().map(|(_, n, ..)| *n).max().unwrap_or(0).min(MAX_POSITIONS);
    let count_at = |place: usize| keys.iter().filter(|k| k.0 == place).count();
    let Some(place) = (0..places).max_by_key(|p| (count_at(*p), places - p)) else { return Vec::new() };
    let chances: Vec<f64> =
        keys.iter().map(|(_, n, ..)| if place < *n { 1.0 / *n as f64 } else { 0.0 }).collect();
    // The same could have happened at any of the positions.
    let chance = places as f64 * at_least(&chances, count_at(place));
    let Some((.., file, span)) = keys.iter().find(|k| k.0 == place) else { return Vec::new() };
    if chance >= MAX_PROBABILITY {
        return Vec::new();
    }
    let counts: Vec<String> = (0..places).map(|p| format!("{} at {p}", count_at(p))).collect();
    let expected: f64 = chances.iter().sum();
    vec![
        Finding::plain(
            UNEVEN_ANSWERS,
            span.clone(),
            format!(
                "of {} correct options in the course, {} have index {place}",
                keys.len(),
                count_at(place)
            ),
        )
        .why(format!(
            "by chance there would be {expected:.1} on average, and this many in one of {:.0} courses; correct options by index: {}",
            1.0 / chance,
            counts.join(", ")
        ))
        .help("move the correct option to another position in some questions")
        .at(file),
    ]
}
