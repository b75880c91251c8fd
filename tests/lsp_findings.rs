//! The editor reports what `labspec check` reports about the same text: while typing that of `check --no-run`, after the runs
//! that of `check`.

#![allow(clippy::unwrap_used)]

use crate::lsp_editor::Editor;
use crate::program::{CLEAN, run_in, wrong};
use crate::support::{sorted_files, workspace};
use serde_json::{Value, json};
use std::path::Path;

/// The code, the line and the first words of a finding.
type Row = (String, u64, String);

/// The findings of the program about a file.
fn of_program(folder: &Path, file: &str, more: &[&str]) -> Vec<Row> {
    let done = run_in(folder, &[&["check", file, "--format", "json"], more].concat());
    let report: Value = serde_json::from_str(&done.stdout).unwrap();
    let about = |f: &&Value| f["file"].as_str().unwrap().ends_with(file);
    let row = |f: &Value| {
        let text = |key: &str| f[key].as_str().unwrap_or_default().to_string();
        (text("code"), f["line"].as_u64().unwrap(), text("message"))
    };
    sorted(report["findings"].as_array().unwrap().iter().filter(about).map(row).collect())
}

fn of_editor(found: &Value) -> Vec<Row> {
    let row = |f: &Value| {
        let message = f["message"].as_str().unwrap().lines().next().unwrap_or("").to_string();
        (f["code"].as_str().unwrap().to_string(), f["range"]["start"]["line"].as_u64().unwrap() + 1, message)
    };
    sorted(found.as_array().unwrap().iter().map(row).collect())
}

fn sorted(mut rows: Vec<Row>) -> Vec<Row> {
    rows.sort();
    rows
}

/// Compares the findings about a lesson in a folder with its models.
fn compare(folder: &Path, editor: &mut Editor, name: &str, text: &str) -> usize {
    std::fs::write(folder.join(name), text).unwrap();
    let typed = of_editor(&editor.did_open(name, text));
    assert_eq!(typed, of_program(folder, name, &["--no-run"]), "{name}, while typing");
    editor.notify("textDocument/didSave", json!({"textDocument": {"uri": editor.uri(name)}}));
    let saved = of_editor(&editor.found(name, 1));
    assert_eq!(saved, of_program(folder, name, &[]), "{name}, after the runs");
    editor.notify("textDocument/didClose", json!({"textDocument": {"uri": editor.uri(name)}}));
    std::fs::remove_file(folder.join(name)).unwrap();
    saved.len()
}

/// A folder with the models of a root.
fn with_models(models: &Path) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("models")).unwrap();
    for path in sorted_files(models).into_iter().filter(|path| path.extension().is_some_and(|e| e == "xml")) {
        std::fs::copy(&path, folder.path().join("models").join(path.file_name().unwrap())).unwrap();
    }
    folder
}

/// All our lessons, as they are and with mistakes.
#[test]
fn the_editor_reports_what_the_program_reports() {
    let specs = workspace().join("specs");
    let folder = with_models(&specs.join("models"));
    let mut editor = Editor::open_without_folder(folder.path());
    let mut reported = 0;
    for path in
        sorted_files(&specs.join("lessons")).into_iter().filter(|p| p.extension().is_some_and(|e| e == "md"))
    {
        let (name, text) =
            (path.file_name().unwrap().to_str().unwrap(), std::fs::read_to_string(&path).unwrap());
        reported += compare(folder.path(), &mut editor, name, &text);
    }
    let text = std::fs::read_to_string(specs.join("lessons/02-bounce-and-swing.md")).unwrap();
    for (i, (old, new)) in [
        ("\"answer\": ", "\"answer\": 1"),
        ("\"until\": ", "\"until\": 1"),
        ("data.q", "data.p"),
        ("```\n", "\n"),
    ]
    .into_iter()
    .enumerate()
    {
        reported +=
            compare(folder.path(), &mut editor, &format!("wrong-{i}.md"), &text.replacen(old, new, 2));
    }
    assert!(reported >= 5, "{reported}");
    assert_eq!(editor.end(), 0);
}

/// Damaged lessons, and lessons with wrong claims.
#[test]
fn the_editor_reports_the_same_about_damaged_lessons() {
    let folder = crate::program::folder();
    let mut editor = Editor::open_without_folder(folder.path());
    let mut reported = 0;
    for path in sorted_files(&workspace().join("tests/lessons")) {
        let name = path.file_name().unwrap().to_str().unwrap();
        // A file of another program is reported only where it is named.
        if name.ends_with(".md") {
            let text = std::fs::read_to_string(&path).unwrap();
            reported += compare(folder.path(), &mut editor, name, &text);
        }
    }
    // Answers that are always the first option, in one lesson.
    let question = |i: usize| {
        format!(
            "{{\"q\": \"Is {i} it?\", \"options\": [\"yes {i}\", \"no {i}\", \"both {i}\", \"none {i}\"], \"answer\": 0}}"
        )
    };
    let questions: Vec<String> = (0..30).map(question).collect();
    let uneven =
        format!("# Q\n\n```quiz\n{{\"id\": \"q\", \"questions\": [{}]}}\n```\n", questions.join(",\n"));
    for (name, text) in [("right.md", CLEAN.to_string()), ("false.md", wrong()), ("uneven.md", uneven)] {
        reported += compare(folder.path(), &mut editor, name, &text);
    }
    assert!(reported > 30, "{reported}");
    assert_eq!(editor.end(), 0);
}

/// Lessons that are saved one right after the other are all run.
#[test]
fn all_saved_lessons_are_run() {
    let folder = crate::program::folder();
    let mut editor = Editor::open_without_folder(folder.path());
    let names = ["one.md", "two.md", "three.md"];
    for name in names {
        let text = wrong().replace("\"id\": \"", &format!("\"id\": \"{name}-"));
        std::fs::write(folder.path().join(name), &text).unwrap();
        editor.did_open(name, &text);
    }
    for name in names {
        editor.notify("textDocument/didSave", json!({"textDocument": {"uri": editor.uri(name)}}));
    }
    for name in names {
        assert_eq!(of_editor(&editor.found(name, 1)), of_program(folder.path(), name, &[]), "{name}");
    }
    assert_eq!(editor.end(), 0);
}

/// JSON of another program has no findings, also after it is saved.
#[test]
fn json_of_another_program_has_no_findings() {
    let folder = crate::program::folder();
    let mut editor = Editor::open_without_folder(folder.path());
    let text = "{\"name\": \"not ours\", \"list\": [1, 2]}";
    assert_eq!(editor.did_open("package.json", text), json!([]));
    editor.notify("textDocument/didSave", json!({"textDocument": {"uri": editor.uri("package.json")}}));
    assert_eq!(editor.found("package.json", 1), json!([]));
    assert_eq!(editor.end(), 0);
}

/// Findings about several lessons together are those of a check of the folder, whichever lesson is open or changes.
#[test]
fn findings_about_a_course_are_those_of_a_check_of_the_folder() {
    let folder = tempfile::tempdir().unwrap();
    let quiz = |id: &str| {
        format!(
            "# Q\n\n```quiz\n{{\"id\": \"{id}\", \"questions\": [{{\"kind\": \"open\", \"q\": \"Why?\"}}]}}\n```\n"
        )
    };
    let write = |name: &str, id: &str| std::fs::write(folder.path().join(name), quiz(id)).unwrap();
    let of_course = || {
        let done = run_in(folder.path(), &["check", ".", "--no-run", "--format", "json"]);
        let report: Value = serde_json::from_str(&done.stdout).unwrap();
        report["findings"].as_array().unwrap().iter().filter(|f| f["code"] == "duplicate-id").count()
    };
    let duplicates = |found: &Value| {
        let place = |f: &Value| f["range"]["start"]["line"].as_u64().unwrap();
        let all = found.as_array().unwrap().iter().filter(|f| f["code"] == "duplicate-id");
        all.map(place).collect::<Vec<_>>()
    };
    write("1.md", "a");
    write("2.md", "a");
    assert_eq!(of_course(), 1);
    let mut editor = Editor::open(folder.path());
    assert_eq!(duplicates(&editor.did_open("1.md", &quiz("a"))), [0u64; 0], "the first is right");
    assert_eq!(duplicates(&editor.did_open("2.md", &quiz("a"))), [3]);
    // The other lesson gets another id in the editor.
    let at = quiz("a").find("\"a\"").unwrap();
    editor.change("1.md", 2, &quiz("a"), at..at + 3, "\"b\"");
    assert_eq!(duplicates(&editor.found("2.md", 1)), [0u64; 0]);
    // A file that is not open gets the id of this one, and another program changes it.
    write("0.md", "b");
    let changes = json!([{"uri": editor.uri("0.md"), "type": 1}]);
    editor.notify("workspace/didChangeWatchedFiles", json!({"changes": changes}));
    editor.found("1.md", 2);
    assert_eq!(duplicates(&editor.found("1.md", 2)), [3]);
    write("1.md", "b");
    assert_eq!(of_course(), 1);
    assert_eq!(editor.end(), 0);
}
