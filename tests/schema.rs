//! The published JSON Schemas accept what the reader accepts without an error, and refuse what is wrong.

// A test that cannot read its own inputs must fail.
#![allow(clippy::unwrap_used, clippy::panic)]

use crate::needs::needs;
use crate::support::schema::problems;
use crate::support::workspace;
use labspec::lint::ModelFolder;
use labspec::lint::load_lesson;
use labspec::markdown::{self, BlockKind, LabKind};
use labspec::source::SourceFile;
use labspec::spec::format::{OBJECTS, Root, schema};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

fn accepts(root: Root, value: &Value) -> bool {
    problems(&BTreeMap::from([("this".to_string(), schema(root))]), "this", value).is_empty()
}

fn parse(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|e| panic!("{e}: {text}"))
}

fn files(folder: &Path) -> Vec<PathBuf> {
    let mut all: Vec<PathBuf> = std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().path()).collect();
    all.retain(|p| p.extension().is_some_and(|e| e == "md" || e == "json"));
    all.sort();
    all
}

/// The labs and quizzes of a file that are valid JSON, each with its kind, and whether the reader finds an error in it.
fn objects(path: &Path) -> Vec<(Root, Value, bool)> {
    let text = std::fs::read_to_string(path).unwrap();
    let name = path.file_name().unwrap().to_str().unwrap();
    let lesson = load_lesson(SourceFile::new(name, text.clone()), &ModelFolder::unknown());
    if name.ends_with(".json") {
        let Ok(value) = serde_json::from_str::<Value>(&text) else { return Vec::new() };
        return vec![(Root::Lesson, value, lesson.has_errors())];
    }
    let mut all = Vec::new();
    for block in markdown::scan(&lesson.file).blocks {
        let root = match &block.kind {
            BlockKind::Lab(LabKind::Simulation) => Root::Lab,
            BlockKind::Lab(LabKind::Comparison) => Root::Integrators,
            BlockKind::Quiz => Root::Quiz,
            _ => continue,
        };
        let Ok(value) = serde_json::from_str::<Value>(&block.body.value) else { continue };
        let errors = lesson.findings.iter().any(|f| {
            let inside = block.span.start <= f.span.start && f.span.end <= block.span.end;
            inside && f.severity == labspec::finding::Severity::Error
        });
        all.push((root, value, errors));
    }
    all
}

/// All of them are valid according to their schema; returns their number.
fn all_pass(folder: &Path) -> usize {
    let mut passed = 0;
    for path in files(folder) {
        for (root, value, _) in objects(&path).into_iter().filter(|(.., errors)| !errors) {
            assert!(accepts(root, &value), "{}: {value:#}", path.display());
            assert!(accepts(Root::Lesson, &value), "{}: {value:#}", path.display());
            assert!(accepts(Root::Lesson, &json!([value])), "{}", path.display());
            passed += 1;
        }
    }
    passed
}

#[test]
fn our_lessons_pass() {
    assert!(all_pass(&workspace().join("specs/lessons")) >= 8);
    assert!(all_pass(&workspace().join("tests/lessons")) >= 5);
}

#[test]
fn real_labs_and_quizzes_pass() {
    if needs("../shared/corpus") {
        let corpus = workspace().join("../shared/corpus");
        assert_eq!(all_pass(&corpus.join("labs")), files(&corpus.join("labs")).len());
        assert_eq!(all_pass(&corpus.join("quizzes")), files(&corpus.join("quizzes")).len());
    }
}

#[test]
fn every_smallest_object_and_every_example_passes() {
    let all = BTreeMap::from([("this".to_string(), schema(Root::Lesson))]);
    for object in OBJECTS {
        let place = format!("this#/$defs/{}", object.name);
        let rule = &all["this"]["$defs"][object.name];
        assert_eq!(problems(&all, &place, &parse(object.minimal)), [""; 0], "{}", object.name);
        for key in object.keys {
            let place = format!("{place}/properties/{}", key.name);
            let rule = &rule["properties"][key.name];
            assert_eq!(problems(&all, &place, &parse(key.example)), [""; 0], "{}.{}", object.name, key.name);
            assert_eq!(rule["examples"][0], parse(key.example));
            assert!(rule["description"].as_str().is_some_and(|d| d.starts_with(key.doc)));
        }
    }
}

/// Labs and quizzes with one error each, and the same without it.
const WRONG: [(&str, &str); 29] = [
    (r#"{"model": "fall", "integrators": ["rk4"]}"#, r#"{"model": "fall", "integrators": ["RK4"]}"#),
    (r#"{"model": "fall", "integrators": "RK4"}"#, r#"{"model": "fall", "integrators": ["RK4", "Euler"]}"#),
    (
        r#"{"model": "fall", "integrators": ["RK4"], "timestep": 0}"#,
        r#"{"model": "fall", "integrators": ["RK4"], "timestep": 0.1}"#,
    ),
    (r#"{"modle": "fall"}"#, r#"{"model": "fall"}"#),
    (r#"{"title": "A fall"}"#, r#"{"title": "A fall", "model": "fall"}"#),
    (r#"{"model": "fall", "xml": "<mujoco/>"}"#, r#"{"xml": "<mujoco/>"}"#),
    (r#"{"model": "fall", "stopat": 1}"#, r#"{"model": "fall", "stopAt": 1}"#),
    (r#"{"model": "fall", "stopAt": "1"}"#, r#"{"model": "fall", "stopAt": 1}"#),
    (r#"{"model": "fall", "stopAt": 0}"#, r#"{"model": "fall", "stopAt": 0.1}"#),
    (r#"{"model": "fall", "key": -1}"#, r#"{"model": "fall", "key": 0}"#),
    (r#"{"model": "fall", "key": 0.5}"#, r#"{"model": "fall", "key": 1}"#),
    (r#"{"model": "fall", "autoplay": "true"}"#, r#"{"model": "fall", "autoplay": true}"#),
    (r#"{"model": "fall", "toggles": ["contact"]}"#, r#"{"model": "fall", "toggles": ["contacts"]}"#),
    (
        r#"{"model": "fall", "overlays": {"contact": true}}"#,
        r#"{"model": "fall", "overlays": {"contacts": true}}"#,
    ),
    (r#"{"model": "fall", "speeds": [1, 0]}"#, r#"{"model": "fall", "speeds": [1, 0.5]}"#),
    (
        r#"{"model": "fall", "camera": {"target": [0, 0]}}"#,
        r#"{"model": "fall", "camera": {"target": [0, 0, 1]}}"#,
    ),
    (r#"{"model": "fall", "expect": "breaking"}"#, r#"{"model": "fall", "expect": "breaks"}"#),
    (
        r#"{"model": "fall", "controls": [{"label": "g", "min": 0, "max": 1, "value": 0}]}"#,
        r#"{"model": "fall", "controls": [{"label": "g", "min": 0, "max": 1, "value": 0, "param": "g"}]}"#,
    ),
    (
        r#"{"model": "fall", "controls": [{"type": "knob", "label": "g", "min": 0, "max": 1, "value": 0, "param": "g"}]}"#,
        r#"{"model": "fall", "controls": [{"type": "slider", "label": "g", "min": 0, "max": 1, "value": 0, "param": "g"}]}"#,
    ),
    (
        r#"{"model": "fall", "controls": [{"type": "button", "label": "g", "run": "ctx.g = 1", "min": 0}]}"#,
        r#"{"model": "fall", "controls": [{"type": "button", "label": "g", "run": "ctx.g = 1"}]}"#,
    ),
    (
        r#"{"model": "fall", "controls": [{"type": "select", "label": "g", "options": ["a", "b"], "value": 0, "param": "g"}]}"#,
        r#"{"model": "fall", "controls": [{"type": "select", "label": "g", "options": [["a", 0], ["b", 1]], "value": 0, "param": "g"}]}"#,
    ),
    (
        r#"{"model": "fall", "plots": [{"traces": []}]}"#,
        r#"{"model": "fall", "plots": [{"traces": [{"label": "t", "expr": "data.time"}]}]}"#,
    ),
    (
        r#"{"model": "fall", "readouts": [{"label": "t", "expr": "data.time", "digits": 18}]}"#,
        r#"{"model": "fall", "readouts": [{"label": "t", "expr": "data.time", "digits": 17}]}"#,
    ),
    (
        r#"{"model": "fall", "verify": {"runs": {"a": {"until": 1, "steps": 2}}, "says": [["1", "data.time"]]}}"#,
        r#"{"model": "fall", "verify": {"runs": {"a": {"until": 1}}, "says": [["1", "final(data.time)"]]}}"#,
    ),
    (
        r#"{"model": "fall", "verify": {"exact": {"z": {"tol": 1}}}}"#,
        r#"{"model": "fall", "verify": {"exact": {"z": "1"}}}"#,
    ),
    (r#"{"id": "a", "questions": []}"#, r#"{"id": "a", "questions": [{"kind": "open", "q": "Why?"}]}"#),
    (
        r#"{"id": "a", "questions": [{"q": "?", "options": ["yes"], "answer": 0}]}"#,
        r#"{"id": "a", "questions": [{"q": "?", "options": ["yes", "no"], "answer": 0}]}"#,
    ),
    (
        r#"{"id": "a", "questions": [{"kind": "numeric", "q": "?", "options": ["1", "2"], "answer": 0}]}"#,
        r#"{"id": "a", "questions": [{"kind": "numeric", "q": "?", "answer": 1}]}"#,
    ),
    (
        r#"{"id": "a", "questions": [{"kind": "essay", "q": "?"}]}"#,
        r#"{"id": "a", "questions": [{"kind": "code", "q": "?"}]}"#,
    ),
];

#[test]
fn wrong_ones_fail_and_right_ones_do_not() {
    for (bad, good) in WRONG {
        let root = match bad {
            _ if bad.contains("questions") => Root::Quiz,
            _ if bad.contains("integrators") => Root::Integrators,
            _ => Root::Lab,
        };
        for (text, right) in [(bad, false), (good, true)] {
            assert_eq!(accepts(root, &parse(text)), right, "{text}");
            assert_eq!(accepts(Root::Lesson, &parse(text)), right, "{text}");
            let read = load_lesson(SourceFile::new("a.json", text), &ModelFolder::unknown());
            assert_eq!(read.has_errors(), !right, "{text}: {:#?}", read.findings);
        }
    }
}

/// The pointers of all values in JSON.
fn places(value: &Value, at: &str, all: &mut Vec<String>) {
    all.push(at.to_string());
    match value {
        Value::Object(entries) => {
            // In a JSON pointer, `/` in a key is encoded with two characters.
            let pointed = |k: &str| k.replace('~', "~0").replace('/', "~1");
            entries.iter().for_each(|(k, v)| places(v, &format!("{at}/{}", pointed(k)), all));
        }
        Value::Array(items) => {
            items.iter().enumerate().for_each(|(i, v)| places(v, &format!("{at}/{i}"), all))
        }
        _ => {}
    }
}

/// Errors in the format: a misspelt key, a missing key, a value of another type.
fn damaged(value: &Value, at: &str) -> Vec<Value> {
    let (parent, key) = at.rsplit_once('/').unwrap();
    let key = &key.replace("~1", "/").replace("~0", "~");
    let with = |change: &dyn Fn(&mut serde_json::Map<String, Value>)| {
        let mut new = value.clone();
        let Some(Value::Object(entries)) = new.pointer_mut(parent) else { return None };
        change(entries);
        Some(new)
    };
    let mut all: Vec<Value> = Vec::new();
    all.extend(with(&|o| {
        let old = o.remove(key).unwrap();
        o.insert(format!("{key}x"), old);
    }));
    all.extend(with(&|o| drop(o.remove(key))));
    for other in [json!(null), json!({"x": 1}), json!([[]]), json!("?"), json!(-7.5), json!(true)] {
        let mut new = value.clone();
        *new.pointer_mut(at).unwrap() = other;
        all.push(new);
    }
    all
}

/// Format errors in real labs and quizzes: the schema refuses what the reader reports, and accepts what the reader accepts.
#[test]
fn mistakes_of_the_format_are_refused() {
    const OF_FORMAT: [&str; 3] = ["unknown-key", "wrong-type", "missing-key"];
    let here = workspace();
    let mut folders = vec![here.join("specs/lessons"), here.join("tests/lessons")];
    if needs("../shared/corpus") {
        folders.extend(["labs", "quizzes"].map(|f| here.join("../shared/corpus").join(f)));
    }
    let schemas: BTreeMap<String, Value> = [Root::Lab, Root::Integrators, Root::Quiz, Root::Lesson]
        .map(|root| (format!("{root:?}"), schema(root)))
        .into();
    // Without its list, a comparison in a file of JSON is an ordinary lab.
    let file = |root: Root, mutant: &Value| match root {
        Root::Integrators => SourceFile::new("a.md", format!("```lab integrators\n{mutant}\n```\n")),
        _ => SourceFile::new("a.json", mutant.to_string()),
    };
    let (mut turn, mut refused, mut accepted_count) = (0, 0, 0);
    let mut wrong = Vec::new();
    let valid = folders.iter().flat_map(|f| files(f)).flat_map(|path| objects(&path));
    for (root, value, _) in valid.filter(|(.., errors)| !errors) {
        let mut all = Vec::new();
        places(&value, "", &mut all);
        for at in all.iter().filter(|at| !at.is_empty()) {
            // Every seventh mutant, so that the kinds and places alternate.
            for mutant in damaged(&value, at) {
                turn += 1;
                if turn % 7 != 0 || mutant == value {
                    continue;
                }
                let read = load_lesson(file(root, &mutant), &ModelFolder::unknown());
                let errors = || read.findings.iter().filter(|f| f.is_error());
                let accepted = problems(&schemas, &format!("{root:?}"), &mutant).is_empty();
                if errors().any(|f| OF_FORMAT.contains(&f.code)) {
                    refused += 1;
                    if accepted {
                        wrong.push(format!(
                            "taken at {at}: {:?}: {mutant:.300}",
                            errors().map(|f| &f.message).collect::<Vec<_>>()
                        ));
                    }
                } else if errors().next().is_none() {
                    accepted_count += 1;
                    if !accepted {
                        wrong.push(format!("refused at {at}: {mutant:.300}"));
                    }
                }
            }
        }
    }
    println!("{refused} refused, {accepted_count} taken");
    assert!(
        wrong.is_empty(),
        "{} wrong of {}:\n{}",
        wrong.len(),
        refused + accepted_count,
        wrong[..wrong.len().min(12)].join("\n")
    );
    assert!(refused > 500 && accepted_count > 50, "{refused} refused, {accepted_count} taken");
}
