//! The kind of a file, from its name, and the kind of a JSON object, from its keys.

use super::fields::fits;
use super::format::{LAB, Object, QUIZ};
use crate::json::{Json, Node, nearest};
use std::path::Path;

/// The kind of a file, from its extension. Case is ignored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileKind {
    /// Markdown: `.md`, `.markdown`, `.mdx`, `.qmd`, `.Rmd`.
    Lesson,
    /// JSON: a lab, a quiz, or a list of them.
    Json,
    /// A model in MJCF: `.xml`.
    Model,
    /// Anything else; such a file is not read: a notebook, a picture.
    Unknown,
}

/// The kind of a file, from the extension of its name.
pub fn kind_of(path: &Path) -> FileKind {
    let ending = path.extension().and_then(|e| e.to_str()).unwrap_or("").to_ascii_lowercase();
    match ending.as_str() {
        "md" | "markdown" | "mdx" | "qmd" | "rmd" => FileKind::Lesson,
        "json" => FileKind::Json,
        "xml" => FileKind::Model,
        _ => FileKind::Unknown,
    }
}

/// The probable kind of a JSON object.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Nature {
    Lab,
    Quiz,
    Neither,
}

/// Keys that identify a lab.
const OF_LABS: [&str; 5] = ["model", "xml", "controls", "plots", "readouts"];
/// Words that are similar to our keys but mean something else in other files.
const OTHER_WORDS: [&str; 8] = ["mode", "modes", "module", "modules", "mod", "plat", "xsl", "models"];

/// Distinguishes a lab from a quiz, even if the identifying key is misspelt; then most of the other keys must be declared.
pub(super) fn nature(node: &Node) -> Nature {
    if node.get("questions").is_some() {
        Nature::Quiz
    } else if OF_LABS.iter().any(|key| node.get(key).is_some()) {
        Nature::Lab
    } else if nearly(node, &QUIZ, &["questions"]) {
        Nature::Quiz
    } else if nearly(node, &LAB, &OF_LABS) {
        Nature::Lab
    } else {
        Nature::Neither
    }
}

/// Whether most keys of an object are declared, and one of them is similar to an identifying key.
fn nearly(node: &Node, object: &Object, telling: &[&'static str]) -> bool {
    let members = node.members();
    let (mut matching, mut near) = (0, false);
    for member in members.iter().take(100) {
        let key = member.key.as_str();
        if object.key(key).is_some() {
            matching += 1;
        } else if !OTHER_WORDS.contains(&key.to_ascii_lowercase().as_str())
            && let Some(meant) = nearest(key, telling.iter().copied())
            && (object.key(meant).is_some_and(|k| fits(&k.ty, &member.value.json))
                || matches!(member.value.json, Json::Object(_)))
        {
            matching += 1;
            near = true;
        }
    }
    near && 2 * matching > members.len()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::SourceMap;

    #[test]
    fn files_are_told_by_their_ending() {
        for (name, kind) in [
            ("a.md", FileKind::Lesson),
            ("A.MD", FileKind::Lesson),
            ("x/a.markdown", FileKind::Lesson),
            ("a.mdx", FileKind::Lesson),
            ("a.qmd", FileKind::Lesson),
            ("a.Rmd", FileKind::Lesson),
            ("a.JSON", FileKind::Json),
            ("a.Xml", FileKind::Model),
            ("a.ipynb", FileKind::Unknown),
            ("md", FileKind::Unknown),
            (".md", FileKind::Unknown),
        ] {
            assert_eq!(kind_of(Path::new(name)), kind, "{name}");
        }
    }

    #[test]
    fn what_is_nearly_a_lab_or_a_quiz_is_one_and_other_files_are_not() {
        for (json, expected) in [
            (r#"{"modle": "ball"}"#, Nature::Lab),
            (r#"{"title": "t", "control": [{"label": "m"}]}"#, Nature::Lab),
            (r#"{"xlm": "<mujoco/>", "plot": []}"#, Nature::Lab),
            (r#"{"readout": [], "stopAt": 1}"#, Nature::Lab),
            (r#"{"plot": {"traces": []}, "height": 3}"#, Nature::Lab),
            (r#"{"id": "a", "question": [{"q": "?"}]}"#, Nature::Quiz),
            (r#"{"id": "a", "question s": []}"#, Nature::Quiz),
            (r#"{"title": "Falling"}"#, Nature::Neither),
            (
                r#"{"name": "x", "version": "1", "type": "module", "scripts": {}, "module": "a.js"}"#,
                Nature::Neither,
            ),
            (r#"{"mode": "dark"}"#, Nature::Neither),
            (r#"{"name": "x", "control": [], "files": [], "license": "MIT"}"#, Nature::Neither),
            (r#"{"id": 1, "question": "What?", "options": ["a"], "answer": 0}"#, Nature::Neither),
            (r#"{"cells": [], "metadata": {}, "nbformat": 4}"#, Nature::Neither),
            ("[]", Nature::Neither),
            ("{}", Nature::Neither),
        ] {
            let parsed = crate::json::parse(json, &SourceMap::verbatim(0..json.len()));
            assert_eq!(nature(&parsed.node.unwrap()), expected, "{json}");
        }
    }
}
