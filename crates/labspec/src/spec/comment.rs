//! Comments for labspec in the text of a lesson, each about the following block: `<!-- labspec allow … -->`, `<!-- labspec
//! verify {…} -->`. `<!-- labspec define NAME {…} -->` is about no block: it names runs and measures for `use`.

use super::lab::Verify;
use crate::markdown::Scan;
use crate::source::SourceFile;
use std::ops::Range;

const OPENS: &str = "<!--";
const CLOSES: &str = "-->";
const OURS: &str = "labspec";
pub(super) const CLAIM: &str = "verify";
pub(super) const DEFINITION: &str = "define";

/// A comment.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Comment {
    /// Its bytes, including the comment marks.
    pub(super) span: Range<usize>,
    /// The text after its keyword.
    pub(super) inside: Range<usize>,
    /// The bytes to which it applies.
    pub(super) over: Range<usize>,
}

/// A claim about a block of the text.
#[derive(Clone, Debug, PartialEq)]
pub struct Remark {
    /// Bytes of the comment.
    pub span: Range<usize>,
    /// Bytes of the block to which it applies.
    pub over: Range<usize>,
    /// The claims.
    pub verify: Verify,
}

/// Runs, measures and searches with a name, which `verify` objects use.
#[derive(Clone, Debug, PartialEq)]
pub struct Definition {
    /// Its name.
    pub name: String,
    /// Bytes of the comment.
    pub span: Range<usize>,
    /// Its runs, measures and searches.
    pub verify: Verify,
}

/// The labspec comments with this keyword. Each applies to the following block: a whole fence, or the text up to the next
/// empty line.
pub(super) fn comments(file: &SourceFile, scan: &Scan, word: &str) -> Vec<Comment> {
    let mut paragraph = 0..0;
    let all = labspec_comments(file.text(), scan, word).into_iter();
    all.map(|(span, inside)| Comment { over: following(file, scan, span.end, &mut paragraph), span, inside })
        .collect()
}

/// The block after an offset of the text. `paragraph` is the last paragraph whose end was searched: a block that begins in
/// it ends with it, so that it is not read again.
fn following(file: &SourceFile, scan: &Scan, from: usize, paragraph: &mut Range<usize>) -> Range<usize> {
    let rest = file.text().get(from..).unwrap_or_default();
    let text = rest.trim_start();
    let start = from + rest.len() - text.len();
    let blocks = &scan.blocks;
    let last = blocks.partition_point(|b| b.span.start <= start).checked_sub(1);
    if let Some(block) = last.and_then(|index| blocks.get(index)).filter(|b| b.span.contains(&start)) {
        return start..block.span.end;
    }
    if !paragraph.contains(&start) {
        let empty = |line: &str| line.trim().is_empty();
        let length = text.split_inclusive('\n').take_while(|line| !empty(line)).map(str::len).sum::<usize>();
        *paragraph = start..start + length;
    }
    start..paragraph.end
}

/// The bytes of every labspec comment with this keyword, and of the text after the keyword.
pub(super) fn labspec_comments(text: &str, scan: &Scan, word: &str) -> Vec<(Range<usize>, Range<usize>)> {
    let mut all = Vec::new();
    for html in &scan.html {
        let mut from = html.start;
        while let Some(start) =
            text.get(from..html.end).and_then(|t| t.find(OPENS)).map(|offset| from + offset)
        {
            let Some(end) =
                text.get(start..html.end).and_then(|t| t.find(CLOSES)).map(|offset| start + offset)
            else {
                break;
            };
            from = end + CLOSES.len();
            all.extend(behind(text, start + OPENS.len()..end, word).map(|inside| (start..from, inside)));
        }
    }
    all
}

/// The bytes of the comments with claims and definitions, and of the JSON in them.
pub(crate) fn claims_in_comments(text: &str, scan: &Scan) -> Vec<(Range<usize>, Range<usize>)> {
    let json = |inside: Range<usize>| {
        let open = text.get(inside.clone()).and_then(|t| t.find('{')).unwrap_or(0);
        inside.start + open..inside.end
    };
    let all = [CLAIM, DEFINITION].into_iter().flat_map(|word| labspec_comments(text, scan, word));
    all.map(|(comment, inside)| (comment, json(inside))).collect()
}

/// The bytes of the claim in a comment that contains a byte of the text.
pub(super) fn claim_at(text: &str, scan: &Scan, byte: usize) -> Option<Range<usize>> {
    let mut all = labspec_comments(text, scan, CLAIM).into_iter().map(|(_, inside)| inside);
    all.find(|inside| (inside.start..=inside.end).contains(&byte))
}

/// The text after `labspec` and the keyword in a comment.
fn behind(text: &str, inside: Range<usize>, word: &str) -> Option<Range<usize>> {
    let mut rest = text.get(inside.clone())?;
    for part in [OURS, word] {
        rest = rest.trim_start().strip_prefix(part)?;
    }
    rest.starts_with(|c: char| c.is_whitespace() || c == '{').then(|| inside.end - rest.len()..inside.end)
}
