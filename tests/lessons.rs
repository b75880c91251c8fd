//! Reports about damaged or wrong lessons: every file of `tests/lessons` has a snapshot, and so do the real lessons next to the
//! repository, if they exist.

// A test that cannot read its own inputs must fail.
#![allow(clippy::unwrap_used)]

use crate::needs::needs;
use labspec::finding::Finding;
use labspec::lint::ModelFolder;
use labspec::lint::load_lesson;
use labspec::source::SourceFile;
use labspec::spec::Lesson;
use labspec::{lint, report};
use std::path::{Path, PathBuf};

/// The workspace, two folders above the crate of this test.
fn workspace() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// A folder next to the repository; reports if it does not exist.
fn beside(path: &str) -> Option<PathBuf> {
    needs(&format!("../shared/{path}")).then(|| workspace().join("../shared").join(path))
}

fn load(path: &Path, display_path: &str, models: &ModelFolder) -> Lesson {
    let text = std::fs::read_to_string(path).unwrap();
    load_lesson(SourceFile::new(display_path, text), models)
}

fn sorted(folder: &Path) -> Vec<PathBuf> {
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().path()).collect();
    files.sort();
    files
}

#[test]
fn findings_of_wrong_lessons_equal_their_snapshots() {
    let models = ModelFolder::with_names(["ball", "incline", "pendulum"]);
    for path in sorted(&workspace().join("tests/lessons")) {
        let Some(name) =
            path.file_name().and_then(|n| n.to_str()).filter(|n| n.ends_with(".md") || n.ends_with(".json"))
        else {
            continue;
        };
        let lesson = load(&path, name, &models);
        assert!(!lesson.findings.is_empty(), "{name} is meant to be wrong");
        let output = report::human(&lesson.findings, &[&lesson.file], false);
        let output = format!("{output}{}", report::Summary::count(&lesson.findings));
        insta::with_settings!({prepend_module_to_snapshot => false, omit_expression => true, snapshot_path => "lessons/snapshots"}, {
            insta::assert_snapshot!(name.replace('.', "-"), output);
        });
    }
}

#[test]
fn findings_are_json_for_programs() {
    let text = "# A\n\n```lab simlab\n{\"model\": \"bal\", \"stopat\": 2}\n```\n";
    let lesson = load_lesson(SourceFile::new("a.md", text), &ModelFolder::with_names(["ball"]));
    let json = report::json(&lesson.findings, &[&lesson.file]);
    insta::with_settings!({prepend_module_to_snapshot => false, omit_expression => true, snapshot_path => "lessons/snapshots"}, {
        insta::assert_snapshot!("report-json", serde_json::to_string_pretty(&json).unwrap());
    });
}

/// The code, line and column of every finding.
fn places(lesson: &Lesson) -> Vec<(&'static str, usize, usize)> {
    lesson
        .findings
        .iter()
        .map(|f: &Finding| {
            let at = lesson.file.position(f.span.start);
            (f.code, at.line, at.column)
        })
        .collect()
}

#[test]
fn the_intact_lesson_has_no_error() {
    let (Some(path), Some(models)) = (beside("lesson-0.1/lesson-0.1.md"), beside("corpus/models")) else {
        return;
    };
    let models = ModelFolder::open(&models).unwrap();
    let lesson = load(&path, "lesson-0.1.md", &models);
    assert!(!lesson.has_errors(), "{}", report::human(&lesson.findings, &[&lesson.file], false));
    // `<option>` in the text and in an explanation: a browser displays neither.
    let expected = [
        ("unescaped-element", 7, 281),
        ("prediction-unchecked", 18, 1),
        ("unescaped-element", 21, 285),
        ("long-answer", 25, 44),
        ("long-answer", 110, 21),
    ];
    assert_eq!(places(&lesson), expected);
    assert_eq!((lesson.labs.len(), lesson.quizzes.len()), (2, 2));
    let addresses: Vec<String> = lesson.addressed().iter().map(|(a, _)| a.to_string()).collect();
    assert_eq!(addresses, ["#1", "#2", "#0.1-predict.1", "#0.1-predict.2"]);
}

#[test]
fn the_damaged_lesson_shows_every_damage() {
    let (Some(path), Some(models)) = (beside("lesson-0.1/lesson-0.1.damaged.md"), beside("corpus/models"))
    else {
        return;
    };
    let models = ModelFolder::open(&models).unwrap();
    let lesson = load(&path, "lesson-0.1.damaged.md", &models);
    // Despite the damage, all labs and quizzes are found and checked.
    let addresses: Vec<String> = lesson.addressed().iter().map(|(a, _)| a.to_string()).collect();
    assert_eq!(addresses, ["#1", "#2", "#0.1-predict.1", "#0.1-predict.2"]);
    assert_eq!(lesson.quizzes.len(), 2);
    assert_eq!(lesson.labs[0].lab.as_ref().unwrap().controls.len(), 3);
    let expected = [
        ("unescaped-element", 5, 281),    // the<option>element
        ("fence-unclosed", 7, 1),         // the first lab
        ("fence-line", 7, 15),            // its JSON on the line of the fence
        ("typographic-quote", 7, 16),     // and quoted “so”
        ("fence-unclosed", 9, 1),         // the first quiz
        ("prediction-unchecked", 11, 1),  // the first quiz has no `verify`
        ("unescaped-element", 14, 285),   // <code><option></code>
        ("long-answer", 18, 44),          // 103 characters beside 34
        ("fence-unclosed", 33, 1),        // the first listing
        ("fence-line", 33, 43),           // its docstring on the line of the fence
        ("typographic-quote", 33, 43),    // quotes on four of its lines
        ("listing-line-breaks", 39, 122), // def …: a = … b = …
        ("listing-underscores", 40, 1),   // if name == “main”
        ("fence-unclosed", 50, 1),        // the second lab
        ("fence-unclosed", 63, 1),        // the second listing
        ("fence-line", 63, 43),
        ("typographic-quote", 63, 43),
        ("listing-line-breaks", 70, 88),
        ("listing-indentation", 72, 1), // for …: without an indented line
        ("listing-indentation", 74, 1),
        ("listing-underscores", 76, 1),
        ("fence-unclosed", 78, 1), // the output
        ("fence-missing", 101, 1), // the last quiz has no fence at all
        ("long-answer", 110, 21),
    ];
    assert_eq!(places(&lesson), expected, "{}", report::human(&lesson.findings, &[&lesson.file], false));
}

#[test]
fn real_labs_and_quizzes_have_no_false_error() {
    let (Some(corpus), Some(models)) = (beside("corpus"), beside("corpus/models")) else { return };
    let models = ModelFolder::open(&models).unwrap();
    let mut lessons = Vec::new();
    for folder in ["labs", "quizzes"] {
        for path in sorted(&corpus.join(folder)) {
            let name = path.file_name().and_then(|n| n.to_str()).unwrap_or("").to_string();
            let lesson = load(&path, &name, &models);
            let reported: Vec<_> = lesson.findings.iter().map(|f| (name.as_str(), f.code)).collect();
            let expected: &[_] = if name == "4.2_01.json" { &[("4.2_01.json", "long-answer")] } else { &[] };
            assert_eq!(reported, expected, "{}", report::human(&lesson.findings, &[&lesson.file], false));
            assert_eq!(lesson.labs.len() + lesson.quizzes.len(), 1, "{name}");
            lessons.push(lesson);
        }
    }
    assert_eq!(lint::check_course(&lessons.iter().collect::<Vec<_>>()), []);
}
