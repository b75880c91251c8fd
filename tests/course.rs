//! Our own course (`specs/lessons`): all its claims are true, false claims that are inserted are found, and another layout or
//! other words around a number do not make a claim false.

#![allow(clippy::unwrap_used, clippy::panic)]

mod lies;
mod places;
mod wording;

use crate::support::{for_each, workspace};
use labspec::bind::scene::Models;
use labspec::check::{self, CheckLevel, Checked};
use labspec::finding::Severity;
use labspec::lint::{ModelFolder, load_lesson};
use labspec::source::SourceFile;
use labspec::spec::QuestionKind;
use labspec::verify::{QuoteState, Verdict};
use labspec_proposals::trace::{Origin, trace};
use std::time::Instant;

/// A lesson of the course.
pub(super) struct CourseLesson {
    pub(super) name: String,
    pub(super) text: String,
}

/// All lessons, by name.
pub(super) fn course() -> Vec<CourseLesson> {
    let folder = workspace().join("specs/lessons");
    let mut names: Vec<String> = std::fs::read_dir(folder.as_path())
        .unwrap()
        .filter_map(|e| e.unwrap().file_name().into_string().ok())
        .filter(|n| n.ends_with(".md"))
        .collect();
    names.sort();
    assert_eq!(names.len(), 10, "{names:?}");
    let read =
        |name: String| CourseLesson { text: std::fs::read_to_string(folder.join(&name)).unwrap(), name };
    names.into_iter().map(read).collect()
}

pub(super) fn models() -> Models {
    Models::new(ModelFolder::open(&workspace().join("specs/models")).unwrap())
}

/// The check of a text.
pub(super) fn checked(name: &str, text: &str, models: &Models, depth: CheckLevel) -> Checked {
    check::check_lesson(load_lesson(SourceFile::new(name, text), models.folder()), models, depth)
}

/// Warnings and errors, and findings that the settings of the course make an error (`specs/labspec.toml`), one line each.
pub(super) fn list_findings(checked: &Checked) -> Vec<String> {
    let counted = checked.findings.iter().filter(|f| counts(f));
    counted
        .map(|f| {
            let at = checked.lesson.file.position(f.span.start);
            format!("{}:{}: {}: {}", at.line, at.column, f.code, f.message)
        })
        .collect()
}

pub(super) fn counts(f: &labspec::finding::Finding) -> bool {
    f.severity != Severity::Note || DENIED.contains(&f.code)
}

/// The rules that `specs/labspec.toml` denies.
const DENIED: [&str; 1] = ["numbers-unclaimed"];

#[test]
fn the_settings_of_the_course_are_those_that_are_tested() {
    let settings = std::fs::read_to_string(workspace().join("specs/labspec.toml")).unwrap();
    assert!(DENIED.iter().all(|code| settings.contains(&format!("\"{code}\""))), "{settings}");
}

/// Every answer is verified or computed, every number with a unit is claimed and right, and nothing is reported.
#[test]
fn every_claim_of_the_course_is_true() {
    let models = models();
    let start = Instant::now();
    let mut questions = 0;
    let mut quotes = 0;
    for lesson in course() {
        let checked = checked(&lesson.name, &lesson.text, &models, CheckLevel::FULL);
        assert_eq!(list_findings(&checked), [] as [&str; 0], "{}", lesson.name);
        let mut asked = 0;
        for claim in &checked.claims {
            for quote in &claim.judgement.quotes {
                assert_eq!(quote.state, QuoteState::Right, "{}, {}: {}", lesson.name, claim.name, quote.text);
                quotes += 1;
            }
            let Some(answer) = &claim.judgement.answer else { continue };
            let sure = matches!(answer.verdict, Verdict::Verified | Verdict::Computed);
            assert!(sure, "{}, {}: {} {}", lesson.name, claim.name, answer.verdict.as_str(), answer.reason);
            asked += 1;
        }
        // An open question has no answer that can be checked.
        let all = checked.lesson.quizzes.iter().flat_map(|q| q.numbered());
        let closed = all.filter(|(_, q)| !matches!(q.kind, QuestionKind::Open { .. }));
        assert_eq!(asked, closed.count(), "{}", lesson.name);
        questions += asked;
    }
    eprintln!(
        "{questions} answers and {quotes} numbers in {:.2} s, on one processor",
        start.elapsed().as_secs_f64()
    );
    assert!(questions >= 40 && quotes > 300, "{questions} {quotes}");
}

/// Every visible number with a unit is claimed, and the answers of numeric questions have a value.
#[test]
fn no_number_is_unclaimed() {
    let models = models();
    let mut count = 0;
    for course_lesson in course() {
        let lesson = load_lesson(
            SourceFile::new(course_lesson.name.as_str(), course_lesson.text.as_str()),
            models.folder(),
        );
        for n in trace(&lesson, &models, &mut |_| ()).numbers {
            count += 1;
            let claimed = matches!(n.origin, Origin::Claimed) || n.stated.answer;
            assert!(claimed, "{}: {} is not claimed", course_lesson.name, n.stated.quote);
        }
    }
    assert!(count > 300, "{count}");
}
