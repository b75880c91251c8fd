//! Locations in a text: bytes, lines and columns, and positions of editors.

use std::ops::Range;
use std::sync::Arc;

/// A byte range of a text, end excluded, that can be copied. Always on character boundaries.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Span {
    /// First byte.
    pub start: usize,
    /// One past the last byte.
    pub end: usize,
}

impl Span {
    /// Creates the span from `start` to `end`.
    pub const fn new(start: usize, end: usize) -> Span {
        Span { start, end }
    }

    /// Returns the smallest span that contains both.
    pub fn to(self, other: Span) -> Span {
        Span { start: self.start.min(other.start), end: self.end.max(other.end) }
    }

    /// Returns the empty span directly after this one.
    pub fn after(self) -> Span {
        Span { start: self.end, end: self.end }
    }

    /// Returns the text of the span, or an empty text if the span is not in `source`.
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

/// A further location that helps to understand a finding.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Place {
    /// The file; empty if it is that of the finding.
    pub path: Arc<str>,
    /// The byte range in that file.
    pub span: Range<usize>,
    /// What is at this location.
    pub label: String,
}

/// A line and a column, both counted from 1; columns count characters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Position {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
}

/// A position as used by editors: lines from 0, and UTF-16 code units on a line.
///
/// Follows the Language Server Protocol 3.17, "Position": a line ends with `\n`, `\r\n` or a single `\r`. A byte-order mark
/// belongs to the encoding of a file and is not displayed, so it is not counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct EditorPosition {
    /// Line, from 0.
    pub line: usize,
    /// The UTF-16 code units before it on its line: two for `𝄞`, one for `ä`.
    pub character: usize,
}

/// The byte-order mark at the beginning of a file.
const MARK: char = '\u{feff}';

/// The starts of the lines of a text. The methods require the text from which it was created.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Lines {
    starts: Vec<usize>,
    /// The byte after every `\r` that ends a line without `\n`: for editors.
    returns: Vec<usize>,
}

impl Lines {
    /// Finds the lines of a text. In messages for users, only `\n` ends a line.
    pub fn new(text: &str) -> Lines {
        let after = text.match_indices('\n').map(|(i, _)| i.saturating_add(1));
        let behind = text.match_indices('\r').map(|(offset, _)| offset.saturating_add(1));
        let returns = behind.filter(|&offset| text.as_bytes().get(offset) != Some(&b'\n')).collect();
        Lines { starts: std::iter::once(0).chain(after).collect(), returns }
    }

    /// The first byte of a line, counted from 1, or `None` after the last one. A text that ends with a line break has
    /// an additional empty line.
    pub fn start(&self, line: usize) -> Option<usize> {
        self.starts.get(line.checked_sub(1)?).copied()
    }

    /// The line of a byte, from 1.
    pub fn line(&self, byte: usize) -> usize {
        self.starts.partition_point(|&start| start <= byte).max(1)
    }

    /// The line and column of a byte. A byte inside a character has the position of the character, and one past
    /// the end that of the end.
    pub fn position(&self, text: &str, byte: usize) -> Position {
        let byte = floor(text, byte);
        let line = self.line(byte);
        let before = text.get(self.start(line).unwrap_or(0)..byte).unwrap_or("");
        Position { line, column: before.chars().count() + 1 }
    }

    /// The editor position of a byte. A byte inside a line break has the position of the end of its line.
    pub fn editor(&self, text: &str, byte: usize) -> EditorPosition {
        let byte = floor(text, byte);
        let line = self.line(byte);
        let returns = self.returns.partition_point(|&start| start <= byte);
        let behind = returns.checked_sub(1).and_then(|i| self.returns.get(i)).copied().unwrap_or(0);
        let start = self.start(line).unwrap_or(0).max(behind);
        let mut before = text.get(start..byte).unwrap_or("");
        if start == 0 {
            before = before.strip_prefix(MARK).unwrap_or(before);
        }
        // Here, a trailing `\r` is the first half of `\r\n`, and the byte is between the halves.
        before = before.strip_suffix('\r').unwrap_or(before);
        EditorPosition { line: line - 1 + returns, character: before.chars().map(char::len_utf16).sum() }
    }
}

/// The nearest character boundary at or before a byte.
pub fn floor(text: &str, byte: usize) -> usize {
    (0..=byte.min(text.len())).rev().find(|&i| text.is_char_boundary(i)).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Compared with a traversal of the whole text.
    #[test]
    fn positions_of_every_byte() {
        for text in ["", "a", "äö\nx𝄞y\r\n\n\u{feff}z\t!", "\n\n", "𝄞𝄞\n𝄞"] {
            let lines = Lines::new(text);
            for byte in 0..text.len() + 3 {
                let (mut line, mut column) = (1, 1);
                for (i, c) in text.char_indices() {
                    if i + c.len_utf8() > byte {
                        break;
                    }
                    (line, column) = if c == '\n' { (line + 1, 1) } else { (line, column + 1) };
                }
                assert_eq!(lines.position(text, byte), Position { line, column }, "{text:?} {byte}");
            }
        }
    }

    /// The same by traversing the text byte by byte, as an editor that uses UTF-16 does.
    fn position_by_traversal(text: &str, offset: usize) -> EditorPosition {
        let chars: Vec<(usize, char)> = text.char_indices().collect();
        let (mut line, mut units): (usize, Vec<u16>) = (0, Vec::new());
        let mut place = EditorPosition { line: 0, character: 0 };
        for (i, &(start, c)) in chars.iter().enumerate() {
            if offset < start + c.len_utf8() {
                return place;
            }
            let next = chars.get(i + 1).map(|&(_, c)| c);
            if start == 0 && c == '\u{feff}' {
                continue;
            }
            if c == '\r' && next == Some('\n') {
                // Between `\r` and `\n`: still the end of the line.
                continue;
            }
            if c == '\n' || c == '\r' {
                (line, units) = (line + 1, Vec::new());
            } else {
                units.extend(c.encode_utf16(&mut [0; 2]).iter());
            }
            place = EditorPosition { line, character: units.len() };
        }
        place
    }

    fn agrees(text: &str) {
        let lines = Lines::new(text);
        for offset in 0..text.len() + 3 {
            assert_eq!(
                lines.editor(text, offset),
                position_by_traversal(text, offset),
                "byte {offset} of {text:?}"
            );
        }
    }

    #[test]
    fn editor_positions_are_correct() {
        let text = "\u{feff}ä\tx\r\n𝄞b👩‍🔬c\rd\n";
        let lines = Lines::new(text);
        let position_of = |what: char| {
            let place = lines.editor(text, text.find(what).unwrap());
            (place.line, place.character)
        };
        assert_eq!([position_of('ä'), position_of('\t'), position_of('x')], [(0, 0), (0, 1), (0, 2)]);
        // The clef has two units, the emoji of a scientist five.
        assert_eq!([position_of('b'), position_of('c'), position_of('d')], [(1, 2), (1, 8), (2, 0)]);
        assert_eq!(lines.editor(text, 1000), EditorPosition { line: 3, character: 0 });
    }

    #[test]
    fn every_byte_of_odd_texts_has_the_place_of_the_reference() {
        for text in [
            "",
            "\u{feff}",
            "\u{feff}\u{feff}a",
            "a\u{feff}b",
            "\r\n\r\r\n\n\r",
            "ä𝄞\t👩‍🔬\r\n\ta\u{301}\r\n",
            "\u{feff}\r\nß\u{2028}x",
        ] {
            agrees(text);
        }
    }

    proptest! {
        #[test]
        fn every_byte_has_the_place_of_the_reference(text in "[\u{feff}ä𝄞👩\u{200d}\ta \r\n]{0,24}") {
            agrees(&text);
        }
    }
}
