//! Parses JSON text into a tree with a span for every node: objects and lists, and recovery when a comma, a colon or a
//! bracket is missing or superfluous.
//!
//! A recursive descent parser over the characters. Every error is resolved where it is detected, by the smallest change
//! that allows parsing to continue. Nothing is read twice, so the time is linear (lookahead goes to the next quote or line
//! end, and both are cached).

use super::node::{Json, Member, Node};
use super::parser::{JsonParser, LimitReached};
use super::problem::{self, Mistake, Problem};
use super::{MAX_DEPTH, MAX_ERRORS, MAX_VALUES};
use crate::source::{SourceMap, Text};
use labspec_finding::order;
use std::collections::HashMap;
use std::ops::Range;

/// The result of parsing.
#[derive(Clone, Debug)]
pub struct Parsed {
    /// The tree; `None` when the text is empty or exceeds a limit.
    pub node: Option<Node>,
    /// The errors, and duplicate keys.
    pub problems: Vec<Problem>,
    /// Whether the text is not valid JSON, so that a page cannot read it.
    pub broken: bool,
}

/// Parses strict JSON with recovery from every error. `below` maps bytes of `text` to bytes of the file.
pub fn parse(text: &str, below: &SourceMap) -> Parsed {
    let mut parser = JsonParser::new(text, below);
    let node = parser.root().unwrap_or(None);
    let broken = parser.broken;
    let mut problems = std::mem::take(&mut parser.placed);
    let mut reported = parser.finish();
    if broken {
        try_repairs(text, &mut reported);
    }
    problems.extend(reported.into_iter().map(|p| p.below(below)));
    order::sort_by_key(&mut problems, |p| p.span.start);
    problems.truncate(MAX_ERRORS);
    Parsed { node, problems, broken }
}

/// Maximum number of tested repairs, and maximum length of the text.
const MAX_TRIES: usize = 50;
const MAX_TRIED: usize = 128 << 10;

/// Keeps the repairs that succeed: each is applied alone and the text is parsed again. There must then be fewer errors, and
/// no new ones.
fn try_repairs(text: &str, problems: &mut [Problem]) {
    // Errors that are reported once count once: two brackets may be missing at one place.
    fn to_errors(list: &[Problem]) -> Vec<Mistake> {
        let mut all: Vec<&Problem> = Vec::new();
        for problem in list {
            if !all.iter().any(|p| p.span == problem.span && p.mistake.is(&problem.mistake)) {
                all.push(problem);
            }
        }
        all.into_iter().map(|p| p.mistake.clone()).collect()
    }
    let count = |list: &[Mistake], mistake: &Mistake| list.iter().filter(|m| m.is(mistake)).count();
    let before = to_errors(problems);
    for (i, problem) in problems.iter_mut().enumerate() {
        let Some((span, right)) = &problem.repair else { continue };
        let mut repaired = text.to_string();
        let fits = i < MAX_TRIES && text.len() <= MAX_TRIED && text.get(span.clone()).is_some();
        if fits {
            repaired.replace_range(span.clone(), right);
            let below = SourceMap::verbatim(0..repaired.len());
            let mut parser = JsonParser::new(&repaired, &below);
            let _ = parser.root();
            let left = to_errors(&parser.finish());
            // The error itself must be gone, not only one that it caused.
            let gone = count(&left, &problem.mistake) < count(&before, &problem.mistake);
            if gone && left.len() < before.len() && left.iter().all(|m| count(&before, m) > 0) {
                continue;
            }
        }
        problem.repair = None;
    }
}

impl JsonParser<'_> {
    fn root(&mut self) -> Result<Option<Node>, LimitReached> {
        self.gap();
        if self.rest().is_empty() {
            if !self.broken {
                self.report(Problem::new(Mistake::Nothing, 0..0));
            }
            return Ok(None);
        }
        let node = if self.key_ahead() {
            let start = self.offset;
            self.report(Problem::replaced(Mistake::OpeningMissing, start..start, "{"));
            self.adjust_bracket_count('{', 1);
            Some(self.members(start)?)
        } else {
            self.value()?
        };
        self.gap();
        if !self.rest().trim().is_empty() {
            let rest = self.offset..self.offset + self.rest().trim_end().len();
            self.report(problem::behind(rest, self.text));
        }
        Ok(node)
    }

    /// Whether a key and its colon are here in place of a value.
    fn key_ahead(&self) -> bool {
        let Some(first) = self.peek() else { return false };
        let inside = self.rest().get(first.len_utf8()..).unwrap_or("");
        let name = |c: char| c.is_alphanumeric() || matches!(c, '_' | '$');
        let behind = if matches!(first, '"' | '\'') {
            inside.trim_start_matches(name).strip_prefix(first)
        } else if first.is_alphabetic() {
            Some(inside.trim_start_matches(name))
        } else {
            None
        };
        behind.is_some_and(|b| b.trim_start_matches([' ', '\t']).starts_with(':'))
    }

    /// Reads a value; `None` where none begins: at a comma, a colon, a closing bracket, the end.
    pub(super) fn value(&mut self) -> Result<Option<Node>, LimitReached> {
        self.gap();
        let Some(c) = self.peek() else { return Ok(None) };
        self.values += 1;
        if self.values > MAX_VALUES {
            self.report(Problem::new(Mistake::TooMany, self.offset..self.offset + 1));
            return Err(LimitReached);
        }
        Ok(match c {
            '{' => {
                let start = self.offset;
                self.bump();
                Some(self.members(start)?)
            }
            '[' => Some(self.items()?),
            ',' | ':' | '=' | ';' | '}' | ']' => None,
            _ if self.is_quote(c) => {
                let start = self.offset;
                let text = self.string(false);
                Some(self.node(Json::Text(text), start))
            }
            _ => Some(self.literal()),
        })
    }

    /// A node from `start` to the current position.
    pub(super) fn node(&self, json: Json, start: usize) -> Node {
        Node { json, span: self.below.span(start..self.offset) }
    }

    fn enter(&mut self, bracket: char, start: usize) -> Result<(), LimitReached> {
        self.open.push((bracket, start));
        if self.open.len() > MAX_DEPTH {
            self.report(Problem::new(Mistake::TooDeep, start..start + 1));
            return Err(LimitReached);
        }
        Ok(())
    }

    /// Reads the members of an object whose bracket is at `start`.
    fn members(&mut self, start: usize) -> Result<Node, LimitReached> {
        self.enter('{', start)?;
        let mut members: Vec<Member> = Vec::new();
        let mut seen: HashMap<String, Range<usize>> = HashMap::new();
        let mut first = true;
        let mut end = self.offset;
        loop {
            self.gap();
            match self.peek() {
                None => break self.unclosed(),
                Some('}') => {
                    if self.closes_too_early() {
                        self.stray_bracket();
                        self.separator(true);
                        continue;
                    }
                    self.bump();
                    break;
                }
                Some(']') => {
                    if self.wrong_bracket('}', ']') {
                        break;
                    }
                    self.separator(true);
                    continue;
                }
                Some(',') => {
                    self.extra_comma(first);
                    continue;
                }
                Some('"') if self.is_lone_quote() => {
                    self.report(Problem::replaced(Mistake::StrayQuote, self.offset..self.offset + 1, ""));
                    self.bump();
                    continue;
                }
                // At the next item of a list, the object was intended to end before it.
                Some('{') if !first && self.is_item_of_list() => {
                    self.end_before_item(end);
                    break;
                }
                Some(_) => {}
            }
            first = false;
            if let Some(member) = self.member()? {
                if let Some(earlier) = seen.insert(member.key.value.clone(), member.key.span()) {
                    self.twice(&member.key, earlier);
                }
                members.push(member);
            }
            end = self.offset;
            self.separator(true);
        }
        self.open.pop();
        Ok(self.node(Json::Object(members), start))
    }

    /// Whether the object that is read is an item of a list.
    fn is_item_of_list(&self) -> bool {
        matches!(self.open.as_slice(), [.., ('[', _), _])
    }

    /// Ends an object at `end`, before the comma that precedes the next item of its list.
    fn end_before_item(&mut self, end: usize) {
        let next = self.offset;
        self.offset = end;
        self.adjust_bracket_count('}', 1);
        let mistake = Mistake::BracketMissing { expected: '}', found: '{' };
        self.report(Problem::replaced(mistake, end..end, "}").related(next..next + 1));
    }

    fn twice(&mut self, key: &Text, earlier: Range<usize>) {
        if self.placed.len() < MAX_ERRORS {
            let mistake = Mistake::Twice(key.value.clone());
            self.placed.push(Problem::new(mistake, key.span()).related(earlier));
        }
    }

    /// Reads a key with its value; `None` for other text, which is reported.
    fn member(&mut self) -> Result<Option<Member>, LimitReached> {
        let start = self.offset;
        let Some(key) = self.key() else {
            if matches!(self.peek(), Some('{' | '[')) {
                self.report(Problem::new(Mistake::KeyMissing, start..start + 1));
                self.value()?;
            } else {
                let range = self.stray();
                self.report_stray(range);
            }
            return Ok(None);
        };
        let end = self.offset;
        self.gap();
        let colon = self.colon(end);
        let value = match self.value()? {
            Some(value) => value,
            None => {
                self.report(Problem::new(Mistake::ValueMissing { colon }, start..end));
                Node { json: Json::Broken, span: self.below.span(start..end) }
            }
        };
        Ok(Some(Member { key, value }))
    }

    /// Reads a key: a text, or a word without its quotes.
    fn key(&mut self) -> Option<Text> {
        let c = self.peek()?;
        if self.is_quote(c) {
            return Some(self.string(true));
        }
        let length = self.word_length();
        let behind = self.rest().get(length..)?.trim_start_matches([' ', '\t']);
        if length == 0 || !behind.starts_with([':', '=', '"']) {
            return None;
        }
        let range = self.offset..self.offset + length;
        self.offset = range.end;
        let word = self.text.get(range.clone()).unwrap_or("");
        self.report(problem::bare(Mistake::BareKey, range.clone(), word));
        Some(self.verbatim(range))
    }

    /// Reads the colon after a key that ends at `end`. Returns whether there is a colon or a similar sign.
    fn colon(&mut self, end: usize) -> bool {
        let start = self.offset;
        if self.starts(":") {
            self.bump();
        } else if self.starts("=") {
            let length = if self.starts("=>") || self.starts("==") { 2 } else { 1 };
            self.offset += length;
            self.report(Problem::replaced(Mistake::Equals, start..self.offset, ":"));
        } else {
            if !matches!(self.peek(), None | Some(',' | ';' | '}' | ']')) {
                self.report(Problem::replaced(Mistake::ColonMissing, end..end, ":"));
            }
            return false;
        }
        loop {
            self.gap();
            let again = self.offset;
            if !matches!(self.peek(), Some(':' | '=')) {
                return true;
            }
            self.bump();
            self.report(Problem::replaced(Mistake::SecondColon, again..self.offset, ""));
        }
    }

    /// Reads a list.
    fn items(&mut self) -> Result<Node, LimitReached> {
        let start = self.offset;
        self.bump();
        self.enter('[', start)?;
        let mut items = Vec::new();
        let mut first = true;
        let mut end = self.offset;
        loop {
            self.gap();
            match self.peek() {
                None => break self.unclosed(),
                Some(']') => {
                    self.bump();
                    break;
                }
                Some('}') => {
                    if self.wrong_bracket(']', '}') {
                        break;
                    }
                    self.separator(false);
                    continue;
                }
                Some(',') => {
                    self.extra_comma(first);
                    continue;
                }
                // At a key, the list was intended to end before it.
                Some(_) if !first && self.key_ahead() && self.open.iter().any(|(c, _)| *c == '{') => {
                    let key = self.offset;
                    self.offset = end;
                    self.adjust_bracket_count(']', 1);
                    self.report(Problem::replaced(Mistake::ListGoesOn, end..end, "]").related(key..key + 1));
                    break;
                }
                Some(_) => {}
            }
            first = false;
            let item = self.value()?;
            end = self.offset;
            match item {
                Some(item) => items.push(item),
                None => {
                    let range = self.stray();
                    self.report_stray(range);
                }
            }
            self.separator(false);
        }
        self.open.pop();
        Ok(self.node(Json::Array(items), start))
    }
}
