//! Finds the listings of a lesson whose output is displayed below them.

use super::compare::{DisplayedLine, Word, word_ranges};
use super::table::read_table;
use crate::markdown::{Block, BlockKind};
use crate::source::Text;
use crate::spec::Lesson;
use std::ops::Range;
use std::path::{Component, Path};

/// The languages of listings that can be run.
const PYTHON: [&str; 3] = ["python", "python3", "py"];
/// The languages of outputs; the first one needs a line such as "Output:" above it.
const OUTPUTS: [&str; 5] = ["", "text", "txt", "console", "output"];
/// The first words of the line above an output, in the languages of lessons.
const LABELS: [&str; 7] = ["output", "ausgabe", "sortie", "salida", "uscita", "输出", "输出结果"];
/// The path of a listing without `file=`.
const UNNAMED: &str = "listing.py";

/// A Python listing with the output that the lesson displays below it.
#[derive(Debug)]
pub struct Listing<'l> {
    /// Its number among the listings with an output, from 1.
    pub number: usize,
    /// Its code.
    pub code: &'l Text,
    /// The path of its `file=`.
    pub file: Option<&'l str>,
    /// Bytes of its opening line.
    pub info: Range<usize>,
    /// The displayed output.
    pub output: DisplayedOutput<'l>,
}

/// The output that a lesson displays.
#[derive(Debug)]
pub enum DisplayedOutput<'l> {
    /// A fence, and the bytes of its text in the file.
    Block(&'l Block, &'l str),
    /// A table.
    Table(OutputTable<'l>),
}

/// A table that displays an output.
#[derive(Debug)]
pub struct OutputTable<'l> {
    pub(super) rows: Vec<DisplayedLine<'l>>,
    pub(super) span: Range<usize>,
}

impl Listing<'_> {
    /// Its name in the ledger: `listing #1`.
    pub fn name(&self) -> String {
        format!("listing #{}", self.number)
    }

    /// The path at which it is written, or `None` if its `file=` leaves the folder of the run.
    pub fn path(&self) -> Option<&str> {
        let path = self.file.unwrap_or(UNNAMED);
        let is_inside = |c: Component<'_>| matches!(c, Component::Normal(_));
        let is_plain = !path.contains(['\\', ':', '\0']) && !path.ends_with('/') && !path.is_empty();
        (is_plain && Path::new(path).components().all(is_inside)).then_some(path)
    }

    /// The text of the displayed output; `None` for a table.
    pub fn displayed_text(&self) -> Option<&str> {
        match &self.output {
            DisplayedOutput::Block(block, _) => Some(&block.body.value),
            DisplayedOutput::Table(_) => None,
        }
    }

    /// The bytes of the displayed output.
    pub fn span(&self) -> Range<usize> {
        match &self.output {
            DisplayedOutput::Block(block, _) => block.span.clone(),
            DisplayedOutput::Table(table) => table.span.clone(),
        }
    }
}

/// The listings of a lesson with an output, in order.
pub fn pair_listings(lesson: &Lesson) -> Vec<Listing<'_>> {
    let text = lesson.file.text();
    let mut all = Vec::new();
    let mut blocks = lesson.scan.blocks.iter().peekable();
    while let Some(block) = blocks.next() {
        let BlockKind::Code { language, file } = &block.kind else { continue };
        if !PYTHON.contains(&language.to_ascii_lowercase().as_str()) || !block.whole {
            continue;
        }
        let next = blocks.peek().copied();
        let end = next.map_or(text.len(), |next| next.span.start);
        let between = text.get(block.span.end..end).unwrap_or("");
        let output = displayed_output(between, block.span.end, next.map(|next| (next, raw(text, next))));
        let Some(output) = output else { continue };
        let (number, file) = (all.len() + 1, file.as_deref());
        all.push(Listing { number, code: &block.body, file, info: block.info.clone(), output });
    }
    all
}

/// The bytes of the text of a fence.
fn raw<'l>(text: &'l str, block: &Block) -> &'l str {
    text.get(block.body.span()).unwrap_or("")
}

/// The output after a listing: a fence directly below it or below a line such as "Output:", or a table below such a line.
fn displayed_output<'l>(
    between: &'l str,
    offset: usize,
    next: Option<(&'l Block, &'l str)>,
) -> Option<DisplayedOutput<'l>> {
    let bare = |line: &str| line.trim_matches([' ', '\t', '\r', '\n', '>', '*', '_']).to_lowercase();
    let mut at = 0;
    let mut label = None;
    for line in between.split_inclusive('\n') {
        let words = bare(line);
        at += line.len();
        if words.is_empty() {
            continue;
        }
        let is_label = words.ends_with([':', '：']) && LABELS.iter().any(|label| words.starts_with(label));
        match is_label {
            true => label = Some(at),
            false => return None,
        }
        break;
    }
    let rest = between.get(label.unwrap_or(at)..).unwrap_or("");
    if rest.lines().all(|line| bare(line).is_empty()) {
        return next
            .filter(|(next, _)| is_output(next, label.is_some()))
            .map(|(next, raw)| DisplayedOutput::Block(next, raw));
    }
    let (rows, span) = read_table(rest, offset + label?)?;
    Some(DisplayedOutput::Table(OutputTable { rows, span }))
}

fn is_output(block: &Block, is_labelled: bool) -> bool {
    let BlockKind::Code { language, file: None } = &block.kind else { return false };
    let language = language.to_ascii_lowercase();
    block.whole && OUTPUTS.contains(&language.as_str()) && (is_labelled || !language.is_empty())
}

/// The lines of a displayed text, without empty ones around them.
pub(super) fn displayed_lines(body: &Text) -> Vec<DisplayedLine<'_>> {
    let mut all: Vec<DisplayedLine<'_>> = Vec::new();
    let mut at = 0;
    for line in body.value.split_inclusive('\n') {
        let words: Vec<Word<'_>> = word_ranges(line)
            .map(|range| Word {
                text: line.get(range.clone()).unwrap_or("").into(),
                span: body.span_of(at + range.start..at + range.end),
            })
            .collect();
        let span = body.span_of(at..at + line.trim_end().len());
        if !(words.is_empty() && all.is_empty()) {
            all.push(DisplayedLine { words, span });
        }
        at += line.len();
    }
    while all.last().is_some_and(|line| line.words.is_empty()) {
        all.pop();
    }
    all
}
