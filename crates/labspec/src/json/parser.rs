//! The state of the parser: the text, the current position, the open brackets, and the reported errors.

use super::MAX_ERRORS;
use super::problem::{self, Mistake, Problem, RepeatedError, TextChange};
use crate::source::SourceMap;
use labspec_finding::order;
use std::ops::Range;

/// Parsing ends because a limit is reached, which is reported.
pub(super) struct LimitReached;

/// The text, the current position, and the problems so far.
pub(super) struct JsonParser<'a> {
    pub(super) text: &'a str,
    pub(super) below: &'a SourceMap,
    pub(super) offset: usize,
    /// The open brackets, with their positions.
    pub(super) open: Vec<(char, usize)>,
    pub(super) values: usize,
    /// Numbers of `{ } [ ]` in the text outside of strings, adjusted for repaired brackets.
    pub(super) brackets: [i64; 4],
    pub(super) broken: bool,
    /// Spans are bytes of `text`.
    problems: Vec<Problem>,
    pub(super) changes: [Vec<Vec<TextChange>>; 3],
    /// Problems whose spans are bytes of the file.
    pub(super) placed: Vec<Problem>,
    /// Whether the end of the text inside brackets was reported.
    pub(super) ended: bool,
    pub(super) comment_open: bool,
    next_quote: Option<usize>,
    next_line: usize,
}

impl<'a> JsonParser<'a> {
    pub(super) fn new(text: &'a str, below: &'a SourceMap) -> JsonParser<'a> {
        JsonParser {
            text,
            below,
            offset: 0,
            open: Vec::new(),
            values: 0,
            brackets: count(text),
            broken: false,
            problems: Vec::new(),
            changes: [Vec::new(), Vec::new(), Vec::new()],
            placed: Vec::new(),
            ended: false,
            comment_open: false,
            next_quote: Some(0),
            next_line: 0,
        }
    }

    // Lookahead and movement.

    pub(super) fn rest(&self) -> &'a str {
        self.text.get(self.offset..).unwrap_or("")
    }

    pub(super) fn peek(&self) -> Option<char> {
        self.rest().chars().next()
    }

    pub(super) fn starts(&self, with: &str) -> bool {
        self.rest().starts_with(with)
    }

    pub(super) fn bump(&mut self) {
        self.offset += self.peek().map_or(0, char::len_utf8);
    }

    /// The end of the current line.
    pub(super) fn line_end(&mut self) -> usize {
        self.line_from(self.offset)
    }

    /// The end of the line that contains `from`. Calls must not go back to an earlier line.
    pub(super) fn line_from(&mut self, from: usize) -> usize {
        if self.next_line <= from {
            let rest = self.text.get(from..).unwrap_or("");
            self.next_line = rest.find(['\n', '\r']).map_or(self.text.len(), |i| from + i);
        }
        self.next_line
    }

    /// The first double quote at or after `from`. Calls must not decrease `from`.
    pub(super) fn quote_from(&mut self, from: usize) -> Option<usize> {
        if self.next_quote.is_some_and(|q| q < from || q == 0) {
            self.next_quote = self.text.get(from..).and_then(|t| t.find('"')).map(|i| from + i);
        }
        self.next_quote
    }

    /// The end of the text read so far, without trailing spaces.
    pub(super) fn before(&self) -> usize {
        self.text.get(..self.offset).map_or(self.offset, |t| t.trim_end().len())
    }

    // Problems.

    /// Reports an error. Its spans are bytes of the text.
    pub(super) fn report(&mut self, problem: Problem) {
        self.broken = true;
        if self.problems.len() < MAX_ERRORS {
            self.problems.push(problem);
        }
    }

    /// Reports text that has no place in the grammar.
    pub(super) fn report_stray(&mut self, range: Range<usize>) {
        let text = self.text.get(range.clone()).unwrap_or("").to_string();
        self.report(Problem::new(Mistake::Stray(text), range));
    }

    /// Records the changes that repair an error which is reported together with others of its kind.
    pub(super) fn change(&mut self, kind: RepeatedError, changes: Vec<TextChange>) {
        self.broken = true;
        if let Some(list) = self.changes.get_mut(kind as usize) {
            list.push(changes);
        }
    }

    /// The problems in order; spans are bytes of the text.
    pub(super) fn finish(mut self) -> Vec<Problem> {
        let mut all = std::mem::take(&mut self.problems);
        for kind in [RepeatedError::Typographic, RepeatedError::Single, RepeatedError::Invisible] {
            let list = self.changes.get(kind as usize).map_or(&[][..], Vec::as_slice);
            all.extend(problem::together(kind, list, self.text, self.below));
        }
        order::sort_by_key(&mut all, |p| p.span.start);
        all.truncate(MAX_ERRORS);
        all
    }
}

/// Numbers of `{ } [ ]` outside of strings in double quotes.
fn count(text: &str) -> [i64; 4] {
    let mut n = [0; 4];
    let (mut inside, mut escaped) = (false, false);
    for b in text.bytes() {
        match b {
            _ if escaped => escaped = false,
            b'\\' if inside => escaped = true,
            b'"' => inside = !inside,
            // Strings do not contain line breaks.
            b'\n' => inside = false,
            b'{' if !inside => n[0] += 1,
            b'}' if !inside => n[1] += 1,
            b'[' if !inside => n[2] += 1,
            b']' if !inside => n[3] += 1,
            _ => {}
        }
    }
    n
}
