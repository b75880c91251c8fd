//! The `verify` objects of a lesson, each with its lab and question.

use crate::spec::{Lab, Lesson, Question, Run, Verify};

/// A `verify` object.
pub(crate) struct LessonClaim<'a> {
    /// The object.
    pub(crate) verify: &'a Verify,
    /// The lab that contains it, or the `sim` of its question.
    pub(crate) lab: Option<&'a Lab>,
    /// Its question; `None` on a lab.
    pub(crate) question: Option<&'a Question>,
}

/// All claims of a lesson: those of labs, then those of questions, then those in comments.
pub(crate) fn all(lesson: &Lesson) -> impl Iterator<Item = LessonClaim<'_>> {
    let of_labs = lesson
        .all_labs()
        .into_iter()
        .filter_map(|lab| Some(LessonClaim { verify: lab.verify.as_ref()?, lab: Some(lab), question: None }));
    let questions = lesson.quizzes.iter().flat_map(|quiz| quiz.numbered());
    let of_questions = questions.filter_map(|(_, question)| {
        Some(LessonClaim { verify: question.verify.as_ref()?, lab: question.sim(), question: Some(question) })
    });
    let claim_comments = lesson.claim_comments.iter();
    let claim_comments =
        claim_comments.map(|comment| LessonClaim { verify: &comment.verify, lab: None, question: None });
    of_labs.chain(of_questions).chain(claim_comments)
}

impl<'a> LessonClaim<'a> {
    /// The lab of the claim. `None` if it has none, or if the lab could not be parsed.
    pub(crate) fn lab(&self, lesson: &'a Lesson) -> Option<&'a Lab> {
        match &lesson.whole(self.verify).lab {
            Some(named) => lesson.named(named),
            None => self.lab,
        }
    }

    /// The lab of a run of the claim.
    pub(crate) fn lab_of(&self, run: &'a Run, lesson: &'a Lesson) -> Option<&'a Lab> {
        run.lab.as_ref().map_or_else(|| self.lab(lesson), |named| lesson.named(named))
    }
}
