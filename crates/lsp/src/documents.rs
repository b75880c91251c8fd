//! What the editor holds: texts that may not be saved yet, and what was found of them.

use super::places;
use labspec::finding::Finding;
use labspec::source::{MAX_FILE, SourceFile};
use labspec::spec::{FileKind, Lesson, kind_of};
use serde_json::Value;
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::PathBuf;
use std::sync::Arc;

/// A text of the editor.
#[derive(Debug)]
pub(super) struct Document {
    /// Its name for the editor.
    pub(super) uri: String,
    /// Its file, links resolved, which may not exist yet.
    pub(super) path: PathBuf,
    /// What it is.
    pub(super) kind: FileKind,
    /// The text.
    pub(super) file: SourceFile,
    /// Counted by the editor.
    pub(super) version: i64,
    /// It was changed and not looked at since.
    pub(super) stale: bool,
    /// As it was read the last time, if it is a lesson.
    pub(super) lesson: Option<Arc<Lesson>>,
    /// What is told of it.
    pub(super) findings: Vec<Finding>,
    /// What was found of each block, by the block's text and what it rests on.
    pub(super) blocks: BTreeMap<String, Vec<Finding>>,
}

impl Document {
    /// A text that was opened.
    pub(super) fn new(uri: &str, path: PathBuf, text: &str, version: i64) -> Document {
        let shown = path.display().to_string();
        Document {
            uri: uri.to_string(),
            kind: kind_of(&path),
            path,
            file: SourceFile::new(shown, text),
            version,
            stale: true,
            lesson: None,
            findings: Vec::new(),
            blocks: BTreeMap::new(),
        }
    }

    /// Applies changes, one after the other: each is a text for a range, or the whole text.
    pub(super) fn change(&mut self, changes: &[Value], version: i64) {
        let mut text = self.file.text().to_string();
        for change in changes {
            let Some(new) = change.get("text").and_then(Value::as_str) else { continue };
            let span: Option<Range<usize>> = match change.get("range") {
                Some(range) if !range.is_null() => places::span(&text, range),
                _ => Some(0..text.len()),
            };
            let Some(span) = span else { continue };
            if text.len() + new.len() <= 2 * MAX_FILE as usize {
                text.replace_range(span, new);
            }
        }
        self.file = SourceFile::new(self.file.path().clone(), text);
        self.version = version;
        self.stale = true;
        self.lesson = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn changes_follow_each_other() {
        let mut document = Document::new("file:///a.md", "/a.md".into(), "a𝄞b\r\ncd\n", 1);
        let at = |line: u32, from: u32, to: u32, text: &str| json!({"range": {"start": {"line": line, "character": from}, "end": {"line": line, "character": to}}, "text": text});
        document.change(&[at(0, 3, 4, "ä"), at(1, 1, 99, "x"), at(9, 9, 9, "end")], 2);
        assert_eq!(document.file.text(), "a𝄞ä\r\ncx\nend");
        document.change(&[json!({"text": "new"}), json!({}), json!({"range": 3, "text": "no"})], 3);
        assert_eq!(document.file.text(), "new");
    }
}
