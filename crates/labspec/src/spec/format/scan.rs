//! Finds the enclosing objects and lists at an offset of a JSON text, and whether a key or a value is expected there. The
//! text can be malformed, most often at the offset itself, because it is being edited.
//!
//! It takes one pass over the characters. Commas and colons can be missing. A string that is not closed ends after its
//! first word, or at the end of its line.

use crate::json::MAX_DEPTH;
use std::ops::Range;

/// An object or a list.
#[derive(Debug, Default)]
pub(super) struct JsonScope {
    /// The enclosing object or list, and the position in it.
    pub(super) parent: Option<(usize, ScanStep)>,
    /// Whether it is a list.
    pub(super) list: bool,
    /// The keys of an object, each with its value if this is a text. The key at the offset is not included.
    pub(super) keys: Vec<(String, Option<String>)>,
    /// The texts of a list, without the one at the offset.
    pub(super) texts: Vec<String>,
    /// The number of items of a list that have started.
    items: usize,
}

/// A position in an object or a list.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum ScanStep {
    /// The value of this key.
    Key(String),
    /// The item with this index, from 0.
    Item(usize),
}

/// The key or the value at the offset.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct CursorSpot {
    /// The index of the enclosing object or list.
    pub(super) scope: usize,
    /// The position of the value; `None` for a key.
    pub(super) value: Option<ScanStep>,
    /// The byte range of the text that is already written, quotes included; empty if there is none.
    pub(super) written: Range<usize>,
}

/// The structure of a text, as far as it can be recognized.
#[derive(Debug, Default)]
pub(super) struct JsonScan {
    /// The objects and lists; the first one is the outermost.
    pub(super) scopes: Vec<JsonScope>,
    /// The key or the value at the offset; `None` if neither can occur there.
    pub(super) spot: Option<CursorSpot>,
}

/// What is expected next.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Next {
    Key,
    Colon,
    Value,
    Comma,
}

struct Scanner<'a> {
    text: &'a str,
    offset: usize,
    position: usize,
    open: Vec<usize>,
    next: Next,
    /// The key whose value is expected next.
    key: String,
    /// The number of characters that can still be examined for the end of a string.
    budget: usize,
    scan: JsonScan,
}

/// Scans a text. The offset must be a character boundary.
pub(super) fn scan(text: &str, offset: usize) -> JsonScan {
    let (open, scan) = (Vec::new(), JsonScan::default());
    // The lines of malformed strings are examined more than once.
    let budget = 16 * text.len() + 1000;
    let mut s =
        Scanner { text, offset, position: 0, open, next: Next::Value, key: String::new(), budget, scan };
    while s.budget > 0 {
        s.gap();
        let Some(c) = s.rest().chars().next() else { break };
        match c {
            '{' | '[' => {
                if s.open.len() >= MAX_DEPTH {
                    break;
                }
                s.enter(c == '[');
            }
            '}' | ']' => s.leave(c == ']'),
            ',' => {
                s.position += 1;
                s.key.clear();
                s.next = if s.in_list() { Next::Value } else { Next::Key };
            }
            ':' => {
                s.position += 1;
                if s.next == Next::Colon {
                    s.next = Next::Value;
                }
            }
            '"' => s.string(),
            c if is_word(c) => s.word(),
            c => s.position += c.len_utf8(),
        }
    }
    s.scan
}

fn is_word(c: char) -> bool {
    c.is_alphanumeric() || matches!(c, '_' | '$' | '-' | '+' | '.')
}

impl<'a> Scanner<'a> {
    fn rest(&self) -> &'a str {
        self.text.get(self.position..).unwrap_or("")
    }

    fn in_list(&self) -> bool {
        self.scope().is_none_or(|s| s.list)
    }

    fn scope(&self) -> Option<&JsonScope> {
        self.scan.scopes.get(*self.open.last()?)
    }

    /// Skips white space, which can contain the offset.
    fn gap(&mut self) {
        let start = self.position;
        self.position += self.rest().len() - self.rest().trim_start().len();
        if (start..=self.position).contains(&self.offset) {
            self.mark(self.offset..self.offset);
        }
    }

    /// Records this range as the text at the offset, if a key or a value is expected here.
    fn mark(&mut self, written: Range<usize>) {
        let Some(&scope) = self.open.last() else { return };
        let value = match self.next {
            Next::Key => None,
            Next::Value => Some(self.step()),
            Next::Colon | Next::Comma => return,
        };
        self.scan.spot = Some(CursorSpot { scope, value, written });
    }

    /// The position of the value that is expected next.
    fn step(&self) -> ScanStep {
        match self.scope() {
            Some(scope) if scope.list => ScanStep::Item(scope.items),
            _ => ScanStep::Key(self.key.clone()),
        }
    }

    fn enter(&mut self, list: bool) {
        let parent = self.open.last().map(|&p| (p, self.step()));
        self.valued(None);
        self.open.push(self.scan.scopes.len());
        self.scan.scopes.push(JsonScope { parent, list, ..JsonScope::default() });
        self.next = if list { Next::Value } else { Next::Key };
        self.position += 1;
    }

    /// A closing bracket closes the innermost open bracket of its kind, and all brackets inside it.
    fn leave(&mut self, list: bool) {
        self.position += 1;
        self.key.clear();
        let in_list = |&scope: &usize| self.scan.scopes.get(scope).is_some_and(|s| s.list == list);
        if let Some(i) = self.open.iter().rposition(in_list) {
            self.open.truncate(i);
            self.next = Next::Comma;
        }
    }

    /// Records a value: a text, or a value of another type.
    fn valued(&mut self, text: Option<String>) {
        let key = std::mem::take(&mut self.key);
        if let Some(scope) = self.open.last().and_then(|&i| self.scan.scopes.get_mut(i)) {
            if scope.list {
                scope.items += 1;
                scope.texts.extend(text);
            } else if let Some((name, value)) = scope.keys.last_mut()
                && *name == key
            {
                *value = text;
            }
        }
        self.next = Next::Comma;
    }

    fn string(&mut self) {
        let (start, mut end) = (self.position, self.closed());
        let behind = |end: usize| self.text.get(end..).unwrap_or("").trim_start();
        let colon = behind(end).starts_with(':');
        if self.in_list() {
            self.next = Next::Value;
        } else if colon || self.next == Next::Comma {
            // This is a key, whatever was expected: the comma or the value before it is missing.
            self.next = Next::Key;
        } else if self.next == Next::Colon {
            self.next = Next::Value;
        }
        let is_key = self.next == Next::Key;
        let inside = self.text.get(start + 1..end).unwrap_or("");
        let word = start + 1 + inside.find(|c| !is_word(c)).unwrap_or(inside.len());
        let ended = self.text.get(start + 1..end).is_some_and(|t| t.ends_with('"'));
        let half = if is_key {
            !colon && (!ended || word + 1 < end)
        } else {
            let stops = |t: &str| t.trim_start_matches([' ', '\t']).starts_with([',', '}', ']']);
            let next = self.text.get(end..).unwrap_or("").trim_start_matches([' ', '\t']);
            let fine = ended && (next.is_empty() || next.starts_with([',', '}', ']', '\n', '\r']));
            !fine && (stops(behind(word)) || behind(word).is_empty())
        };
        if half {
            end = word;
        }
        let closed = ended && !half;
        let value = self.text.get(start + 1..end - usize::from(closed)).unwrap_or("").to_string();
        self.put(start..end, value, closed, true);
    }

    /// The end of the string that starts here: after its closing quote, or at the end of the line.
    fn closed(&mut self) -> usize {
        let mut escaped = false;
        for (i, c) in self.rest().char_indices().skip(1) {
            self.budget = self.budget.saturating_sub(1);
            match c {
                '\n' | '\r' => return self.position + i,
                _ if escaped => escaped = false,
                '\\' => escaped = true,
                '"' => return self.position + i + 1,
                _ => {}
            }
        }
        self.text.len()
    }

    /// A number, `true`, or a word without quotes.
    fn word(&mut self) {
        let length = self.rest().find(|c| !is_word(c)).unwrap_or(self.rest().len());
        let range = self.position..self.position + length;
        if self.next == Next::Comma {
            self.next = if self.in_list() { Next::Value } else { Next::Key };
        }
        let value = self.text.get(range.clone()).unwrap_or("").to_string();
        self.put(range, value, false, false);
    }

    /// Records a key or a value.
    fn put(&mut self, range: Range<usize>, value: String, closed: bool, quoted: bool) {
        let within = range.start < self.offset && self.offset < range.end + usize::from(!closed);
        if within {
            self.mark(range.clone());
        }
        self.position = range.end;
        if self.next == Next::Key && !self.in_list() {
            self.key.clone_from(&value);
            self.next = Next::Colon;
            if !within && let Some(scope) = self.open.last().and_then(|&i| self.scan.scopes.get_mut(i)) {
                scope.keys.push((value, None));
            }
        } else {
            self.valued(Some(value).filter(|_| quoted && !within));
        }
    }
}
