//! Comments for labspec in the text of a lesson, each about the following block: `<!-- labspec allow … -->`, `<!-- labspec
//! verify {…} -->`. `<!-- labspec define NAME {…} -->` is about no block: it names runs and measures for `use`.

use super::lab::Verify;
use crate::markdown::Scan;
use crate::source::SourceFile;
use labspec_finding::nearest;
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
pub struct ClaimComment {
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

/// A comment that begins with `labspec` and that nothing reads.
pub(crate) struct UnreadComment {
    pub(crate) span: Range<usize>,
    /// The unknown keyword as the known one that it resembles, if there is one; `None` if the marks of the comment are wrong.
    pub(crate) keyword: Option<Option<&'static str>>,
}

/// The keywords of comments.
const KEYWORDS: [&str; 3] = [CLAIM, DEFINITION, "allow"];
/// Comments of Markdown with JavaScript.
const MDX_OPENS: &str = "{/*";
const MDX_CLOSES: &str = "*/}";
/// The most bytes of a comment that are read here.
const MAX_WORDS: usize = 200;

/// The comments that begin with `labspec` or a word like it, and that nothing reads. Every byte is searched once.
pub(crate) fn unread_comments(text: &str, scan: &Scan) -> Vec<UnreadComment> {
    let mut all = Vec::new();
    for html in &scan.html {
        let mut from = html.start;
        while let Some(start) = text.get(from..html.end).and_then(|t| t.find(OPENS)).map(|i| from + i) {
            let begin = start + OPENS.len();
            let closed = text.get(begin..html.end).and_then(|t| t.find(CLOSES)).map(|i| begin + i);
            let inside = begin..closed.unwrap_or(html.end);
            from = closed.map_or(html.end, |end| end + CLOSES.len());
            let Some(head) = text.get(inside.clone()).and_then(head_of) else { continue };
            let is_read = || KEYWORDS.iter().any(|word| behind(text, inside.clone(), word).is_some());
            if !is_ours(&head) || closed.is_some() && is_read() {
                continue;
            }
            let has_keyword = closed.is_some() && !KEYWORDS.contains(&head.keyword.as_str());
            let near = || nearest(&head.keyword, KEYWORDS).or_else(|| nearest(&head.name, KEYWORDS));
            all.push(UnreadComment { span: start..from, keyword: has_keyword.then(near) });
        }
    }
    all.extend(mdx_comments(text, scan));
    all
}

/// The comments `{/* labspec … */}` outside of blocks.
fn mdx_comments(text: &str, scan: &Scan) -> Vec<UnreadComment> {
    let mut all = Vec::new();
    let mut from = 0;
    while let Some(start) = text.get(from..).and_then(|t| t.find(MDX_OPENS)).map(|i| from + i) {
        let begin = start + MDX_OPENS.len();
        from = begin;
        let Some(head) = text.get(begin..).and_then(head_of) else { continue };
        let last = scan.blocks.partition_point(|block| block.span.start <= start).checked_sub(1);
        let is_in_block =
            last.and_then(|i| scan.blocks.get(i)).is_some_and(|block| block.span.contains(&start));
        if is_in_block || !is_ours(&head) {
            continue;
        }
        let closed = text.get(begin..).and_then(|t| t.find(MDX_CLOSES)).map(|i| begin + i + MDX_CLOSES.len());
        from = closed.unwrap_or(text.len());
        all.push(UnreadComment { span: start..from, keyword: None });
    }
    all
}

/// The beginning of a comment.
struct CommentHead {
    /// Its first two words in lower case.
    name: String,
    keyword: String,
    /// Whether an object follows, and whether it has the keys of claims.
    is_object: bool,
    has_claims: bool,
}

fn head_of(inside: &str) -> Option<CommentHead> {
    let end = (0..=MAX_WORDS.min(inside.len())).rev().find(|i| inside.is_char_boundary(*i))?;
    let head = inside.get(..end)?.trim_start_matches(|c: char| c == '-' || c == '!' || c.is_whitespace());
    let mut words = head.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty());
    let name = words.next()?.to_lowercase();
    let object = head.find('{').and_then(|start| head.get(start..));
    Some(CommentHead {
        name,
        keyword: words.next().unwrap_or("").to_lowercase(),
        is_object: object.is_some(),
        has_claims: object.is_some_and(|object| CLAIM_KEYS.iter().any(|key| object.contains(key))),
    })
}

/// Keys of claims, as JSON writes them.
const CLAIM_KEYS: [&str; 5] = ["\"says\"", "\"measure\"", "\"runs\"", "\"table\"", "\"exact\""];

/// Whether a comment with these first words is meant for labspec. One with an object of claims is, whatever its first words are.
fn is_ours(CommentHead { name, keyword, is_object, has_claims }: &CommentHead) -> bool {
    let is_keyword = KEYWORDS.contains(&keyword.as_str());
    *has_claims
        || name == OURS
        || nearest(name, [OURS]).is_some() && name.len() > 4 && (is_keyword || *is_object)
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
