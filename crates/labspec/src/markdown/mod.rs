//! The fences of a Markdown lesson with exact spans, from files as authors really send them.
//!
//! CommonMark (through pulldown-cmark) decides what a fence is. Then every block is examined for damage by text editors,
//! chat windows and converters: missing closing lines, so that a fence contains the rest of the file; JSON or a listing on
//! the opening line; typographic quotes. Damage is reported at its location, and reading continues after it, so that one
//! missing line does not hide ten errors.

mod extent;
mod fence;
pub(crate) mod html;
mod loose;
mod opener;
pub(crate) mod tex;

pub(crate) use extent::is_typographic;
pub use opener::Opener;

use crate::source::{SourceFile, SourceMap, Text};
use opener::opener;
use pulldown_cmark::{CodeBlockKind, Event, Parser, Tag, TagEnd};
use std::ops::Range;

/// Maximum number of blocks in a lesson.
pub const MAX_BLOCKS: usize = 2000;
/// Maximum number of bytes that are read again after damage. Every damaged fence requires another pass over the text after
/// it.
const MAX_REREAD: usize = 64 << 20;
/// Maximum number of markup characters in a lesson: the Markdown parser stores about sixty bytes for each.
pub(crate) const MAX_MARKUP: usize = 4 << 20;

/// The kinds of labs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LabKind {
    /// A run of a model.
    Simulation,
    /// The same run under several integrators.
    Comparison,
}

impl LabKind {
    /// All kinds.
    pub const ALL: [LabKind; 2] = [LabKind::Simulation, LabKind::Comparison];

    /// The word after `lab` in a fence.
    pub fn word(self) -> &'static str {
        self.fence().trim_start_matches("lab ")
    }

    /// The opening words of a fence.
    pub const fn fence(self) -> &'static str {
        match self {
            LabKind::Simulation => "lab simlab",
            LabKind::Comparison => "lab integrators",
        }
    }

    /// The kind that a word names.
    pub fn named(word: &str) -> Option<LabKind> {
        LabKind::ALL.into_iter().find(|kind| kind.word() == word)
    }
}

/// The content of a fence.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum BlockKind {
    /// A lab.
    Lab(LabKind),
    /// A widget of another tool: `lab` and its name.
    Widget(String),
    /// A quiz.
    Quiz,
    /// A listing.
    Code {
        /// First word of the info string, such as `python`.
        language: String,
        /// The displayed file of the course, from `file=PATH`.
        file: Option<String>,
    },
}

/// A fence.
#[derive(Clone, Debug, PartialEq)]
pub struct Block {
    /// Its content.
    pub kind: BlockKind,
    /// Bytes of the file, including fence lines.
    pub span: Range<usize>,
    /// Bytes of the opening line, up to where JSON or a listing begins on it.
    pub info: Range<usize>,
    /// The text inside, without the prefixes of quotes and lists.
    pub body: Text,
    /// Whether its end is known: it is closed, and not truncated.
    pub whole: bool,
}

/// A link, or an image.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Link {
    /// Its target, as written.
    pub target: String,
    /// Bytes of the file.
    pub span: Range<usize>,
    /// Whether it is an image.
    pub image: bool,
}

/// A problem of the fences of a lesson. `lint` contains the messages and the repairs.
#[derive(Clone, Debug, PartialEq)]
pub enum Problem {
    /// The number of markup characters exceeds the limit.
    TooMuchMarkup,
    /// The number of fences, or of damaged ones, exceeds the limit; nothing was read from this byte on.
    TooManyBlocks(usize),
    /// A fence of another language that contains the JSON of a lab or a quiz.
    Listed {
        /// Its opening line.
        open: Opener,
        /// The kind of its content.
        right: &'static str,
    },
    /// A fence that was intended to be of another kind.
    Misspelt {
        /// Its opening line.
        open: Opener,
        /// The intended kind.
        right: String,
    },
    /// JSON or code on the opening line.
    TextOnLine {
        /// The opening line.
        open: Opener,
        /// The text after its kind.
        rest: Range<usize>,
        /// The content of the fence.
        kind: BlockKind,
    },
    /// The closing line is missing.
    Unclosed {
        /// The opening line.
        open: Opener,
        /// Where the content ends.
        end: usize,
        /// Where the lesson continues.
        resume: Option<usize>,
        /// The content of the fence.
        kind: BlockKind,
    },
    /// A lab or a quiz without any fence.
    Missing {
        /// Its bytes.
        object: Range<usize>,
        /// Its kind.
        kind: BlockKind,
    },
    /// A fence that Markdown does not recognize.
    Unseen(Opener),
    /// A fence that is indented like code.
    Indented(Opener),
}

/// The blocks of a lesson in order, and their problems.
#[derive(Clone, Debug, Default)]
pub struct Scan {
    /// The blocks.
    pub blocks: Vec<Block>,
    /// The problems.
    pub problems: Vec<Problem>,
    /// HTML in the prose.
    pub html: Vec<Range<usize>>,
    /// Paragraphs of prose, including their markup.
    pub paragraphs: Vec<Range<usize>>,
    /// Inline code in prose.
    pub inline_code: Vec<Range<usize>>,
    /// Headings, including their marks.
    pub headings: Vec<Range<usize>>,
    /// Links and images, in order.
    pub links: Vec<Link>,
    /// Every range that is code and therefore not prose.
    code: Vec<Range<usize>>,
}

/// Finds all fences of a lesson.
pub fn scan(file: &SourceFile) -> Scan {
    let text = file.text();
    let mut scan = Scan::default();
    let is_markup = |b: u8| b"[]()*_~`<>&!|\\".contains(&b);
    if text.bytes().filter(|&b| is_markup(b)).take(MAX_MARKUP + 1).count() > MAX_MARKUP {
        scan.problems.push(Problem::TooMuchMarkup);
        return scan;
    }
    let (mut from, mut read) = (0, 0);
    loop {
        read += text.len() - from;
        if scan.blocks.len() >= MAX_BLOCKS || read > MAX_REREAD + text.len() {
            scan.problems.push(Problem::TooManyBlocks(from));
            break;
        }
        match pass(text, from, &mut scan) {
            Some(resume) if resume > from => from = resume,
            _ => break,
        }
    }
    loose::find(text, &mut scan);
    scan.blocks.sort_by_key(|b| b.span.start);
    scan
}

/// One pass from `from`. Returns where to resume if a damaged fence was truncated.
fn pass(text: &str, from: usize, scan: &mut Scan) -> Option<usize> {
    let mut raw: Option<(Range<usize>, Text)> = None;
    for (event, range) in Parser::new(text.get(from..)?).into_offset_iter() {
        let range = range.start + from..range.end + from;
        match event {
            Event::Start(Tag::CodeBlock(CodeBlockKind::Indented)) => {
                loose::indented_fence(text, range.clone(), scan);
                scan.code.push(range);
            }
            Event::Start(Tag::CodeBlock(CodeBlockKind::Fenced(_))) => {
                raw = Some((range, Text { value: String::new(), map: SourceMap::default() }));
            }
            Event::Text(part) => {
                if let Some((_, body)) = &mut raw {
                    append(text, body, &part, range);
                }
            }
            Event::End(TagEnd::CodeBlock) => {
                if let Some((span, body)) = raw.take() {
                    let resume = block(text, span, body, scan);
                    if resume.is_some() || scan.blocks.len() >= MAX_BLOCKS {
                        return resume.or(Some(range.end));
                    }
                }
            }
            Event::Start(tag @ (Tag::Paragraph | Tag::HtmlBlock)) => {
                if let Some(resume) = loose::unseen_fence(text, range.clone(), scan) {
                    return Some(resume);
                }
                if tag == Tag::Paragraph {
                    scan.paragraphs.push(range);
                }
            }
            Event::Start(Tag::Heading { .. }) => scan.headings.push(range),
            Event::Start(Tag::Link { dest_url, .. }) => {
                scan.links.push(Link { target: dest_url.to_string(), span: range, image: false });
            }
            Event::Start(Tag::Image { dest_url, .. }) => {
                scan.links.push(Link { target: dest_url.to_string(), span: range, image: true });
            }
            Event::Code(_) => scan.inline_code.push(range),
            // A comment over several lines is reported line by line.
            Event::Html(_) | Event::InlineHtml(_) => match scan.html.last_mut() {
                Some(last) if last.end == range.start => last.end = range.end,
                _ => scan.html.push(range),
            },
            _ => {}
        }
    }
    None
}

/// Appends a piece of a block: the bytes of the file, or their Markdown replacement (tabs, line ends).
fn append(text: &str, body: &mut Text, part: &str, range: Range<usize>) {
    // The parser omits the `\r` of a line end. `\n` represents both, so that no position is between them.
    let returned =
        range.start.checked_sub(1).is_some_and(|offset| text.get(offset..range.start) == Some("\r"));
    if let Some(rest) = part.strip_prefix('\n').filter(|_| returned) {
        body.value.push('\n');
        body.map.push_whole(1, range.start - 1..range.start + 1);
        if !rest.is_empty() {
            append(text, body, rest, range.start + 1..range.end);
        }
        return;
    }
    body.value.push_str(part);
    if text.get(range.clone()) == Some(part) {
        body.map.push_verbatim(range);
    } else {
        body.map.push_whole(part.len(), range);
    }
}

/// Adds a fence. Returns where to resume when it was truncated.
fn block(text: &str, span: Range<usize>, body: Text, scan: &mut Scan) -> Option<usize> {
    let Some(open) = opener(text, span.start) else {
        scan.code.push(span);
        return None;
    };
    let closed = fence::is_closed(text, &span, &open);
    let body = with_first_line(text, &open, body);
    let mut kind = open.kind();
    if let Some((right, meant)) = fence::meant(&open, &kind, &body.value) {
        scan.problems.push(Problem::Misspelt { open: open.clone(), right: right.to_string() });
        kind = meant;
    } else if let Some(right) = fence::listed(&kind, &body.value) {
        scan.problems.push(Problem::Listed { open: open.clone(), right });
    }
    let cut = match &kind {
        BlockKind::Code { .. } => fence::cut_listing(&body.value, &open, closed),
        _ => fence::cut_json(&body.value, &open, closed),
    };
    let mut body = body;
    let mut span = span;
    if let Some(first) = open.rest.clone() {
        scan.problems.push(Problem::TextOnLine { open: open.clone(), rest: first, kind: kind.clone() });
    }
    let mut resume = None;
    if let Some(cut) = cut {
        let end = body.map.span(0..cut.end).end;
        resume = cut.resume.map(|offset| line_start(text, body.map.span(offset..offset).start));
        scan.problems.push(Problem::Unclosed { open: open.clone(), end, resume, kind: kind.clone() });
        span.end = resume.unwrap_or(span.end);
        body.value.truncate(cut.end);
        body.map = SourceMap::verbatim(0..cut.end).then(&body.map);
    } else if !closed {
        let end = body.map.span(0..body.value.trim_end().len()).end.max(open.line.end);
        scan.problems.push(Problem::Unclosed { open: open.clone(), end, resume: None, kind: kind.clone() });
    }
    scan.code.push(span.clone());
    scan.blocks.push(Block { kind, span, info: open.head, body, whole: closed && resume.is_none() });
    resume
}

/// The body, preceded by the text on the opening line, if there is any.
fn with_first_line(text: &str, open: &Opener, body: Text) -> Text {
    let Some(rest) = open.rest.clone() else { return body };
    let mut whole = Text { value: String::new(), map: SourceMap::default() };
    append(text, &mut whole, text.get(rest.clone()).unwrap_or(""), rest.clone());
    append(text, &mut whole, "\n", rest.end..(rest.end + 1).min(text.len()));
    whole.value.push_str(&body.value);
    for piece in body.map.pieces() {
        if piece.verbatim {
            whole.map.push_verbatim(piece.origin.clone());
        } else {
            whole.map.push_whole(piece.derived.len(), piece.origin.clone());
        }
    }
    whole
}

/// The start of the line that contains a byte.
fn line_start(text: &str, offset: usize) -> usize {
    text.get(..offset).and_then(|before| before.rfind('\n')).map_or(0, |newline| newline + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scanned(text: &str) -> Scan {
        scan(&SourceFile::new("t.md", text))
    }

    #[test]
    fn fences_in_quotes_and_lists_lose_their_prefixes_and_keep_their_places() {
        let text = "> ```lab simlab\n> {\"model\":\n>  \"ball\"}\n> ```\n\n1. x\n\n   ```quiz\n   {\"id\": 1}\n   ```\r\n";
        let scan = scanned(text);
        assert_eq!(scan.problems, []);
        assert_eq!(scan.blocks[0].body.value, "{\"model\":\n \"ball\"}\n");
        let offset = scan.blocks[0].body.value.find("ball").unwrap();
        assert_eq!(&text[scan.blocks[0].body.span_of(offset..offset + 4)], "ball");
        assert_eq!(scan.blocks[1].body.value.trim(), "{\"id\": 1}");
        assert_eq!(&text[scan.blocks[1].body.span_of(0..9)], "{\"id\": 1}");
    }

    #[test]
    fn a_longer_fence_around_a_fence_is_valid() {
        let scan = scanned("````markdown\n```lab simlab\n{}\n```\n````\n\n~~~\n```quiz\n~~~\n");
        assert_eq!(scan.problems, []);
        assert_eq!(scan.blocks.len(), 2);
    }

    #[test]
    fn a_missing_closing_line_hides_no_block() {
        let scan = scanned(
            "```lab simlab\n{\"model\": \"a\"}\nSome prose.\n\n```quiz\n{\"id\": \"q\"}\n```\n\n```lab\n{}\n```\n",
        );
        assert!(matches!(scan.problems[..], [Problem::Unclosed { .. }]));
        let kinds: Vec<_> = scan.blocks.iter().map(|b| b.kind.clone()).collect();
        let lab = BlockKind::Lab(LabKind::Simulation);
        assert_eq!(kinds, [lab.clone(), BlockKind::Quiz, lab]);
        assert_eq!(scan.blocks[0].body.value.trim(), "{\"model\": \"a\"}");
    }

    #[test]
    fn prose_swallowed_by_a_lab_is_cut_off_at_the_end_of_its_object() {
        let scan = scanned("```lab\n{\"model\": \"a\"}\nSome prose.\n\n```\ncode\n```\n");
        assert!(matches!(scan.problems[0], Problem::Unclosed { .. }));
        assert_eq!(scan.blocks[0].body.value.trim(), "{\"model\": \"a\"}");
        assert_eq!(scan.blocks[1].body.value, "code\n");
    }

    #[test]
    fn hostile_texts_cause_no_panic() {
        let many = "```lab {\n".repeat(3000);
        let scan = scanned(&many);
        assert!(scan.blocks.len() <= MAX_BLOCKS);
        assert!(scan.problems.iter().any(|p| matches!(p, Problem::TooManyBlocks(_))));
        for text in [
            "```",
            "```lab",
            "```lab {",
            "```quiz\n\u{feff}",
            "> ```lab\n```",
            "{\"",
            "{“",
            "```lab `x` {}",
            "\u{feff}```lab\n{}\n```",
        ] {
            scanned(text);
        }
    }
}
