//! The kinds of errors in JSON, with their spans, and with repairs where these are certain. `lint` contains the messages.

use super::strings::{StringFault, quoted};
use crate::source::SourceMap;
use std::ops::Range;

/// A replacement of some bytes.
pub(super) type TextChange = (Range<usize>, String);

/// Errors that occur many times and are reported once for a whole text.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum RepeatedError {
    Typographic,
    Single,
    Invisible,
}

/// An error in a JSON text.
#[derive(Clone, Debug, PartialEq)]
pub struct Problem {
    /// Its kind.
    pub mistake: Mistake,
    /// Bytes of the file.
    pub span: Range<usize>,
    /// A related span: the end of the text, the first of two keys, the enclosing bracket.
    pub related: Option<Range<usize>>,
    /// The bytes to replace, and the replacement.
    pub repair: Option<(Range<usize>, String)>,
}

/// The kinds of errors.
#[derive(Clone, Debug, PartialEq)]
pub enum Mistake {
    /// There is no value.
    Nothing,
    /// The nesting of brackets exceeds the limit.
    TooDeep,
    /// The number of values exceeds the limit.
    TooMany,
    /// A key appears twice in one object; the span is that of the second one.
    Twice(String),
    /// No comma between two items.
    CommaMissing,
    /// A comma before a closing bracket.
    TrailingComma,
    /// A comma without a value before it.
    ExtraComma {
        /// Whether it is the first item of its object or list.
        first: bool,
    },
    /// `;` for `,`.
    Semicolon,
    /// `0,5`; the number with a point.
    DecimalComma(String),
    /// No colon after a key.
    ColonMissing,
    /// `=` for `:`.
    Equals,
    /// `::`
    SecondColon,
    /// A key without a value.
    ValueMissing {
        /// Whether it has a colon.
        colon: bool,
    },
    /// Another value in place of a key.
    KeyMissing,
    /// Keys without a `{` before them.
    OpeningMissing,
    /// The text ends inside brackets.
    Unclosed {
        /// The innermost open bracket.
        open: char,
        /// The text that closes all of them.
        closing: String,
    },
    /// A closing bracket without an opening one.
    StrayBracket(char),
    /// Closing brackets without opening ones, after the value; the first of them.
    StrayBrackets(char),
    /// A quote that does not begin a text.
    StrayQuote,
    /// A closing bracket of the other kind.
    OtherBracket {
        /// The intended bracket.
        expected: char,
        /// The bracket in the text.
        found: char,
    },
    /// A bracket is missing before one that closes the enclosing value, or before the next item of a list.
    BracketMissing {
        /// The missing bracket.
        expected: char,
        /// The bracket in the text.
        found: char,
    },
    /// A list that must end before a key.
    ListGoesOn,
    /// Text after the value.
    Behind,
    /// A comment.
    Comment,
    /// A key without quotes.
    BareKey(String),
    /// A word of another language.
    Word {
        /// The word in the text.
        word: String,
        /// The JSON literal.
        right: &'static str,
    },
    /// `NaN`, `Infinity`.
    NotFinite(String),
    /// A number beyond the largest double.
    TooLarge,
    /// A number in a form that JSON does not have.
    NumberForm {
        /// The number in the text.
        token: String,
        /// The same number in JSON.
        right: Option<String>,
    },
    /// A text without quotes.
    BareText(String),
    /// Text that is not a value, such as a calculation.
    NotJson(String),
    /// Text that has no place in the grammar.
    Stray(String),
    /// A text without its closing quote.
    StringOpen {
        /// Whether it extends to the end of the file.
        last: bool,
    },
    /// The number of line breaks in one text.
    LineBreaks(usize),
    /// `\q`
    Escape(char),
    /// `\'`
    NeedlessEscape(char),
    /// `\u` with half of a surrogate pair.
    HalfPair,
    /// A control character.
    Control(char),
    /// A backslash that joins two lines.
    JoinedLines,
    /// The number of double quotes in one text.
    InnerQuotes(usize),
    /// The number of typographic quotes.
    Typographic(usize),
    /// Texts in single quotes or backticks.
    SingleQuotes {
        /// The quote.
        quote: char,
        /// The number of texts.
        count: usize,
    },
    /// Invisible characters.
    Invisible {
        /// The first of them.
        first: char,
        /// The number of places.
        count: usize,
    },
}

impl Mistake {
    /// Whether two errors are equal, to test whether one was repaired. Other open brackets are ignored.
    pub(super) fn is(&self, other: &Mistake) -> bool {
        match (self, other) {
            (Mistake::Unclosed { open: a, .. }, Mistake::Unclosed { open: b, .. }) => a == b,
            _ => self == other,
        }
    }
}

impl Problem {
    pub(super) fn new(mistake: Mistake, span: Range<usize>) -> Problem {
        Problem { mistake, span, related: None, repair: None }
    }

    /// Adds a related span.
    pub(super) fn related(mut self, span: Range<usize>) -> Problem {
        self.related = Some(span);
        self
    }

    /// Adds a repair.
    pub(super) fn repair(mut self, span: Range<usize>, text: impl Into<String>) -> Problem {
        self.repair = Some((span, text.into()));
        self
    }

    /// Maps its spans to bytes of the file. A repair across text that was removed between the lines (the `> ` of a quote)
    /// is dropped.
    pub(super) fn below(self, below: &SourceMap) -> Problem {
        let repair = self.repair.filter(|(span, _)| below.is_unbroken(span.clone()));
        Problem {
            mistake: self.mistake,
            span: below.span(self.span),
            related: self.related.map(|span| below.span(span)),
            repair: repair.map(|(span, text)| (below.span(span), text)),
        }
    }

    /// An error whose repair replaces its span.
    pub(super) fn replaced(mistake: Mistake, span: Range<usize>, right: impl Into<String>) -> Problem {
        Problem::new(mistake, span.clone()).repair(span, right)
    }
}

/// The error of brackets that are open at the end of the text.
pub(super) fn unclosed(open: &[(char, usize)], end: usize) -> Problem {
    let Some((innermost, offset)) = open.last().copied() else { return Problem::new(Mistake::Nothing, 0..0) };
    let closing: String = open.iter().rev().map(|(c, _)| if *c == '{' { '}' } else { ']' }).collect();
    let mistake = Mistake::Unclosed { open: innermost, closing: closing.clone() };
    Problem::new(mistake, offset..offset + 1).related(end..end).repair(end..end, closing)
}

/// The error of text after the value.
pub(super) fn behind(rest: Range<usize>, text: &str) -> Problem {
    let behind = text.get(rest.clone()).unwrap_or("");
    if behind.chars().all(|c| matches!(c, '}' | ']') || c.is_whitespace()) {
        let first = behind.chars().next().unwrap_or('}');
        return Problem::replaced(Mistake::StrayBrackets(first), rest, "");
    }
    let line = rest.start + behind.find(['\n', '\r']).unwrap_or(behind.len());
    Problem::new(Mistake::Behind, rest.start..line)
}

/// The error of a number in another form. `right` is the number in JSON.
pub(super) fn number_form(span: Range<usize>, token: &str, right: Option<String>) -> Problem {
    let mistake = Mistake::NumberForm { token: token.to_string(), right: right.clone() };
    let problem = Problem::new(mistake, span.clone());
    match right {
        Some(right) => problem.repair(span, right),
        None => problem,
    }
}

/// A name or a text without quotes.
pub(super) fn bare(mistake: fn(String) -> Mistake, span: Range<usize>, word: &str) -> Problem {
    Problem::replaced(mistake(word.to_string()), span, quoted(word))
}

/// The error of a text from the quote at `open` to `end` without its closing quote.
pub(super) fn unclosed_string(open: usize, end: usize, last: bool, fixed: bool) -> Problem {
    let span = if last { open..open + 1 } else { open..end };
    let problem = Problem::new(Mistake::StringOpen { last }, span);
    if fixed { problem.repair(end..end, "\"") } else { problem }
}

/// The error of a character that JSON does not allow inside a text. Line breaks and quotes are reported for the whole text
/// at once: [`inside`].
pub(super) fn in_string(span: Range<usize>, fault: StringFault) -> Problem {
    let slash = span.start..span.start + 1;
    match fault {
        StringFault::Escape('\\') => Problem::replaced(Mistake::Escape('\\'), slash, "\\\\"),
        StringFault::Escape(c) => Problem::new(Mistake::Escape(c), span).repair(slash, "\\\\"),
        StringFault::Needless(c) => Problem::replaced(Mistake::NeedlessEscape(c), span, c),
        StringFault::Half => Problem::new(Mistake::HalfPair, span),
        StringFault::Control(c) => {
            Problem::replaced(Mistake::Control(c), span, if c == '\t' { "\\t" } else { "" })
        }
        StringFault::Line => Problem::new(Mistake::LineBreaks(1), span),
        StringFault::Quote => Problem::new(Mistake::InnerQuotes(1), span),
        StringFault::Joined => Problem::replaced(Mistake::JoinedLines, span, ""),
    }
}

/// One problem for all line breaks, or all double quotes, of one text.
pub(super) fn inside(mistake: fn(usize) -> Mistake, changes: &[TextChange], text: &str) -> Option<Problem> {
    let (first, _) = changes.first()?;
    let problem = Problem::new(mistake(changes.len()), first.clone());
    Some(match rewritten(&changes.iter().collect::<Vec<_>>(), text) {
        Some((span, right)) => problem.repair(span, right),
        None => problem,
    })
}

/// One problem for all errors of a kind; one for each if a single change cannot repair them all.
pub(super) fn together(
    kind: RepeatedError,
    list: &[Vec<TextChange>],
    text: &str,
    below: &SourceMap,
) -> Vec<Problem> {
    let all: Vec<&TextChange> = list.iter().flatten().collect();
    let Some((region, right)) = rewritten(&all, text) else { return Vec::new() };
    if below.is_unbroken(region.clone()) || list.len() == 1 {
        let count = match kind {
            RepeatedError::Typographic => all.iter().filter(|(_, right)| right == "\"").count(),
            _ => list.len(),
        };
        let problem = repeated(kind, count, first(list, text), text).repair(region, right);
        return vec![match all.last().filter(|_| count > 1) {
            Some((last, _)) => problem.related(last.clone()),
            None => problem,
        }];
    }
    let each = |changes: &Vec<TextChange>| {
        let (region, right) = rewritten(&changes.iter().collect::<Vec<_>>(), text)?;
        let count = if kind == RepeatedError::Typographic { changes.len() } else { 1 };
        let start = first(std::slice::from_ref(changes), text);
        Some(repeated(kind, count, start, text).repair(region, right))
    };
    list.iter().take(super::MAX_ERRORS).filter_map(each).collect()
}

/// The span of the first error.
fn first(list: &[Vec<TextChange>], text: &str) -> Range<usize> {
    let span = list.first().and_then(|c| c.first()).map_or(0..0, |(span, _)| span.clone());
    let length = text.get(span.start..).and_then(|t| t.chars().next()).map_or(0, char::len_utf8);
    span.start..span.start + length
}

fn repeated(kind: RepeatedError, count: usize, span: Range<usize>, text: &str) -> Problem {
    let c = text.get(span.clone()).and_then(|t| t.chars().next()).unwrap_or(' ');
    let mistake = match kind {
        RepeatedError::Typographic => Mistake::Typographic(count),
        RepeatedError::Single => Mistake::SingleQuotes { quote: c, count },
        RepeatedError::Invisible => Mistake::Invisible { first: c, count },
    };
    Problem::new(mistake, span)
}

/// Combines changes into one that covers the range from the first to the last.
fn rewritten(changes: &[&TextChange], text: &str) -> Option<TextChange> {
    let range = changes.first()?.0.start..changes.last()?.0.end;
    let (mut new, mut offset) = (String::new(), range.start);
    for (span, right) in changes {
        new.push_str(text.get(offset..span.start)?);
        new.push_str(right);
        offset = span.end;
    }
    Some((range, new))
}
