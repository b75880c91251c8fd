//! The text of a lesson in which every fence is replaced by a comment on one line.
//!
//! The fences of a page are those of `labspec::markdown`, which a check uses: it recognizes damaged ones and cuts them where their
//! content ends. The parser that renders the rest then sees a comment in the same place, in the same quote or list.

use labspec::markdown::Scan;
use std::collections::BTreeMap;
use std::ops::Range;

/// What replaces a fence. A comment of this kind is a block of its own that ends on its line, wherever it is.
pub(crate) const PLACEHOLDER: &str = "<!--labspec-->";

/// The text with replaced fences, and the way back.
#[derive(Debug, Default)]
pub(crate) struct Masked {
    pub(crate) text: String,
    /// Start in `text`, start in the file, length: pieces of text that are the same in both.
    pieces: Vec<(usize, usize, usize)>,
    /// The start of each placeholder in `text`, and the index of its fence.
    fences: BTreeMap<usize, usize>,
}

impl Masked {
    /// Replaces the fences of a text.
    pub(crate) fn new(text: &str, scan: &Scan) -> Masked {
        let mut masked = Masked::default();
        let mut offset = 0;
        for (index, block) in scan.blocks.iter().enumerate() {
            if block.span.start < offset {
                continue;
            }
            masked.push(text, offset..block.span.start);
            masked.fences.insert(masked.text.len(), index);
            masked.text.push_str(PLACEHOLDER);
            if text.get(..block.span.end).is_some_and(|before| before.ends_with('\n')) {
                masked.text.push('\n');
            }
            offset = block.span.end;
        }
        masked.push(text, offset..text.len());
        masked
    }

    fn push(&mut self, text: &str, range: Range<usize>) {
        let Some(piece) = text.get(range.clone()) else { return };
        self.pieces.push((self.text.len(), range.start, piece.len()));
        // The renderer separates blocks by this character. It has one byte, like its replacement.
        self.text.push_str(&piece.replace('\0', " "));
    }

    /// The byte of the file for a byte of the text. Inside a placeholder, it is the start of the fence.
    pub(crate) fn origin(&self, offset: usize) -> usize {
        let after = self.pieces.partition_point(|(start, ..)| *start <= offset);
        let Some((start, origin, length)) = after.checked_sub(1).and_then(|i| self.pieces.get(i)) else {
            return 0;
        };
        origin + (offset - start).min(*length)
    }

    /// The bytes of the file for a range of the text that contains no fence; `None` where it is not one piece.
    pub(crate) fn origin_of(&self, range: &Range<usize>) -> Option<Range<usize>> {
        let after = self.pieces.partition_point(|(start, ..)| *start <= range.start);
        let (start, origin, length) = after.checked_sub(1).and_then(|i| self.pieces.get(i))?;
        (range.end <= start + length).then(|| origin + range.start - start..origin + range.end - start)
    }

    /// The fences in a range of the text: the start of each placeholder, and the index of the fence.
    pub(crate) fn fences(&self, range: &Range<usize>) -> impl Iterator<Item = (usize, usize)> {
        self.fences.range(range.start..range.end.max(range.start)).map(|(offset, index)| (*offset, *index))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use labspec::markdown::scan;
    use labspec::source::SourceFile;

    #[test]
    fn a_fence_becomes_a_line_and_the_rest_keeps_its_place() {
        let text = "a\n\n> ```lab\n> {}\n> ```\n> b\n\nc\n";
        let masked = Masked::new(text, &scan(&SourceFile::new("t.md", text)));
        assert_eq!(masked.text, "a\n\n> <!--labspec-->\n> b\n\nc\n");
        let c = masked.text.rfind('c').unwrap();
        assert_eq!(masked.origin(c), text.rfind('c').unwrap());
        assert_eq!(masked.origin_of(&(c..c + 1)), Some(text.len() - 2..text.len() - 1));
        assert_eq!(masked.fences(&(0..masked.text.len())).collect::<Vec<_>>(), [(5, 0)]);
    }

    #[test]
    fn a_lost_closing_line_swallows_nothing() {
        let text = "```lab simlab\n{\"model\": \"a\"}\nSome prose.\n\n```quiz\n{\"id\": \"q\"}\n```\nx";
        let masked = Masked::new(text, &scan(&SourceFile::new("t.md", text)));
        assert_eq!(masked.text, "<!--labspec-->\nSome prose.\n\n<!--labspec-->\nx");
    }
}
