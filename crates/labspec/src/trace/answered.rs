//! Answers that a lesson claims: those of numeric questions whose `verify` object has a `value`.

use crate::spec::{Lesson, QuestionKind, Quiz};
use std::ops::Range;

/// Where the answers stand that a `value` computes, in bytes of the file.
pub(crate) fn answered(lesson: &Lesson) -> impl Iterator<Item = Range<usize>> {
    let questions = lesson.quizzes.iter().flat_map(Quiz::numbered).map(|(_, question)| question);
    let claimed = questions.filter(|q| q.verify.as_ref().is_some_and(|verify| verify.value.is_some()));
    claimed.filter_map(|q| match &q.kind {
        QuestionKind::Numeric { answer, .. } => answer.as_ref().map(|answer| answer.span.clone()),
        _ => None,
    })
}
