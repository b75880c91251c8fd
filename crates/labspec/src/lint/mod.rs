//! The checks of a lesson's structure, which do not need the engine.
//!
//! Each rule is declared beside its check in [`crate::rules`]. This module visits a lesson once for all of them. The files
//! of this folder map the problems found while reading a lesson (fences, JSON, the format) to rules, and contain code that
//! several rules share.

mod code_scan;
mod fence;
mod format;
pub(crate) mod json;
pub(crate) mod links;
mod listing;
mod load;
mod models;

pub use crate::rules::not_utf8::not_utf8;
pub use links::links_to;
pub use load::{
    MAX_FINDINGS, SNAPSHOT, load_lesson, load_lesson_at, load_lesson_file, reload_lesson, snapshot_path,
    withhold_fixes,
};
pub use models::ModelFolder;
pub use models::lesson_folder;
pub use models::root_of;

pub(crate) use code_scan::{CodeLine, CodeScan};

use crate::finding::Finding;
use crate::markdown::BlockKind;
use crate::rules::{self, CHECKS, Check};
use crate::spec::{Lesson, ModelSource, Problem};

/// Maximum number of reported names of model elements.
const MAX_TAGS: usize = 500;

/// The findings of all structural rules, unordered.
fn check_rules(lesson: &Lesson, models: &ModelFolder) -> Vec<Finding> {
    let mut findings: Vec<Finding> =
        lesson.problems.iter().map(|problem| to_finding(lesson.file.text(), problem)).collect();
    check_text(lesson, &mut findings);
    check_objects(lesson, &mut findings);
    check_models(lesson, models, &mut findings);
    findings
}

/// The finding about a problem found while reading a text.
pub(crate) fn to_finding(text: &str, problem: &Problem) -> Finding {
    match problem {
        Problem::Fence(problem) => fence::to_finding(text, problem),
        Problem::Json(problem) => json::to_finding(problem),
        Problem::Format(problem) => format::to_finding(problem),
    }
}

/// Checks the HTML and the listings of the text.
fn check_text(lesson: &Lesson, findings: &mut Vec<Finding>) {
    let mut tags = 0;
    for range in &lesson.scan.html {
        let found = rules::unescaped_element::in_markdown(lesson.file.text(), range.clone(), MAX_TAGS - tags);
        tags += found.len();
        findings.extend(found);
        if tags >= MAX_TAGS {
            break;
        }
    }
    rules::formula_unbalanced::check_prose(lesson, findings);
    rules::dead_link::check_anchors(lesson, findings);
    for block in &lesson.scan.blocks {
        if let BlockKind::Code { language, .. } = &block.kind {
            listing::check_listing(language, &block.body, block.whole, findings);
        }
    }
}

/// Runs all checks on the labs, quizzes and claims.
fn check_objects(lesson: &Lesson, findings: &mut Vec<Finding>) {
    let labs = lesson.all_labs();
    for check in CHECKS {
        match check {
            Check::Lab(check) => labs.iter().for_each(|lab| check(lab, findings)),
            Check::Control(check) => {
                labs.iter().flat_map(|lab| &lab.controls).for_each(|control| check(control, findings));
            }
            Check::Quiz(check) => lesson.quizzes.iter().for_each(|quiz| check(quiz, findings)),
            Check::Question(check) => {
                let questions = lesson.quizzes.iter().flat_map(|quiz| quiz.numbered());
                questions.for_each(|(_, question)| check(question, findings));
            }
            Check::Lesson(check) => check(lesson, findings),
            // These run when the model is loaded.
            Check::Model(_) => {}
        }
    }
    let notes = labs.iter().filter_map(|lab| lab.note.as_ref());
    let questions = lesson.quizzes.iter().flat_map(|quiz| quiz.numbered());
    for text in notes.chain(questions.flat_map(|(_, question)| question.html())) {
        rules::unescaped_element::check_html(text, findings);
        rules::html_nesting::check_markup(text, findings);
        rules::formula_unbalanced::check_formulas(text, findings);
    }
}

/// Checks the names of models.
fn check_models(lesson: &Lesson, models: &ModelFolder, findings: &mut Vec<Finding>) {
    let labs = lesson.all_labs().into_iter().filter_map(|lab| match lab.scene() {
        Some(ModelSource::Model(name)) => Some(name),
        _ => None,
    });
    let widgets = lesson.widgets.iter().filter_map(|widget| widget.model.as_ref());
    for name in labs.chain(widgets) {
        let misnamed = rules::model_name::check_model_name(name, models);
        findings.extend(misnamed.or_else(|| rules::unknown_model::check_model(name, models)));
    }
}

/// Checks what depends on several lessons: ids that are used twice in a course.
pub fn check_course(lessons: &[&Lesson]) -> Vec<Finding> {
    rules::across(lessons)
}
