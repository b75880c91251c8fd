//! The published JSON Schemas: what the reader takes without an error they take too, and what is wrong they refuse.
//!
//! A validator for the keywords that they use stands here: the crates that know all of them bring some fifty others.

// A test that cannot read its own inputs has to fail.
#![allow(clippy::unwrap_used, clippy::panic)]

use crate::needs::needs;
use crate::support::workspace;
use labspec::lint::ModelFolder;
use labspec::markdown::{self, BlockKind};
use labspec::source::SourceFile;
use labspec::spec::format::{OBJECTS, Root, schema};
use labspec::spec::load_lesson;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// Whether a value is what a schema says. A keyword that is not known here fails the test.
fn valid(value: &Value, rule: &Value, root: &Value) -> bool {
    let Some(rule) = rule.as_object() else { return rule.as_bool().unwrap() };
    let holds = |rule: &Value| valid(value, rule, root);
    let all = |rules: &Value| rules.as_array().unwrap().iter().filter(|r| holds(r)).count();
    rule.iter().all(|(keyword, rule_of)| match keyword.as_str() {
        "$schema" | "$defs" | "title" | "description" | "default" | "examples" | "then" | "else" => true,
        "$ref" => holds(root.pointer(&rule_of.as_str().unwrap()[1..]).unwrap()),
        "type" => match rule_of {
            Value::Array(types) => types.iter().any(|t| is(value, t)),
            one => is(value, one),
        },
        "const" => value == rule_of,
        "enum" => rule_of.as_array().unwrap().contains(value),
        "allOf" => all(rule_of) == rule_of.as_array().unwrap().len(),
        "anyOf" => all(rule_of) > 0,
        "oneOf" => all(rule_of) == 1,
        "not" => !holds(rule_of),
        "if" => rule.get(if holds(rule_of) { "then" } else { "else" }).is_none_or(holds),
        "required" => value
            .as_object()
            .is_none_or(|o| rule_of.as_array().unwrap().iter().all(|k| o.contains_key(k.as_str().unwrap()))),
        "properties" => value.as_object().is_none_or(|o| {
            rule_of.as_object().unwrap().iter().all(|(k, r)| o.get(k).is_none_or(|v| valid(v, r, root)))
        }),
        "additionalProperties" => value.as_object().is_none_or(|o| {
            let known = rule.get("properties").and_then(Value::as_object);
            let others = o.iter().filter(|(k, _)| known.is_none_or(|known| !known.contains_key(*k)));
            others.into_iter().all(|(_, v)| valid(v, rule_of, root))
        }),
        "items" => value.as_array().is_none_or(|a| a.iter().all(|v| valid(v, rule_of, root))),
        "prefixItems" => value
            .as_array()
            .is_none_or(|a| a.iter().zip(rule_of.as_array().unwrap()).all(|(v, r)| valid(v, r, root))),
        "minItems" => value.as_array().is_none_or(|a| a.len() as u64 >= rule_of.as_u64().unwrap()),
        "maxItems" => value.as_array().is_none_or(|a| a.len() as u64 <= rule_of.as_u64().unwrap()),
        "minimum" => value.as_f64().is_none_or(|x| x >= rule_of.as_f64().unwrap()),
        "maximum" => value.as_f64().is_none_or(|x| x <= rule_of.as_f64().unwrap()),
        "exclusiveMinimum" => value.as_f64().is_none_or(|x| x > rule_of.as_f64().unwrap()),
        other => panic!("the validator of this test does not know `{other}`"),
    })
}

fn is(value: &Value, name: &Value) -> bool {
    match name.as_str().unwrap() {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "boolean" => value.is_boolean(),
        "number" => value.is_number(),
        "integer" => value.as_f64().is_some_and(|x| x.fract() == 0.0),
        other => panic!("the validator of this test does not know the type `{other}`"),
    }
}

fn accepts(root: Root, value: &Value) -> bool {
    let schema = schema(root);
    valid(value, &schema, &schema)
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

/// The labs and quizzes of a file that are JSON, each with what it is, and whether the reader finds an error in it.
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
            BlockKind::Lab(widget) if widget == "simlab" => Root::Lab,
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

/// All of them pass their schema; gives their number.
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
    let root = schema(Root::Lesson);
    for object in OBJECTS {
        let rule = &root["$defs"][object.name];
        assert!(valid(&parse(object.minimal), rule, &root), "{}", object.name);
        for key in object.keys {
            let rule = &rule["properties"][key.name];
            assert!(valid(&parse(key.example), rule, &root), "{}.{}", object.name, key.name);
            assert_eq!(rule["examples"][0], parse(key.example));
            assert!(rule["description"].as_str().is_some_and(|d| d.starts_with(key.doc)));
        }
    }
}

/// Labs and quizzes with one mistake each, and the same without it.
const WRONG: [(&str, &str); 26] = [
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
        let root = if bad.contains("questions") { Root::Quiz } else { Root::Lab };
        for (text, right) in [(bad, false), (good, true)] {
            assert_eq!(accepts(root, &parse(text)), right, "{text}");
            assert_eq!(accepts(Root::Lesson, &parse(text)), right, "{text}");
            let read = load_lesson(SourceFile::new("a.json", text), &ModelFolder::unknown());
            assert_eq!(read.has_errors(), !right, "{text}: {:#?}", read.findings);
        }
    }
}
