//! The material into which mistakes are planted: labs and quizzes written by people, each as one JSON object.

use crate::support::workspace;
use labspec::bind::scene::Models;
use labspec::lint::ModelFolder;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// The maximum simulated time of a lab, s, because many mutants have to be run.
const LONGEST: f64 = 1.0;

/// The number of this repository's lessons that are used. More would make a long test longer, and `tests/course.rs` plants
/// false statements into all of them.
const OURS: usize = 2;
/// The start of a quiz that is not used here, only in `tests/course.rs`.
const LATER: &str = "{\"id\": \"02-balls\"";

/// The kind of a piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PieceKind {
    Lab,
    Quiz,
}

/// A lab or a quiz.
pub(crate) struct Piece {
    /// The file and the number of the piece.
    pub(crate) name: String,
    pub(crate) what: PieceKind,
    pub(crate) json: Value,
    /// The index of its folder of models.
    pub(crate) models: usize,
    /// The text of the lesson before and after it, for a quiz whose answers are verified with the labs of its lesson.
    pub(crate) around: Option<(String, String)>,
    /// The lesson with claims about a lab.
    pub(crate) home: Option<LabLocation>,
}

/// The location of a lab in a lesson with claims about it.
#[derive(Clone)]
pub(crate) struct LabLocation {
    before: String,
    behind: String,
    /// The object of the fence. `at` is the path of the lab in it.
    whole: Value,
    at: String,
}

impl Piece {
    /// The name and content of a file with the original or mutated piece.
    pub(crate) fn file(&self, json: &Value) -> (&'static str, String) {
        let text = serde_json::to_string_pretty(json).unwrap();
        match &self.around {
            Some((before, behind)) => ("lesson.md", format!("{before}{text}\n{behind}")),
            None => ("piece.json", text),
        }
    }

    /// The lesson with claims about a lab, in which `json` replaces the lab.
    pub(crate) fn lesson(&self, json: &Value) -> Option<String> {
        let LabLocation { before, behind, whole, at } = self.home.as_ref()?;
        let mut whole = whole.clone();
        let target = whole.pointer_mut(at)?;
        *target = carried(&self.json, json, target);
        Some(format!("{before}{}\n{behind}", serde_json::to_string_pretty(&whole).unwrap()))
    }
}

/// Applies the changes between two objects to a third one.
fn carried(from: &Value, to: &Value, third: &Value) -> Value {
    if from == to {
        return third.clone();
    }
    match (from, to, third) {
        (Value::Object(a), Value::Object(b), Value::Object(c)) => {
            let mut all = c.clone();
            for key in a.keys().filter(|k| !b.contains_key(*k)) {
                all.shift_remove(key);
            }
            for (key, new) in b {
                let made = match (a.get(key), c.get(key)) {
                    (Some(old), Some(third)) => carried(old, new, third),
                    (Some(old), None) if old == new => continue,
                    _ => new.clone(),
                };
                all.insert(key.clone(), made);
            }
            Value::Object(all)
        }
        (Value::Array(a), Value::Array(b), Value::Array(c)) if a.len() == b.len() && b.len() == c.len() => {
            a.iter().zip(b).zip(c).map(|((a, b), c)| carried(a, b, c)).collect()
        }
        _ => to.clone(),
    }
}

/// The opened folders of models.
pub(crate) fn models() -> Vec<Models> {
    let open = |folder: PathBuf| Models::new(ModelFolder::open(&folder).unwrap());
    vec![open(workspace().join("specs/models")), open(workspace().join("../shared/corpus/models"))]
}

/// All labs and quizzes, in a fixed order. Damaged lessons are left out.
pub(crate) fn pieces() -> Vec<Piece> {
    let shared = workspace().join("../shared");
    let mut all = Vec::new();
    for (folder, models) in [
        (workspace().join("specs/lessons"), 0),
        (shared.join("corpus/labs"), 1),
        (shared.join("corpus/quizzes"), 1),
        (shared.join("lesson-0.1"), 1),
    ] {
        for path in files(&folder) {
            let name = path.file_stem().unwrap().to_str().unwrap().to_string();
            let text = std::fs::read_to_string(&path).unwrap();
            if path.extension().is_some_and(|e| e == "json") {
                add(&mut all, &name, models, &text, None);
            } else {
                lesson(&mut all, &name, models, &text);
            }
        }
    }
    all
}

/// The lessons and JSON files of a folder, sorted by name; of this repository's lessons, only the first `OURS`.
fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().path());
    let is_one = |p: &PathBuf| {
        let name = p.file_name().unwrap().to_str().unwrap();
        name.ends_with(".json") || name.ends_with(".md") && !name.contains("damaged") && name != "NUMBERS.md"
    };
    let is_specs = folder.ends_with("specs/lessons");
    let mut all: Vec<PathBuf> = entries.filter(is_one).collect();
    all.sort();
    if is_specs {
        all.truncate(OURS);
    }
    all
}

/// Adds the objects in the fences of a lesson.
fn lesson(all: &mut Vec<Piece>, name: &str, models: usize, text: &str) {
    let mut at = 0;
    let mut number = 0;
    while let Some(start) = ["```lab simlab\n", "```quiz\n"].iter().filter_map(|f| text[at..].find(f)).min() {
        let begin = at + start + text[at + start..].find('\n').unwrap() + 1;
        let end = begin + text[begin..].find("\n```").unwrap() + 1;
        number += 1;
        // The planted mistakes depend on the number of a piece, so an additional piece would change all choices.
        if text[begin..end].starts_with(LATER) {
            at = end + 3;
            continue;
        }
        let around = (text[..begin].to_string(), text[end..].to_string());
        add(all, &format!("{name}#{number}"), models, &text[begin..end], Some(around));
        at = end + 3;
    }
}

/// Adds an object, and the labs of its questions.
fn add(all: &mut Vec<Piece>, name: &str, models: usize, text: &str, around: Option<(String, String)>) {
    let json: Value = serde_json::from_str(text).unwrap();
    let name = name.to_string();
    let home = |at: String| {
        let (before, behind) = around.clone()?;
        Some(LabLocation { before, behind, whole: json.clone(), at })
    };
    let Some(questions) = json["questions"].as_array() else {
        let home = home(String::new()).filter(|_| json["verify"].is_object());
        all.push(Piece { name, what: PieceKind::Lab, json: alone(&json), models, around: None, home });
        return;
    };
    for (i, question) in questions.iter().enumerate().filter(|(_, q)| q["sim"].is_object()) {
        let name = format!("{name}?{}", i + 1);
        let is_local = question["verify"].is_object() && question["verify"]["lab"].is_null();
        let home = home(format!("/questions/{i}/sim")).filter(|_| is_local);
        all.push(Piece {
            name,
            what: PieceKind::Lab,
            json: alone(&question["sim"]),
            models,
            around: None,
            home,
        });
    }
    let around = around.filter(|_| questions.iter().any(|q| q["verify"].is_object()));
    all.push(Piece { name, what: PieceKind::Quiz, json, models, around, home: None });
}

/// A lab without claims, and with a short run.
fn alone(lab: &Value) -> Value {
    let mut lab = lab.clone();
    let object = lab.as_object_mut().unwrap();
    object.shift_remove("verify");
    let shorter = |value: &mut Value| *value = json!(value.as_f64().unwrap().min(LONGEST));
    object.get_mut("stopAt").map(shorter);
    let plots = object.get_mut("plots").and_then(Value::as_array_mut);
    let any = plots.as_ref().is_some_and(|p| !p.is_empty());
    for plot in plots.into_iter().flatten() {
        let window = plot["window"].as_f64().unwrap_or(5.0);
        plot["window"] = json!(window.min(LONGEST));
    }
    if !any && !object.contains_key("stopAt") {
        object.insert("stopAt".into(), json!(LONGEST));
    }
    lab
}
