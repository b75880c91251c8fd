//! The documents that are open in the editor, whose texts may not be saved yet, and their findings.

use super::convert;
use labspec::source::MAX_FILE;
use labspec_assist::{Document, RunValues};
use lsp_types::{TextDocumentContentChangeEvent, Uri};
use std::path::PathBuf;

/// A document that is open in the editor.
#[derive(Debug)]
pub(super) struct OpenDocument {
    /// The URI that the editor uses.
    pub(super) uri: Uri,
    /// The text with its findings. The file may not exist yet.
    pub(super) content: Document,
    /// The version number of the editor.
    pub(super) version: i32,
    /// Whether it changed since the last check.
    pub(super) stale: bool,
    /// What the runs of the last check gave.
    pub(super) values: RunValues,
}

impl OpenDocument {
    /// Creates a document that was opened.
    pub(super) fn new(uri: Uri, path: PathBuf, text: &str, version: i32) -> OpenDocument {
        let content = Document::new(path, text);
        OpenDocument { uri, content, version, stale: true, values: RunValues::default() }
    }

    /// Applies changes in order: each replaces a range, or the whole text.
    pub(super) fn change(&mut self, changes: &[TextDocumentContentChangeEvent], version: i32) {
        let mut text = self.content.file.text().to_string();
        for change in changes {
            let span = change.range.map_or(0..text.len(), |range| convert::byte_span(&text, range));
            if text.len() + change.text.len() <= 2 * MAX_FILE as usize {
                text.replace_range(span, &change.text);
            }
        }
        self.content.set_text(text);
        self.version = version;
        self.stale = true;
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
        let change_of = |line, from, to, text: &str| TextDocumentContentChangeEvent {
            range: Some(Range { start: Position::new(line, from), end: Position::new(line, to) }),
            range_length: None,
            text: text.to_string(),
        };
        document.change(&[change_of(0, 3, 4, "ä"), change_of(1, 1, 99, "x"), change_of(9, 9, 9, "end")], 2);
        assert_eq!(document.content.file.text(), "a𝄞ä\r\ncx\nend");
        let whole = |text: &str| TextDocumentContentChangeEvent { range: None, ..change_of(0, 0, 0, text) };
        document.change(&[whole("new"), change_of(0, 1, 2, "o")], 3);
        assert_eq!(document.content.file.text(), "now");
    }
}
