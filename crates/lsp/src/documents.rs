//! What the editor holds: texts that may not be saved yet, and what was found of them.

use super::convert;
use labspec::finding::Finding;
use labspec::source::{MAX_FILE, SourceFile};
use labspec::spec::{FileKind, Lesson, kind_of};
use lsp_types::{TextDocumentContentChangeEvent, Uri};
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

/// A text of the editor.
#[derive(Debug)]
pub(super) struct OpenDocument {
    /// Its name for the editor.
    pub(super) uri: Uri,
    /// Its file, links resolved, which may not exist yet.
    pub(super) path: PathBuf,
    /// What it is.
    pub(super) kind: FileKind,
    /// The text.
    pub(super) file: SourceFile,
    /// Counted by the editor.
    pub(super) version: i32,
    /// It was changed and not looked at since.
    pub(super) stale: bool,
    /// As it was read the last time, if it is a lesson.
    pub(super) lesson: Option<Arc<Lesson>>,
    /// What is reported of it.
    pub(super) findings: Vec<Finding>,
    /// What was found of each block, by the block's text and what it rests on.
    pub(super) blocks: BTreeMap<String, Vec<Finding>>,
}

impl OpenDocument {
    /// A text that was opened.
    pub(super) fn new(uri: Uri, path: PathBuf, text: &str, version: i32) -> OpenDocument {
        let name = path.display().to_string();
        OpenDocument {
            uri,
            kind: kind_of(&path),
            path,
            file: SourceFile::new(name, text),
            version,
            stale: true,
            lesson: None,
            findings: Vec::new(),
            blocks: BTreeMap::new(),
        }
    }

    /// Applies changes, one after the other: each is a text for a range, or the whole text.
    pub(super) fn change(&mut self, changes: &[TextDocumentContentChangeEvent], version: i32) {
        let mut text = self.file.text().to_string();
        for change in changes {
            let span = change.range.map_or(0..text.len(), |range| convert::byte_span(&text, range));
            if text.len() + change.text.len() <= 2 * MAX_FILE as usize {
                text.replace_range(span, &change.text);
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
    use lsp_types::{Position, Range};

    #[test]
    fn changes_follow_each_other() {
        let uri = "file:///a.md".parse().unwrap();
        let mut document = OpenDocument::new(uri, "/a.md".into(), "a𝄞b\r\ncd\n", 1);
        let at = |line, from, to, text: &str| TextDocumentContentChangeEvent {
            range: Some(Range { start: Position::new(line, from), end: Position::new(line, to) }),
            range_length: None,
            text: text.to_string(),
        };
        document.change(&[at(0, 3, 4, "ä"), at(1, 1, 99, "x"), at(9, 9, 9, "end")], 2);
        assert_eq!(document.file.text(), "a𝄞ä\r\ncx\nend");
        let whole = |text: &str| TextDocumentContentChangeEvent { range: None, ..at(0, 0, 0, text) };
        document.change(&[whole("new"), at(0, 1, 2, "o")], 3);
        assert_eq!(document.file.text(), "now");
    }
}
