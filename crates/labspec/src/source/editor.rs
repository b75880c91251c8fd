//! Places as editors count them: lines from 0, and on a line the units of UTF-16.
//!
//! After the Language Server Protocol 3.17, "Position": a line ends with `\n`, `\r\n` or a single `\r`. A byte-order mark
//! is how a file is written, not part of what an editor shows, so it counts nothing.

use super::SourceFile;

/// A place as an editor names it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct EditorPosition {
    /// Line, from 0.
    pub line: usize,
    /// Units of UTF-16 before it on its line: two for `𝄞`, one for `ä`.
    pub character: usize,
}

/// What a file may begin with, so that its encoding is known.
const MARK: char = '\u{feff}';

/// The bytes behind every `\r` that ends a line on its own.
pub(super) fn single_returns(text: &str) -> Vec<usize> {
    let behind = text.match_indices('\r').map(|(at, _)| at + 1);
    behind.filter(|&at| text.as_bytes().get(at) != Some(&b'\n')).collect()
}

impl SourceFile {
    /// The place of a byte offset as an editor names it. An offset inside of a character is that character's, one behind
    /// the end is the end, one inside of a line break is the end of its line.
    pub fn editor_position(&self, offset: usize) -> EditorPosition {
        let offset = self.floor(offset);
        let lines = self.line_starts.partition_point(|&start| start <= offset);
        let returns = self.returns.partition_point(|&start| start <= offset);
        let last = |starts: &[usize], count: usize| {
            count.checked_sub(1).and_then(|i| starts.get(i)).copied().unwrap_or(0)
        };
        let start = last(&self.line_starts, lines).max(last(&self.returns, returns));
        let mut before = self.slice(start..offset);
        if start == 0 {
            before = before.strip_prefix(MARK).unwrap_or(before);
        }
        // What ends with a return here stands between the two halves of `\r\n`.
        before = before.strip_suffix('\r').unwrap_or(before);
        EditorPosition {
            line: lines.saturating_sub(1) + returns,
            character: before.chars().map(char::len_utf16).sum(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The same, by walking over the text byte by byte, as an editor would that was handed UTF-16.
    fn walked(text: &str, offset: usize) -> EditorPosition {
        let shown: Vec<(usize, char)> = text.char_indices().collect();
        let (mut line, mut units): (usize, Vec<u16>) = (0, Vec::new());
        let mut place = EditorPosition { line: 0, character: 0 };
        for (i, &(at, c)) in shown.iter().enumerate() {
            if offset < at + c.len_utf8() {
                return place;
            }
            let next = shown.get(i + 1).map(|&(_, c)| c);
            if at == 0 && c == '\u{feff}' {
                continue;
            }
            if c == '\r' && next == Some('\n') {
                // Between the two: still the end of the line.
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
        let file = SourceFile::new("t.md", text);
        for offset in 0..text.len() + 3 {
            assert_eq!(file.editor_position(offset), walked(text, offset), "byte {offset} of {text:?}");
        }
    }

    #[test]
    fn an_editor_finds_the_place() {
        let file = SourceFile::new("t.md", "\u{feff}ä\tx\r\n𝄞b👩‍🔬c\rd\n");
        let at = |what: char| {
            let place = file.editor_position(file.text().find(what).unwrap());
            (place.line, place.character)
        };
        assert_eq!([at('ä'), at('\t'), at('x')], [(0, 0), (0, 1), (0, 2)]);
        // A clef is two units, a scientist five.
        assert_eq!([at('b'), at('c'), at('d')], [(1, 2), (1, 8), (2, 0)]);
        assert_eq!(file.editor_position(1000), EditorPosition { line: 3, character: 0 });
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
