//! Compares displayed lines with printed ones, word by word.

use super::decimal::{Segment, segments};
use std::borrow::Cow;
use std::ops::Range;

/// The maximum number of differences that are described for one output.
pub(super) const MAX_DIFFERENCES: usize = 20;

/// A word of the lesson.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Word<'t> {
    pub(super) text: Cow<'t, str>,
    /// Its bytes in the file.
    pub(super) span: Range<usize>,
}

impl Word<'_> {
    /// The bytes in the file of a part of the word.
    fn part(&self, range: &Range<usize>) -> Range<usize> {
        match self.span.len() == self.text.len() {
            true => self.span.start + range.start..self.span.start + range.end,
            false => self.span.clone(),
        }
    }
}

/// A displayed line, or a row of a table.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct DisplayedLine<'t> {
    pub(super) words: Vec<Word<'t>>,
    /// Its bytes in the file.
    pub(super) span: Range<usize>,
}

/// What differs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum DifferenceKind {
    /// A number or words are others.
    Changed,
    /// Words are printed and not displayed.
    MissingWords,
    /// Words are displayed and not printed.
    ExtraWords,
    /// Lines are printed and not displayed: their number.
    MissingLines(usize),
    /// A line is displayed and not printed.
    ExtraLine,
}

/// A difference, and its place in the file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Difference {
    pub(super) kind: DifferenceKind,
    pub(super) span: Range<usize>,
    pub(super) displayed: String,
    pub(super) printed: String,
}

/// The first differences, and the number of the others.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Differences {
    pub(super) listed: Vec<Difference>,
    pub(super) more: usize,
}

impl Differences {
    fn add(&mut self, kind: DifferenceKind, span: Range<usize>, displayed: &str, printed: &str) {
        if self.listed.len() >= MAX_DIFFERENCES {
            self.more += 1;
            return;
        }
        let [displayed, printed] = [displayed, printed].map(clip);
        self.listed.push(Difference { kind, span, displayed, printed });
    }
}

/// The maximum length of a quoted text, in characters.
const MAX_QUOTED: usize = 120;

/// The text, or its start.
pub(super) fn clip(text: &str) -> String {
    match text.char_indices().nth(MAX_QUOTED) {
        Some((end, _)) => format!("{}…", text.get(..end).unwrap_or("")),
        None => text.to_string(),
    }
}

/// The lines of a text without spaces at their ends, and without empty lines around them.
pub(super) fn trimmed_lines(text: &str) -> Vec<&str> {
    let lines: Vec<&str> = text.lines().map(str::trim_end).collect();
    let is_text = |line: &&str| !line.is_empty();
    let start = lines.iter().position(is_text).unwrap_or(lines.len());
    let end = lines.iter().rposition(is_text).map_or(start, |last| last + 1);
    lines.get(start..end).map(<[&str]>::to_vec).unwrap_or_default()
}

/// The bytes of each word of a text.
pub(super) fn word_ranges(text: &str) -> impl Iterator<Item = Range<usize>> {
    text.split_whitespace().map(move |word| {
        let start = word.as_ptr().addr() - text.as_ptr().addr();
        start..start + word.len()
    })
}

/// Compares lines by their words. `start` is the place in the file before the first line.
pub(super) fn compare_lines(
    displayed: &[DisplayedLine<'_>],
    printed: &[Vec<&str>],
    start: usize,
) -> Differences {
    let same = |line: &DisplayedLine<'_>, printed: &[&str]| {
        line.words.len() == printed.len()
            && line.words.iter().zip(printed).all(|(word, printed)| is_same_word(&word.text, printed))
    };
    let mut differences = Differences::default();
    let head = displayed.iter().zip(printed).take_while(|(line, p)| same(line, p)).count();
    let shorter = displayed.len().min(printed.len());
    let backwards = displayed.iter().rev().zip(printed.iter().rev()).take(shorter - head);
    let tail = backwards.take_while(|(line, p)| same(line, p)).count();
    let displayed_middle = displayed.get(head..displayed.len() - tail).unwrap_or_default();
    let printed_middle = printed.get(head..printed.len() - tail).unwrap_or_default();
    for (line, printed) in displayed_middle.iter().zip(printed_middle) {
        compare_words(line, printed, &mut differences);
    }
    for line in displayed_middle.iter().skip(printed_middle.len()) {
        differences.add(DifferenceKind::ExtraLine, line.span.clone(), &join(&line.words), "");
    }
    let missing = printed_middle.get(displayed_middle.len()..).unwrap_or_default();
    if let Some(first) = missing.first() {
        let before = head + displayed_middle.len();
        let place = before.checked_sub(1).and_then(|i| displayed.get(i)).map_or(start, |line| line.span.end);
        let kind = DifferenceKind::MissingLines(missing.len());
        differences.add(kind, place..place, "", &first.join(" "));
    }
    differences
}

fn join(words: &[Word<'_>]) -> String {
    words.iter().map(|word| &*word.text).collect::<Vec<_>>().join(" ")
}

/// Compares the words of a line.
fn compare_words(line: &DisplayedLine<'_>, printed: &[&str], differences: &mut Differences) {
    let words = &line.words;
    let same = |word: &Word<'_>, printed: &&str| is_same_word(&word.text, printed);
    let head = words.iter().zip(printed).take_while(|(word, p)| same(word, p)).count();
    let shorter = words.len().min(printed.len());
    let backwards = words.iter().rev().zip(printed.iter().rev()).take(shorter - head);
    let tail = backwards.take_while(|(word, p)| same(word, p)).count();
    let displayed_middle = words.get(head..words.len() - tail).unwrap_or_default();
    let printed_middle = printed.get(head..printed.len() - tail).unwrap_or_default();
    if displayed_middle.len() == printed_middle.len() {
        for (word, printed) in displayed_middle.iter().zip(printed_middle) {
            compare_word(word, printed, differences);
        }
        return;
    }
    let text = printed_middle.join(" ");
    match (displayed_middle.first(), displayed_middle.last()) {
        (Some(first), Some(last)) => {
            let kind = match printed_middle.is_empty() {
                true => DifferenceKind::ExtraWords,
                false => DifferenceKind::Changed,
            };
            differences.add(kind, first.span.start..last.span.end, &join(displayed_middle), &text);
        }
        _ => {
            let before = head.checked_sub(1).and_then(|i| words.get(i));
            let place = before.map_or(line.span.start, |word| word.span.end);
            differences.add(DifferenceKind::MissingWords, place..place, "", &text);
        }
    }
}

/// Compares two words: each number alone if only numbers differ.
fn compare_word(word: &Word<'_>, printed: &str, differences: &mut Differences) {
    let [parts, printed_parts] = [&word.text, printed].map(segments);
    let numbers_only = parts.len() == printed_parts.len()
        && parts.iter().zip(&printed_parts).all(|(a, b)| match (&a.number, &b.number) {
            (None, None) => text_of(&word.text, a) == text_of(printed, b),
            (Some(_), Some(_)) => true,
            _ => false,
        });
    if !numbers_only {
        if !is_same_word(&word.text, printed) {
            differences.add(DifferenceKind::Changed, word.span.clone(), &word.text, printed);
        }
        return;
    }
    for (a, b) in parts.iter().zip(&printed_parts).filter(|(a, b)| !is_same_number(a, b)) {
        let [displayed, printed] = [text_of(&word.text, a), text_of(printed, b)];
        differences.add(DifferenceKind::Changed, word.part(&a.range), displayed, printed);
    }
}

fn text_of<'t>(word: &'t str, segment: &Segment) -> &'t str {
    word.get(segment.range.clone()).unwrap_or("")
}

fn is_same_number(displayed: &Segment, printed: &Segment) -> bool {
    match (&displayed.number, &printed.number) {
        (Some(a), Some(b)) => a.is_rounding_of(b),
        (a, b) => a.is_none() && b.is_none(),
    }
}

/// Whether a displayed word is the printed one, with its numbers rounded.
fn is_same_word(displayed: &str, printed: &str) -> bool {
    if displayed == printed {
        return true;
    }
    let [a, b] = [displayed, printed].map(segments);
    a.len() == b.len()
        && a.iter().zip(&b).all(|(x, y)| {
            let is_equal_text = x.number.is_some() || text_of(displayed, x) == text_of(printed, y);
            is_same_number(x, y) && is_equal_text
        })
}
