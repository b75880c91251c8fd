//! Texts in quotes: finds the end of a damaged one, and the errors inside.
//!
//! A quote ends a text if JSON continues after it. Otherwise it is part of the text, or the closing quote is missing; the
//! surrounding text decides between the two.

use super::parser::JsonParser;
use super::problem::{self, Mistake, RepeatedError, TextChange};
use super::strings::{StringFault, decode};
use crate::markdown::is_typographic;
use crate::source::{SourceMap, Text};
use std::ops::Range;

/// Number of bytes after a quote that are read.
const MAX_LOOKAHEAD: usize = 4096;

/// The end of a text.
struct StringEnd {
    /// The range between its quotes.
    inside: Range<usize>,
    /// The position where parsing continues.
    next: usize,
    /// Whether it has no closing quote.
    open: bool,
}

impl JsonParser<'_> {
    /// Whether a text begins with this character, in JSON or in common errors.
    pub(super) fn is_quote(&self, c: char) -> bool {
        matches!(c, '"' | '\'' | '`') || is_typographic(c)
    }

    /// Reads the text that begins here: a key, or a value.
    pub(super) fn string(&mut self, key: bool) -> Text {
        let start = self.offset;
        let quote = self.peek().unwrap_or('"');
        let end = self.string_end(quote, key);
        self.offset = end.next;
        let inside = end.inside.clone();
        if end.open {
            let last = inside.end == self.text.trim_end().len();
            self.report(problem::unclosed_string(start, inside.end, last, quote == '"'));
        }
        let decoded = decode(self.text.get(inside.clone()).unwrap_or(""));
        let mut lines: Vec<TextChange> = Vec::new();
        let mut inner: Vec<TextChange> = Vec::new();
        let mut changes: Vec<TextChange> = Vec::new();
        if quote != '"' {
            changes.push((start..inside.start, "\"".into()));
        }
        for (range, fault) in &decoded.faults {
            let range = range.start + inside.start..range.end + inside.start;
            match fault {
                StringFault::Line => lines.push((range, "\\n".into())),
                StringFault::Quote if quote == '"' => inner.push((range, "\\\"".into())),
                StringFault::Quote => changes.push((range, "\\\"".into())),
                StringFault::Needless(c) if quote != '"' => changes.push((range, c.to_string())),
                _ => self.report(problem::in_string(range, *fault)),
            }
        }
        if quote != '"' && self.text.get(inside.end..end.next) != Some("\"") {
            changes.push((inside.end..end.next, "\"".into()));
        }
        let breaks = problem::inside(Mistake::LineBreaks, &lines, self.text);
        let quotes = problem::inside(Mistake::InnerQuotes, &inner, self.text);
        breaks.into_iter().chain(quotes).for_each(|problem| self.report(problem));
        if !changes.is_empty() {
            self.change(
                if is_typographic(quote) { RepeatedError::Typographic } else { RepeatedError::Single },
                changes,
            );
        }
        let map = if decoded.map.derived_len() == 0 {
            SourceMap::point(inside.start)
        } else {
            decoded.map.shifted(inside.start)
        };
        Text { value: decoded.value, map: map.then(self.below) }
    }

    fn string_end(&mut self, quote: char, key: bool) -> StringEnd {
        let from = self.offset + quote.len_utf8();
        let mut offset = from;
        while let Some(c) = self.text.get(offset..).and_then(|t| t.chars().next()) {
            let next = offset + c.len_utf8();
            match c {
                '\\' => {
                    let escaped = self.text.get(next..).and_then(|t| t.chars().next());
                    offset = next + escaped.filter(|c| !matches!(c, '\n' | '\r')).map_or(0, char::len_utf8);
                    continue;
                }
                '\n' | '\r' if !self.goes_on(quote, next, key) => return self.line_ends(from, offset, key),
                _ if quote == '"' && c == '"' => {
                    if self.is_of_attribute(from, offset) {
                        offset = next;
                        continue;
                    }
                    if self.json_follows(next) {
                        return StringEnd { inside: from..offset, next, open: false };
                    }
                    if let Some(end) = self.lost_quote(from, offset, key) {
                        return StringEnd { inside: from..end, next: end, open: true };
                    }
                    if !self.is_inner(next) {
                        return StringEnd { inside: from..offset, next, open: false };
                    }
                }
                _ if closes(quote, c) && self.json_follows(next) => {
                    return StringEnd { inside: from..offset, next, open: false };
                }
                _ => {}
            }
            offset = next;
        }
        self.line_ends(from, self.text.len(), key)
    }

    /// Whether a text continues on the next line: the next quote ends it. Keys never do.
    fn goes_on(&mut self, quote: char, next: usize, key: bool) -> bool {
        match quote {
            '`' => true,
            '"' if !key => self.quote_from(next).is_some_and(|q| self.json_follows(q + 1)),
            _ => false,
        }
    }

    /// The end of a text without a closing quote on its line.
    fn line_ends(&mut self, from: usize, line: usize, key: bool) -> StringEnd {
        let content = self.text.get(from..line).unwrap_or("").trim_end();
        let content = match content.find([':', '=']).filter(|_| key) {
            Some(colon) => content.get(..colon).unwrap_or("").trim_end(),
            None => {
                // A comma or brackets at the end of the line do not belong to the text.
                let mut rest = content.strip_suffix(',').unwrap_or(content).trim_end();
                let count = |c: char| rest.matches(c).count();
                let mut more = [count('}').saturating_sub(count('{')), count(']').saturating_sub(count('['))];
                while let Some(i) = ['}', ']'].iter().position(|c| rest.ends_with(*c))
                    && let Some(n) = more.get_mut(i).filter(|n| **n > 0)
                {
                    *n -= 1;
                    rest = rest.get(..rest.len() - 1).unwrap_or("").trim_end();
                }
                rest
            }
        };
        let end = from + content.len();
        StringEnd { inside: from..end, next: end, open: true }
    }

    /// Whether JSON, or text intended as JSON, continues here after a text.
    fn json_follows(&self, offset: usize) -> bool {
        let all = self.text.get(offset..).unwrap_or("");
        // The range is limited, because a long run of spaces must not be read repeatedly.
        let mut far = MAX_LOOKAHEAD.min(all.len());
        while !all.is_char_boundary(far) {
            far += 1;
        }
        let behind = all.get(..far).unwrap_or(all);
        let next = behind.trim_start();
        let crossed = behind.get(..behind.len() - next.len()).is_some_and(|s| s.contains(['\n', '\r']));
        match next.chars().next() {
            None | Some(':' | ']' | '}' | '=' | ';' | '#') => true,
            Some('/') => next.starts_with("//") || next.starts_with("/*"),
            Some(',') => value_follows(next.get(1..).unwrap_or("").trim_start()),
            _ => crossed,
        }
    }

    /// Whether the double quote before `next`, after which JSON does not continue, is part of a text.
    fn is_inner(&mut self, next: usize) -> bool {
        let behind = self.text.get(next..).unwrap_or("");
        let word = behind.trim_start_matches([' ', '\t']);
        let adjacent = word.len() == behind.len();
        let Some(c) = word.chars().next() else { return false };
        let again = self.quote_from(next);
        let line = self.line_from(next);
        match c {
            // In …said "hi""} the second quote closes.
            '"' => adjacent && self.json_follows(next + 1),
            '{' | '[' => false,
            '0'..='9' | '-' | '+' | '.' if !adjacent => false,
            _ if c.is_alphabetic() && (begins_key(word) || begins_word(word)) => false,
            _ => again.is_some_and(|q| q < line),
        }
    }

    /// Whether the double quote at `offset`, in a text that begins at `from`, opens or closes the value of an attribute: the text
    /// is XML that was pasted with its double quotes. A quote after which JSON continues, or the text ends, closes the text.
    fn is_of_attribute(&self, from: usize, offset: usize) -> bool {
        let before = self.text.get(from..offset).unwrap_or("");
        let behind = self.text.get(offset + 1..).unwrap_or("").trim_start();
        if !before.starts_with('<') || behind.is_empty() || behind.starts_with([',', ':', ']', '}']) {
            return false;
        }
        before.ends_with('=')
            || behind.starts_with('>')
            || behind.starts_with("/>")
            || begins_attribute(behind)
    }

    /// The end of a text without its closing quote, if the double quote at `offset` begins the next text.
    fn lost_quote(&mut self, from: usize, offset: usize, key: bool) -> Option<usize> {
        let content = self.text.get(from..offset)?.trim_end();
        if key {
            // Example: {"model: "ball"}
            let word = content.strip_suffix([':', '='])?.trim_end();
            let is_name = !word.is_empty() && word.chars().all(|c| c.is_alphanumeric() || c == '_');
            return is_name.then_some(from + word.len());
        }
        // Example: {"model": "ball, "stopAt": 2}
        let before = content.strip_suffix(',')?;
        let name = self.text.get(offset + 1..)?;
        let length = name.find(|c: char| !(c.is_alphanumeric() || c == '_'))?;
        let behind = name.get(length..)?.strip_prefix('"')?.trim_start();
        (length > 0 && behind.starts_with(':')).then_some(from + before.len())
    }
}

/// Whether `c` can close a text that `open` opened. Single quotes close only single ones, so that an apostrophe does not
/// end a text.
fn closes(open: char, c: char) -> bool {
    let single = |c| matches!(c, '‘' | '’' | '‚' | '‛');
    match open {
        '"' => false,
        '\'' | '`' => c == open,
        _ => (is_typographic(c) || c == '"') && single(c) == single(open),
    }
}

/// Whether a value, a key, or the end may begin like this, after a comma.
fn value_follows(text: &str) -> bool {
    match text.chars().next() {
        None | Some('"' | '\'' | '`' | '{' | '[' | '}' | ']' | '-' | '+' | '.' | ',' | '#' | '/') => true,
        Some(c) if c.is_ascii_digit() || is_typographic(c) => true,
        Some(_) => begins_key(text) || begins_word(text),
    }
}

/// Whether a text begins with a name, an equals sign and a quote, as an attribute of XML does.
fn begins_attribute(text: &str) -> bool {
    let behind = text.trim_start_matches(|c: char| c.is_alphanumeric() || matches!(c, '_' | '-' | ':'));
    behind.len() < text.len() && (behind.starts_with("=\"") || behind.starts_with("='"))
}

/// Whether a text begins with a name without quotes and a colon.
fn begins_key(text: &str) -> bool {
    let behind = text.trim_start_matches(|c: char| c.is_alphanumeric() || matches!(c, '_' | '$'));
    behind.len() < text.len() && behind.trim_start_matches([' ', '\t']).starts_with([':', '='])
}

/// Whether a text begins with a word such as `true`, followed by a separator.
fn begins_word(text: &str) -> bool {
    let behind = text.trim_start_matches(|c: char| c.is_alphanumeric());
    let token = text.get(..text.len() - behind.len()).unwrap_or("");
    super::literal::is_word(token) && behind.trim_start().starts_with([',', '}', ']'])
}
