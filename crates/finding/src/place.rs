//! Places in a text: bytes, lines and columns, and what editors count.

use std::ops::Range;
use std::sync::Arc;

/// A range of bytes of a text, end excluded, that can be copied. Always on character boundaries.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Span {
    /// First byte.
    pub start: usize,
    /// One past the last byte.
    pub end: usize,
}

impl Span {
    /// The bytes from `start` to `end`.
    pub const fn new(start: usize, end: usize) -> Span {
        Span { start, end }
    }

    /// The smallest span that holds both.
    pub fn to(self, other: Span) -> Span {
        Span { start: self.start.min(other.start), end: self.end.max(other.end) }
    }

    /// The empty span just behind this one.
    pub fn after(self) -> Span {
        Span { start: self.end, end: self.end }
    }

    /// The text of the span, empty when it does not lie in `source`.
    pub fn text(self, source: &str) -> &str {
        source.get(self.start..self.end).unwrap_or("")
    }
}

impl From<Span> for Range<usize> {
    fn from(span: Span) -> Range<usize> {
        span.start..span.end
    }
}

impl From<Range<usize>> for Span {
    fn from(range: Range<usize>) -> Span {
        Span { start: range.start, end: range.end }
    }
}

impl PartialEq<Span> for Range<usize> {
    fn eq(&self, other: &Span) -> bool {
        (self.start, self.end) == (other.start, other.end)
    }
}

/// Another place that helps to understand a finding.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// The file; empty for that of the finding.
    pub path: Arc<str>,
    /// Bytes of that file.
    pub span: Range<usize>,
    /// What is there.
    pub label: String,
}

/// A line and a column, both counted from 1; columns count characters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Position {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// UTF-16 units before it on its line, from 0, as editors count.
    pub utf16: usize,
}

/// Where the lines of a text begin.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Lines {
    starts: Vec<usize>,
}

impl Lines {
    /// The lines of a text. Only `\n` ends one.
    pub fn of(text: &str) -> Lines {
        let after = text.match_indices('\n').map(|(i, _)| i.saturating_add(1));
        Lines { starts: std::iter::once(0).chain(after).collect() }
    }

    /// How many there are; a text that ends with a line break has an empty one more.
    pub fn count(&self) -> usize {
        self.starts.len()
    }

    /// First byte of a line, from 1.
    pub fn start(&self, line: usize) -> Option<usize> {
        self.starts.get(line.checked_sub(1)?).copied()
    }

    /// Line and column of a byte of the text that the lines were made of. A byte inside of a character is where the character
    /// begins, one behind the end is the end.
    pub fn position(&self, text: &str, byte: usize) -> Position {
        let byte = (0..=byte.min(text.len())).rev().find(|&i| text.is_char_boundary(i)).unwrap_or(0);
        let line = self.starts.partition_point(|&start| start <= byte).max(1);
        let before = text.get(self.start(line).unwrap_or(0)..byte).unwrap_or("");
        Position { line, column: before.chars().count() + 1, utf16: before.encode_utf16().count() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against a walk over the whole text.
    #[test]
    fn positions_of_every_byte() {
        for text in ["", "a", "äö\nx𝄞y\r\n\n\u{feff}z\t!", "\n\n", "𝄞𝄞\n𝄞"] {
            let lines = Lines::of(text);
            for byte in 0..text.len() + 3 {
                let (mut line, mut column, mut utf16) = (1, 1, 0);
                for (i, c) in text.char_indices() {
                    if i + c.len_utf8() > byte {
                        break;
                    }
                    (line, column, utf16) =
                        if c == '\n' { (line + 1, 1, 0) } else { (line, column + 1, utf16 + c.len_utf16()) };
                }
                assert_eq!(lines.position(text, byte), Position { line, column, utf16 }, "{text:?} {byte}");
            }
        }
    }
}
