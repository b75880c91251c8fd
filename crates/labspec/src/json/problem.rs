//! What can be wrong with JSON, where, and the change that repairs it where that is certain. The words are those of `lint`.

use super::strings::{Trouble, quoted};
use crate::source::SourceMap;
use std::ops::Range;

/// A replacement of some bytes.
pub(super) type TextChange = (Range<usize>, String);

/// Mistakes that occur many times and are reported once for a whole text.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum RepeatedMistake {
    Typographic,
    Single,
    Invisible,
}

/// Something that is wrong with a JSON text.
#[derive(Clone, Debug, PartialEq)]
pub struct Problem {
    /// What it is.
    pub mistake: Mistake,
    /// Bytes of the file.
    pub span: Range<usize>,
    /// Another place that it has to do with: where a text ends, the earlier of two keys, the bracket around.
    pub related: Option<Range<usize>>,
    /// The bytes to replace, and by what.
    pub repair: Option<(Range<usize>, String)>,
}

/// What can be wrong.
#[derive(Clone, Debug, PartialEq)]
pub enum Mistake {
    /// There is no value.
    Nothing,
    /// More brackets inside each other than are read.
    TooDeep,
    /// More values than are read.
    TooMany,
    /// A key stands twice in one object; the place is the second one.
    Twice(String),
    /// No comma between two items.
    CommaMissing,
    /// A comma before a closing bracket.
    TrailingComma,
    /// A comma without a value before it; `first` in its object or list.
    ExtraComma {
        /// Nothing stands before it.
        first: bool,
    },
    /// `;` for `,`.
    Semicolon,
    /// `0,5`.
    DecimalComma,
    /// No colon behind a key.
    ColonMissing,
    /// `=` for `:`.
    Equals,
    /// `::`
    SecondColon,
    /// A key without a value.
    ValueMissing {
        /// Its colon is there.
        colon: bool,
    },
    /// Something stands where a key should.
    KeyMissing,
    /// Keys without a `{` before them.
    OpeningMissing,
    /// The text ends, and brackets are open.
    Unclosed {
        /// The innermost of them.
        open: char,
        /// What closes all of them.
        closing: String,
    },
    /// A bracket that closes nothing.
    StrayBracket(char),
    /// Brackets that close nothing, behind the value; the first of them.
    StrayBrackets(char),
    /// A quote that begins no text.
    StrayQuote,
    /// A bracket of the other kind.
    OtherBracket {
        /// What was meant.
        mine: char,
        /// What stands there.
        found: char,
    },
    /// A bracket is missing before one that closes what is around.
    BracketMissing {
        /// What is missing.
        mine: char,
        /// What stands there.
        found: char,
    },
    /// A list that should have ended before a key.
    ListGoesOn,
    /// Text behind the value.
    Behind,
    /// A comment.
    Comment,
    /// A key without quotes.
    BareKey(String),
    /// A word of another language.
    Word {
        /// What stands there.
        word: String,
        /// What JSON says.
        right: &'static str,
    },
    /// `NaN`, `Infinity`.
    NotFinite(String),
    /// A number beyond the largest.
    TooLarge,
    /// A number in a form that JSON has not.
    NumberForm {
        /// What stands there.
        token: String,
        /// The same number as JSON writes it.
        right: Option<String>,
    },
    /// A text without quotes.
    BareText(String),
    /// Something that is no value: a calculation, for instance.
    NotJson(String),
    /// Something that belongs nowhere.
    Stray(String),
    /// A text without its closing quote.
    StringOpen {
        /// The text goes to the end of everything.
        last: bool,
    },
    /// So many line breaks in one text.
    LineBreaks(usize),
    /// `\q`
    Escape(char),
    /// `\'`
    NeedlessEscape(char),
    /// `\u` with half of a pair.
    HalfPair,
    /// A control character.
    Control(char),
    /// A backslash that should join two lines.
    JoinedLines,
    /// So many double quotes in one text.
    InnerQuotes(usize),
    /// So many typographic quotes.
    Typographic(usize),
    /// So many texts in single quotes or backticks.
    SingleQuotes {
        /// The quote.
        quote: char,
        /// How many texts.
        count: usize,
    },
    /// Invisible characters at so many places.
    Invisible {
        /// The first of them.
        first: char,
        /// How many places.
        count: usize,
    },
}

impl Mistake {
    /// Whether two mistakes are the same, for whoever asks if one is gone. What else is open does not matter.
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

    /// With another place.
    pub(super) fn related(mut self, span: Range<usize>) -> Problem {
        self.related = Some(span);
        self
    }

    /// With the change that repairs it.
    pub(super) fn repair(mut self, span: Range<usize>, text: impl Into<String>) -> Problem {
        self.repair = Some((span, text.into()));
        self
    }

    /// The same at its bytes of the file. A change that would reach over what stands between the lines of the text
    /// (the `> ` of a quote) is left out.
    pub(super) fn below(self, below: &SourceMap) -> Problem {
        let repair = self.repair.filter(|(span, _)| below.is_unbroken(span.clone()));
        Problem {
            mistake: self.mistake,
            span: below.span(self.span),
            related: self.related.map(|span| below.span(span)),
            repair: repair.map(|(span, text)| (below.span(span), text)),
        }
    }

    /// A mistake that is repaired by writing something else in its place.
    pub(super) fn replaced(mistake: Mistake, span: Range<usize>, right: impl Into<String>) -> Problem {
        Problem::new(mistake, span.clone()).repair(span, right)
    }
}

/// What is open at the end of the text.
pub(super) fn unclosed(open: &[(char, usize)], end: usize) -> Problem {
    let Some((innermost, at)) = open.last().copied() else { return Problem::new(Mistake::Nothing, 0..0) };
    let closing: String = open.iter().rev().map(|(c, _)| if *c == '{' { '}' } else { ']' }).collect();
    let mistake = Mistake::Unclosed { open: innermost, closing: closing.clone() };
    Problem::new(mistake, at..at + 1).related(end..end).repair(end..end, closing)
}

/// What stands behind the value.
pub(super) fn behind(rest: Range<usize>, text: &str) -> Problem {
    let behind = text.get(rest.clone()).unwrap_or("");
    if behind.chars().all(|c| matches!(c, '}' | ']') || c.is_whitespace()) {
        let first = behind.chars().next().unwrap_or('}');
        return Problem::replaced(Mistake::StrayBrackets(first), rest, "");
    }
    let line = rest.start + behind.find(['\n', '\r']).unwrap_or(behind.len());
    Problem::new(Mistake::Behind, rest.start..line)
}

/// A number in another form: `right` as JSON writes it.
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

/// A text from the quote at `open` to `end`, where its closing quote is missing.
pub(super) fn string_open(open: usize, end: usize, last: bool, fixed: bool) -> Problem {
    let span = if last { open..open + 1 } else { open..end };
    let problem = Problem::new(Mistake::StringOpen { last }, span);
    if fixed { problem.repair(end..end, "\"") } else { problem }
}

/// What JSON does not allow inside of a text. Line breaks and quotes are reported for the whole text at once: [`inside`].
pub(super) fn in_string(span: Range<usize>, trouble: Trouble) -> Problem {
    let slash = span.start..span.start + 1;
    match trouble {
        Trouble::Escape('\\') => Problem::replaced(Mistake::Escape('\\'), slash, "\\\\"),
        Trouble::Escape(c) => Problem::new(Mistake::Escape(c), span).repair(slash, "\\\\"),
        Trouble::Needless(c) => Problem::replaced(Mistake::NeedlessEscape(c), span, c),
        Trouble::Half => Problem::new(Mistake::HalfPair, span),
        Trouble::Control(c) => {
            Problem::replaced(Mistake::Control(c), span, if c == '\t' { "\\t" } else { "" })
        }
        Trouble::Line => Problem::new(Mistake::LineBreaks(1), span),
        Trouble::Quote => Problem::new(Mistake::InnerQuotes(1), span),
        Trouble::Joined => Problem::replaced(Mistake::JoinedLines, span, ""),
    }
}

/// All line breaks, or all double quotes, of one text.
pub(super) fn inside(mistake: fn(usize) -> Mistake, changes: &[TextChange], text: &str) -> Option<Problem> {
    let (first, _) = changes.first()?;
    let problem = Problem::new(mistake(changes.len()), first.clone());
    Some(match rewritten(&changes.iter().collect::<Vec<_>>(), text) {
        Some((span, right)) => problem.repair(span, right),
        None => problem,
    })
}

/// One problem for all mistakes of a kind; one for each where one change cannot repair them all.
pub(super) fn together(
    kind: RepeatedMistake,
    list: &[Vec<TextChange>],
    text: &str,
    below: &SourceMap,
) -> Vec<Problem> {
    let all: Vec<&TextChange> = list.iter().flatten().collect();
    let Some((region, right)) = rewritten(&all, text) else { return Vec::new() };
    if below.is_unbroken(region.clone()) || list.len() == 1 {
        let count = match kind {
            RepeatedMistake::Typographic => all.iter().filter(|(_, right)| right == "\"").count(),
            _ => list.len(),
        };
        let problem = crowd(kind, count, first(list, text), text).repair(region, right);
        return vec![match all.last().filter(|_| count > 1) {
            Some((last, _)) => problem.related(last.clone()),
            None => problem,
        }];
    }
    let each = |changes: &Vec<TextChange>| {
        let (region, right) = rewritten(&changes.iter().collect::<Vec<_>>(), text)?;
        let count = if kind == RepeatedMistake::Typographic { changes.len() } else { 1 };
        let at = first(std::slice::from_ref(changes), text);
        Some(crowd(kind, count, at, text).repair(region, right))
    };
    list.iter().take(super::MAX_MISTAKES).filter_map(each).collect()
}

/// The place of the first mistake.
fn first(list: &[Vec<TextChange>], text: &str) -> Range<usize> {
    let span = list.first().and_then(|c| c.first()).map_or(0..0, |(span, _)| span.clone());
    let length = text.get(span.start..).and_then(|t| t.chars().next()).map_or(0, char::len_utf8);
    span.start..span.start + length
}

fn crowd(kind: RepeatedMistake, count: usize, span: Range<usize>, text: &str) -> Problem {
    let c = text.get(span.clone()).and_then(|t| t.chars().next()).unwrap_or(' ');
    let mistake = match kind {
        RepeatedMistake::Typographic => Mistake::Typographic(count),
        RepeatedMistake::Single => Mistake::SingleQuotes { quote: c, count },
        RepeatedMistake::Invisible => Mistake::Invisible { first: c, count },
    };
    Problem::new(mistake, span)
}

/// The changes of several texts as one text, from the first to the last.
fn rewritten(changes: &[&TextChange], text: &str) -> Option<TextChange> {
    let range = changes.first()?.0.start..changes.last()?.0.end;
    let (mut new, mut at) = (String::new(), range.start);
    for (span, right) in changes {
        new.push_str(text.get(at..span.start)?);
        new.push_str(right);
        at = span.end;
    }
    Some((range, new))
}
