//! Files and positions in them.
//!
//! A lesson reaches the checks through several layers: the file, the body of a fence (without the `> ` of a quote), a JSON
//! string without its escapes, an expression in it. Every layer has a [`SourceMap`] to the layer below. Composed, they map
//! a byte of an expression to a line and column of the lesson.

mod map;
mod sources;

use crate::printable::printable_path;
use labspec_finding::Lines;
pub use labspec_finding::{EditorPosition, Position};
pub use map::{Piece, SourceMap};
pub use sources::PathQuery;
pub use sources::{Overlay, Sources};
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

/// Maximum size of a file, in bytes. Lessons are tens of kilobytes.
pub const MAX_FILE: u64 = 16 << 20;

/// A file of the author.
#[derive(Clone, Debug)]
pub struct SourceFile {
    path: Arc<str>,
    text: Arc<str>,
    lines: Lines,
}

/// Why the text of a file differs from what its author wrote.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BadText {
    /// A byte that is not UTF-8, and the offset of its replacement in the text.
    Byte {
        /// Offset.
        offset: usize,
        /// The byte.
        byte: u8,
    },
    /// The whole file is UTF-16.
    Utf16,
}

impl SourceFile {
    /// A file with this display path and text. The file system is not accessed.
    pub fn new(path: impl Into<Arc<str>>, text: impl Into<Arc<str>>) -> SourceFile {
        let text = text.into();
        let lines = Lines::new(&text);
        SourceFile { path: path.into(), text, lines }
    }

    /// Reads a UTF-8 file of at most [`MAX_FILE`] bytes.
    ///
    /// # Errors
    /// A message for the author: the file cannot be read, is too large, or is not UTF-8 (with the line).
    pub fn read(path: &Path) -> Result<SourceFile, String> {
        let text = read_text(path, MAX_FILE, "a lesson or a model")?;
        Ok(SourceFile::new(path.display().to_string(), text))
    }

    /// A file from arbitrary bytes. Bytes that are not UTF-8 are replaced, and the first one is reported, so that the rest
    /// can still be checked. UTF-16 is recognized by its byte order mark.
    pub fn from_bytes(path: impl Into<Arc<str>>, bytes: &[u8]) -> (SourceFile, Option<BadText>) {
        let wide = |from: fn([u8; 2]) -> u16| {
            let units = bytes.get(2..).unwrap_or(&[]).chunks_exact(2);
            let units = units.filter_map(|pair| Some(from([*pair.first()?, *pair.get(1)?])));
            char::decode_utf16(units).map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER)).collect::<String>()
        };
        match bytes {
            [0xff, 0xfe, ..] => (SourceFile::new(path, wide(u16::from_le_bytes)), Some(BadText::Utf16)),
            [0xfe, 0xff, ..] => (SourceFile::new(path, wide(u16::from_be_bytes)), Some(BadText::Utf16)),
            _ => match std::str::from_utf8(bytes) {
                Ok(text) => (SourceFile::new(path, text), None),
                Err(e) => {
                    let offset = e.valid_up_to();
                    let byte = bytes.get(offset).copied().unwrap_or(0);
                    let text = String::from_utf8_lossy(bytes).into_owned();
                    (SourceFile::new(path, text), Some(BadText::Byte { offset, byte }))
                }
            },
        }
    }

    /// Reads a file of at most [`MAX_FILE`] bytes like [`SourceFile::from_bytes`].
    ///
    /// # Errors
    /// A message for the author: the file cannot be read, is not a regular file, or is too large.
    pub fn read_lossy(path: &Path) -> Result<(SourceFile, Option<BadText>), String> {
        use std::io::Read;
        let displayed = path.display();
        let cannot = |e: std::io::Error| format!("cannot read {displayed}: {e}");
        // Checked before opening, because opening a pipe may block forever.
        if !std::fs::metadata(path).map_err(cannot)?.is_file() {
            return Err(format!("{displayed} is not a file"));
        }
        let mut bytes = Vec::new();
        let file = std::fs::File::open(path).map_err(cannot)?;
        file.take(MAX_FILE + 1).read_to_end(&mut bytes).map_err(cannot)?;
        if bytes.len() as u64 > MAX_FILE {
            return Err(format!("{displayed} is larger than {} MB, the limit for a lesson", MAX_FILE >> 20));
        }
        Ok(SourceFile::from_bytes(displayed.to_string(), &bytes))
    }

    /// The path in the form that is printed.
    pub fn path(&self) -> &Arc<str> {
        &self.path
    }

    /// The text.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The text of a span; empty when the span is not within this file.
    pub fn slice(&self, span: Range<usize>) -> &str {
        self.text.get(span).unwrap_or("")
    }

    /// Line and column of a byte offset; an offset beyond the end is the end.
    pub fn position(&self, offset: usize) -> Position {
        self.lines.position(&self.text, offset)
    }

    /// The position of a byte offset in editor coordinates.
    pub fn editor_position(&self, offset: usize) -> EditorPosition {
        self.lines.editor(&self.text, offset)
    }

    /// The bytes of a line (from 1), without its line break; `None` beyond the last line.
    pub fn line_span(&self, line: usize) -> Option<Range<usize>> {
        let start = self.lines.start(line)?;
        let end = self.lines.start(line + 1).map_or(self.text.len(), |next| next.saturating_sub(1));
        let text = self.slice(start..end);
        Some(start..start + text.strip_suffix('\r').unwrap_or(text).len())
    }

    /// A span widened to whole characters and clipped at the end of the file.
    pub fn snap(&self, span: &Range<usize>) -> Range<usize> {
        let start = self.floor(span.start);
        let mut end = span.end.clamp(start, self.text.len());
        while !self.text.is_char_boundary(end) {
            end += 1;
        }
        start..end
    }

    /// The nearest character boundary at or before an offset.
    pub fn floor(&self, offset: usize) -> usize {
        labspec_finding::floor(&self.text, offset)
    }
}

/// Reads a UTF-8 file of at most `limit` bytes; `what` describes its content in messages.
///
/// # Errors
/// A message for the author: the file cannot be read, is too large, or is not UTF-8 (with the line).
pub fn read_text(path: &Path, limit: u64, what: &str) -> Result<String, String> {
    use std::io::Read;
    let displayed = printable_path(path);
    let cannot = |e: std::io::Error| format!("cannot read {displayed}: {e}");
    let check = |meta: std::fs::Metadata| {
        if meta.is_file() {
            return Ok(());
        }
        let kind = if meta.is_dir() { "it is a folder" } else { "it is a device or a pipe" };
        Err(format!("{displayed} is not a file: {kind}"))
    };
    // Opening a pipe blocks until there is a writer, and opening a device may have any effect, so the kind is checked
    // first. Someone who swaps the file between the two checks owns the folder and can stop the program in simpler ways.
    check(std::fs::metadata(path).map_err(cannot)?)?;
    let file = std::fs::File::open(path).map_err(cannot)?;
    check(file.metadata().map_err(cannot)?)?;
    let mut bytes = Vec::new();
    file.take(limit.saturating_add(1)).read_to_end(&mut bytes).map_err(cannot)?;
    if bytes.len() as u64 > limit {
        return Err(format!("{displayed} is larger than {} MB, the limit for {what}", limit >> 20));
    }
    String::from_utf8(bytes).map_err(|e| {
        let good = e.utf8_error().valid_up_to();
        let line = 1 + e.as_bytes().iter().take(good).filter(|&&b| b == b'\n').count();
        format!("{displayed}, line {line}: not UTF-8; save the file as UTF-8")
    })
}

/// A piece of text from a file with its source map: code, HTML, a label.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Text {
    /// The text itself, decoded.
    pub value: String,
    /// Maps bytes of `value` to bytes of the file.
    pub map: SourceMap,
}

impl Text {
    /// A text that the file does not contain in this form; the span of each part is `place`.
    pub fn derived(value: String, place: Range<usize>) -> Text {
        Text { map: SourceMap::whole(value.len(), place), value }
    }

    /// The bytes of the file that contain this text (for a JSON string: without its quotes).
    pub fn span(&self) -> Range<usize> {
        self.map.span(0..self.value.len())
    }

    /// The bytes of the file for a byte range of `value`.
    pub fn span_of(&self, range: Range<usize>) -> Range<usize> {
        self.map.span(range)
    }

    /// The text as a string slice.
    pub fn as_str(&self) -> &str {
        &self.value
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_count_characters() {
        let file = SourceFile::new("a.md", "α β\r\nx“y”\n");
        assert_eq!(file.position(0), Position { line: 1, column: 1 });
        assert_eq!(file.position(3), Position { line: 1, column: 3 });
        let y = file.text().find('y').unwrap();
        assert_eq!(file.position(y), Position { line: 2, column: 3 });
        assert_eq!(file.position(y + 2), Position { line: 2, column: 4 }, "inside a character: its start");
        assert_eq!(file.position(9999), Position { line: 3, column: 1 });
        assert_eq!(file.slice(file.line_span(1).unwrap()), "α β");
        assert_eq!(file.slice(file.line_span(2).unwrap()), "x“y”");
        assert_eq!(file.line_span(4), None);
        assert_eq!(file.line_span(0), None);
    }

    #[test]
    fn a_file_that_is_not_text_is_refused_with_its_line() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("bad.md");
        std::fs::write(&path, b"one\ntwo \xff").unwrap();
        assert!(SourceFile::read(&path).unwrap_err().contains("line 2: not UTF-8"));
        assert!(SourceFile::read(folder.path()).unwrap_err().contains("not a file"));
        assert!(SourceFile::read(&folder.path().join("none.md")).is_err());
    }
}
