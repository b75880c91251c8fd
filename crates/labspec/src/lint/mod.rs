//! The checks of a lesson's structure: everything that needs no engine.
//!
//! Each rule is declared beside its check in [`crate::rules`]; here a lesson is walked once for all of them. What several rules share,
//! and what readers ask (fences, listings, HTML), stands in the files beside this one.

pub(crate) mod claims;
pub(crate) mod fence;
pub(crate) mod html;
pub(crate) mod listing;
pub(crate) mod model;
mod models;
pub(crate) mod repeated;

pub use models::ModelFolder;
pub(crate) use models::{lesson_folder, root_of};

use crate::finding::Finding;
use crate::markdown::{BlockKind, Scan};
use crate::rules::{self, CHECKS, Check};
use crate::spec::Lesson;

/// Most names of model elements that are reported one by one.
const MAX_TAGS: usize = 500;

/// What is said about the text of a lesson: its fences, its HTML, its listings.
pub(crate) fn check_text(text: &str, scan: &Scan, findings: &mut Vec<Finding>) {
    findings.extend(scan.problems.iter().map(|problem| fence::told(text, problem)));
    let mut tags = 0;
    for range in &scan.html {
        let found = html::in_markdown(text, range.clone(), MAX_TAGS - tags);
        tags += found.len();
        findings.extend(found);
        if tags >= MAX_TAGS {
            break;
        }
    }
    for block in &scan.blocks {
        if let BlockKind::Code { language, .. } = &block.kind {
            listing::check(language, &block.body, block.whole, findings);
        }
    }
}

/// Walks a lesson with all checks.
pub(crate) fn check(lesson: &Lesson, models: &ModelFolder, findings: &mut Vec<Finding>) {
    for check in CHECKS {
        match check {
            Check::Lab(check) => lesson.all_labs().into_iter().for_each(|lab| check(lab, findings)),
            Check::Control(check) => {
                lesson
                    .all_labs()
                    .into_iter()
                    .flat_map(|lab| &lab.controls)
                    .for_each(|control| check(control, findings));
            }
            Check::Quiz(check) => lesson.quizzes.iter().for_each(|quiz| check(quiz, findings)),
            Check::Question(check) => {
                let questions = lesson.quizzes.iter().flat_map(|quiz| quiz.numbered());
                questions.for_each(|(_, question)| check(question, findings));
            }
            Check::Lesson(check) => check(lesson, findings),
        }
    }
    for lab in lesson.all_labs() {
        model::check(lab, models, findings);
        html::check_lab(lab, findings);
    }
    lesson.quizzes.iter().for_each(|quiz| html::check_quiz(quiz, findings));
}

/// Checks what only several lessons together can get wrong: ids that are used twice in a course.
pub fn check_course(lessons: &[&Lesson]) -> Vec<Finding> {
    rules::across(lessons)
}
