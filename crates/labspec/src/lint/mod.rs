//! The rules: one table, and the checks of a lesson's structure.
//!
//! A rule is declared once, beside its check, with its reason and two examples; the list of rules, the long
//! explanations and the tests all come from that declaration. [`crate::rules`] lists them with those of the other layers.

mod models;
pub mod rules;

pub use models::ModelFolder;
pub(crate) use models::{lesson_folder, root_of};

use crate::finding::Finding;
use crate::spec::Lesson;
use labspec_finding::Rule;

/// All rules, by families.
pub fn all() -> impl Iterator<Item = &'static Rule> {
    rules::FAMILIES.iter().flat_map(|family| family.iter().copied())
}

/// Checks the structure of a lesson: everything that needs no engine.
pub(crate) fn check(lesson: &Lesson, models: &ModelFolder, findings: &mut Vec<Finding>) {
    for lab in lesson.all_labs() {
        rules::model::check(lab, models, findings);
        rules::ranges::check_lab(lab, findings);
        rules::control::check(lab, findings);
        rules::plot::check(lab, findings);
        rules::html::check_lab(lab, findings);
        rules::latex::check_lab(lab, findings);
        rules::quotes::check_lab(lab, findings);
    }
    for quiz in &lesson.quizzes {
        rules::quiz::check(quiz, findings);
        rules::html::check_quiz(quiz, findings);
        rules::latex::check_quiz(quiz, findings);
    }
    rules::verify::check(lesson, findings);
    rules::ids::within(lesson, findings);
}

/// Checks what only several lessons together can get wrong: ids that are used twice in a course.
pub fn check_course(lessons: &[&Lesson]) -> Vec<Finding> {
    rules::ids::across(lessons)
}
