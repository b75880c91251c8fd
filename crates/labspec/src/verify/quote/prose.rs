//! The prose of a Markdown lesson by paragraphs and cells, without labs, quizzes, listings and tags. A fence without a
//! language, or of printed output, is kept verbatim.

use super::hidden::HiddenElement;
use super::html::{TEXT_SEPARATOR, mark, visible_text};
use super::table::{RenderedTable, Tables};
use crate::markdown::html::tags;
use crate::markdown::{self, Block, BlockKind};
use crate::source::{SourceMap, Text};
use crate::spec::{Lesson, Problem};
use pulldown_cmark::{CodeBlockKind, Event, Options, Parser, Tag, TagEnd};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

/// Languages of fences that contain the output of a program.
const OUTPUT_LANGUAGES: [&str; 5] = ["", "text", "txt", "console", "output"];

/// Maximum number of bytes that are read, including repeated reading after damaged fences.
const MAX_REREAD: usize = 64 << 20;

/// Extensions of CommonMark that pages use.
const OPTIONS: Options = Options::ENABLE_TABLES
    .union(Options::ENABLE_FOOTNOTES)
    .union(Options::ENABLE_STRIKETHROUGH)
    .union(Options::ENABLE_MATH)
    .union(Options::ENABLE_YAML_STYLE_METADATA_BLOCKS);

/// The pieces of rendered prose, in order.
pub(super) fn pieces(lesson: &Lesson) -> Vec<Text> {
    read(lesson).0
}

/// The tables of rendered prose, in order.
pub(super) fn tables(lesson: &Lesson) -> Vec<RenderedTable> {
    read(lesson).1
}

fn read(lesson: &Lesson) -> (Vec<Text>, Vec<RenderedTable>) {
    if lesson.file.path().to_ascii_lowercase().ends_with(".json") {
        return Default::default();
    }
    // More markup than the parser accepts, which is reported.
    let too_much = |p: &Problem| matches!(p, Problem::Fence(markdown::Problem::TooMuchMarkup));
    if lesson.problems.iter().any(too_much) {
        return Default::default();
    }
    let hidden = lesson.conventions.without_macros(lesson.file.text());
    let text = hidden.as_deref().unwrap_or(lesson.file.text());
    let mut reader = ProseReader {
        front_matter: &lesson.conventions.front_matter,
        text,
        blocks: &lesson.scan.blocks,
        pieces: Vec::new(),
        tables: Tables::default(),
        output: Vec::new(),
        open: empty(),
        html: false,
        hidden: HiddenElement::default(),
        inline: false,
        unseen: 0,
        notes: notes(text),
    };
    let (mut from, mut read) = (0, text.len());
    while let Some(resume) = reader.pass(from).filter(|&offset| offset > from && read < MAX_REREAD) {
        from = resume;
        read += text.len() - from;
    }
    (reader.pieces, reader.tables.all)
}

fn empty() -> Text {
    Text { value: String::new(), map: SourceMap::default() }
}

/// The footnotes to which the text, or another referenced footnote, refers. A page displays only these.
fn notes(text: &str) -> BTreeSet<String> {
    if !text.contains("[^") {
        return BTreeSet::new();
    }
    let mut inside: Option<String> = None;
    let mut refers: BTreeMap<Option<String>, Vec<String>> = BTreeMap::new();
    for event in Parser::new_ext(text, OPTIONS) {
        match event {
            Event::Start(Tag::FootnoteDefinition(name)) => inside = Some(name.to_string()),
            Event::End(TagEnd::FootnoteDefinition) => inside = None,
            Event::FootnoteReference(name) => {
                refers.entry(inside.clone()).or_default().push(name.to_string())
            }
            _ => {}
        }
    }
    let mut used = BTreeSet::new();
    let mut open = refers.remove(&None).unwrap_or_default();
    while let Some(name) = open.pop() {
        open.extend(refers.remove(&Some(name.clone())).unwrap_or_default());
        used.insert(name);
    }
    used
}

/// What a part of the file is.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Region {
    Prose,
    /// A fence of printed output.
    Output,
    /// Another fence.
    Hidden,
    FrontMatter,
}

struct ProseReader<'t> {
    text: &'t str,
    /// The keys of the front matter whose values are rendered.
    front_matter: &'t [String],
    blocks: &'t [Block],
    pieces: Vec<Text>,
    tables: Tables,
    /// The lines of the output that is being read, with their starts.
    output: Vec<(String, usize)>,
    /// The piece that is being read.
    open: Text,
    html: bool,
    hidden: HiddenElement,
    /// Nesting depth of footnotes without a reference and of struck-out words.
    unseen: usize,
    /// The referenced footnotes.
    notes: BTreeSet<String>,
    /// Whether the hidden element began within the current paragraph.
    inline: bool,
}

impl ProseReader<'_> {
    /// Reads from `from` on. Returns where to resume when a damaged fence contains the text after it. The function is long
    /// because it has one arm for each event of the Markdown parser.
    fn pass(&mut self, from: usize) -> Option<usize> {
        let mut region = Region::Prose;
        self.hidden.end();
        self.unseen = 0;
        for (event, range) in Parser::new_ext(self.text.get(from..)?, OPTIONS).into_offset_iter() {
            let range = range.start + from..range.end + from;
            match event {
                Event::Start(Tag::CodeBlock(kind)) => {
                    self.close();
                    let (rendered, resume) = self.fence(&kind, &range);
                    if resume.is_some() {
                        return resume;
                    }
                    region = if rendered { Region::Output } else { Region::Hidden };
                }
                Event::Start(Tag::MetadataBlock(_)) => region = Region::FrontMatter,
                Event::Text(ref part) if region == Region::FrontMatter => self.front_matter(part, range),
                Event::End(TagEnd::CodeBlock | TagEnd::MetadataBlock(_)) => {
                    self.close();
                    region = Region::Prose;
                    let output = std::mem::take(&mut self.output);
                    self.tables.printed(&output);
                }
                Event::Start(Tag::HtmlBlock) => {
                    self.close();
                    self.html = true;
                }
                Event::Start(Tag::FootnoteDefinition(ref name)) => {
                    self.close();
                    self.unseen += usize::from(!self.notes.contains(name.as_ref()));
                }
                Event::End(TagEnd::FootnoteDefinition) => {
                    self.close();
                    self.unseen = 0;
                }
                Event::Start(Tag::Strikethrough) => self.strike(&range, range.start, 1),
                Event::End(TagEnd::Strikethrough) => self.strike(&range, range.end.saturating_sub(1), -1),
                Event::Start(ref tag) if is_inline(tag) => {}
                Event::End(ref tag) if is_inline_end(tag) => {}
                Event::Start(_) | Event::End(_) | Event::Rule => {
                    self.table(&event, &range);
                    if std::mem::take(&mut self.inline) {
                        self.hidden.end();
                    }
                    self.close();
                }
                _ if region == Region::Hidden || self.unseen > 0 || self.is_taken(&range) => {}
                Event::Html(part) => self.add(&part, range),
                Event::InlineHtml(html) => self.inline_html(&html, &range),
                _ if self.hidden.is_on() => {}
                Event::Text(part) if region == Region::Output => self.lines(&part, range),
                Event::Text(part) => self.add(&part, range),
                Event::Code(part) | Event::InlineMath(part) | Event::DisplayMath(part) => {
                    self.inside(&part, range)
                }
                Event::SoftBreak | Event::HardBreak => self.whole(Some(' '), range),
                _ => {}
            }
        }
        self.close();
        None
    }

    /// Reads the values of the front matter that a page displays, one piece for each: `title: "A fall of 2 m"`.
    fn front_matter(&mut self, part: &str, range: Range<usize>) {
        if self.text.get(range.clone()) != Some(part) {
            return;
        }
        let mut offset = range.start;
        for line in part.split_inclusive('\n') {
            let pair = line
                .split_once(':')
                .filter(|(key, _)| self.front_matter.iter().any(|displayed| displayed == key.trim()));
            if let Some((key, value)) = pair {
                let displayed = value.trim().trim_matches(['"', '\'']);
                let start = offset + key.len() + 1 + value.find(displayed).unwrap_or(0);
                self.add(displayed, start..start + displayed.len());
                self.close();
            }
            offset += line.len();
        }
    }

    /// Processes the events of a table.
    fn table(&mut self, event: &Event<'_>, range: &Range<usize>) {
        match event {
            Event::Start(Tag::Table(_)) => self.tables.begin(),
            Event::End(TagEnd::TableCell) => {
                let source = self.text.get(range.clone()).unwrap_or("");
                self.tables.cell(&self.open.value, source, range.clone());
            }
            Event::End(TagEnd::TableHead) => self.tables.end_head(),
            Event::End(TagEnd::TableRow) => self.tables.end_row(),
            _ => {}
        }
    }

    /// Whether the text of a fence is rendered, and where to resume if the fence ends earlier than Markdown determines.
    fn fence(&self, kind: &CodeBlockKind<'_>, range: &Range<usize>) -> (bool, Option<usize>) {
        let i = self.blocks.partition_point(|b| b.span.start < range.start);
        let Some(block) = self.blocks.get(i).filter(|b| b.span.start == range.start) else {
            return match kind {
                CodeBlockKind::Indented => (true, None),
                CodeBlockKind::Fenced(info) => {
                    (is_output(info.split_whitespace().next().unwrap_or("")), None)
                }
            };
        };
        let resume = (block.span.end < range.end).then_some(block.span.end);
        match &block.kind {
            BlockKind::Code { language, file } => (is_output(language) && file.is_none(), resume),
            _ => (false, resume),
        }
    }

    /// Whether a range belongs to a lab or a quiz that Markdown reads as prose.
    fn is_taken(&self, range: &Range<usize>) -> bool {
        let i = self.blocks.partition_point(|b| b.span.start <= range.start);
        let before = i.checked_sub(1).and_then(|i| self.blocks.get(i));
        before.is_some_and(|b| !matches!(b.kind, BlockKind::Code { .. }) && range.start < b.span.end)
    }

    /// Processes a tag within a line.
    fn inline_html(&mut self, html: &str, range: &Range<usize>) {
        for tag in tags(html) {
            let was_on = self.hidden.is_on();
            if self.hidden.take_tag(&tag) {
                self.inline |= !was_on;
            } else {
                self.whole(mark(&tag).filter(|c| *c != TEXT_SEPARATOR), range.clone());
            }
        }
    }

    /// Words between double tildes are struck out; single tildes are characters.
    fn strike(&mut self, range: &Range<usize>, offset: usize, by: isize) {
        if self.text.get(range.clone()).is_some_and(|text| text.starts_with("~~")) {
            self.unseen = self.unseen.saturating_add_signed(by);
        } else if self.unseen == 0 && !self.hidden.is_on() {
            self.whole(Some('~'), offset..offset + 1);
        }
    }

    fn close(&mut self) {
        let mut text = std::mem::replace(&mut self.open, empty());
        if std::mem::take(&mut self.html) {
            text = visible_text(&text, &mut self.hidden);
        }
        if !text.value.is_empty() {
            self.pieces.push(text);
        }
    }

    /// Appends the text of a range: its bytes, or their Markdown replacement.
    fn add(&mut self, part: &str, range: Range<usize>) {
        self.open.value.push_str(part);
        if self.text.get(range.clone()) == Some(part) {
            self.open.map.push_verbatim(range);
        } else {
            self.open.map.push_whole(part.len(), range);
        }
    }

    /// Appends code or a formula, whose range includes its delimiters.
    fn inside(&mut self, part: &str, range: Range<usize>) {
        let outer = self.text.get(range.clone()).unwrap_or("");
        let start = outer.find(part).map(|i| range.start + i);
        let inner = start.map_or(range, |start| start..start + part.len());
        self.add(part, inner);
    }

    fn whole(&mut self, rendered: Option<char>, range: Range<usize>) {
        if let Some(c) = rendered {
            self.open.value.push(c);
            self.open.map.push_whole(c.len_utf8(), range);
        }
    }

    /// Appends printed output: every line is a separate piece.
    fn lines(&mut self, part: &str, range: Range<usize>) {
        if self.text.get(range.clone()) != Some(part) {
            self.add(part, range);
            self.close();
            return;
        }
        let mut offset = range.start;
        for line in part.split_inclusive('\n') {
            self.add(line, offset..offset + line.len());
            self.close();
            self.output.push((line.trim_end().to_string(), offset));
            offset += line.len();
        }
    }
}

fn is_output(language: &str) -> bool {
    OUTPUT_LANGUAGES.contains(&language.to_ascii_lowercase().as_str())
}

/// Inline tags, which do not separate text.
fn is_inline(tag: &Tag<'_>) -> bool {
    matches!(tag, Tag::Emphasis | Tag::Strong | Tag::Link { .. } | Tag::Superscript | Tag::Subscript)
}

fn is_inline_end(tag: &TagEnd) -> bool {
    matches!(tag, TagEnd::Emphasis | TagEnd::Strong | TagEnd::Link | TagEnd::Superscript | TagEnd::Subscript)
}
