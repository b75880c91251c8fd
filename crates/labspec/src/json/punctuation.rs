//! Commas and brackets, and recovery when one is missing or superfluous.

use super::parser::JsonParser;
use super::problem::{self, Mistake, Problem};
use std::ops::Range;

impl JsonParser<'_> {
    /// Reads the separator after a value: a comma, or the end of the enclosing value.
    pub(super) fn separator(&mut self, object: bool) {
        let mut end = self.before();
        self.gap();
        loop {
            let start = self.offset;
            match self.peek() {
                None | Some('}' | ']') => return,
                Some(',') => {
                    self.bump();
                    // The second half of a number with a decimal comma.
                    if object && self.peek().is_some_and(|c| c.is_ascii_digit()) && self.digit_before(start) {
                        while self.peek().is_some_and(|c| c.is_ascii_digit()) {
                            self.bump();
                        }
                        let mistake = Mistake::DecimalComma(self.with_point(start));
                        self.report(Problem::replaced(mistake, start..start + 1, "."));
                        end = self.before();
                        self.gap();
                        continue;
                    }
                    self.gap();
                    if matches!(self.peek(), None | Some('}' | ']')) {
                        self.report(Problem::replaced(Mistake::TrailingComma, start..start + 1, ""));
                    }
                    return;
                }
                Some(';') => {
                    self.bump();
                    self.report(Problem::replaced(Mistake::Semicolon, start..start + 1, ","));
                    return;
                }
                Some(c) if self.begins(c, object) => {
                    self.report(Problem::replaced(Mistake::CommaMissing, end..end, ","));
                    return;
                }
                Some(_) => {
                    let range = self.stray();
                    self.report_stray(range);
                    end = self.before();
                    self.gap();
                }
            }
        }
    }

    fn digit_before(&self, offset: usize) -> bool {
        self.text.get(..offset).is_some_and(|t| t.ends_with(|c: char| c.is_ascii_digit()))
    }

    /// Whether the next item begins with this character.
    fn begins(&self, c: char, object: bool) -> bool {
        if self.is_quote(c) {
            return true;
        }
        if object {
            let behind = self.rest().get(self.word_length()..).unwrap_or("");
            self.word_length() > 0 && behind.trim_start_matches([' ', '\t']).starts_with([':', '='])
        } else {
            c.is_alphanumeric() || matches!(c, '{' | '[' | '-' | '+' | '.')
        }
    }

    /// Skips text that has no place in the grammar: up to the next comma, bracket, quote or line end.
    pub(super) fn stray(&mut self) -> Range<usize> {
        let start = self.offset;
        self.bump();
        while let Some(c) = self.peek() {
            if matches!(c, ',' | ';' | '\n' | '\r' | '{' | '}' | '[' | ']') || self.is_quote(c) {
                break;
            }
            if c.is_whitespace() && self.is_comment(self.offset + c.len_utf8()) {
                break;
            }
            self.bump();
        }
        start..start + self.text.get(start..self.offset).map_or(0, |t| t.trim_end().len())
    }

    pub(super) fn extra_comma(&mut self, first: bool) {
        let start = self.offset;
        self.bump();
        self.report(Problem::replaced(Mistake::ExtraComma { first }, start..start + 1, ""));
    }

    /// Reports once that the text ends inside brackets, with all missing ones.
    pub(super) fn unclosed(&mut self) {
        if std::mem::replace(&mut self.ended, true) {
            return;
        }
        let end = self.text.trim_end().len();
        self.report(problem::unclosed(&self.open, end));
    }

    /// Whether a `}` ends the whole value although members follow.
    pub(super) fn closes_too_early(&self) -> bool {
        let [open, close, ..] = self.brackets;
        self.open.len() == 1
            && close > open
            && self.rest().get(1..).is_some_and(|t| t.trim_start().starts_with(','))
    }

    pub(super) fn stray_bracket(&mut self) {
        let start = self.offset;
        let c = self.peek().unwrap_or('}');
        self.bump();
        self.adjust_bracket_count(c, -1);
        self.report(Problem::replaced(Mistake::StrayBracket(c), start..start + 1, ""));
    }

    /// Handles a bracket of the other kind. Returns whether the current value ends here.
    pub(super) fn wrong_bracket(&mut self, expected: char, found: char) -> bool {
        let start = self.offset;
        let [braces, closed_braces, lists, closed_lists] = self.brackets;
        let (is_expected_missing, found_extra) = match expected {
            '}' => (braces > closed_braces, closed_lists > lists),
            _ => (lists > closed_lists, closed_braces > braces),
        };
        let outer = self.open.iter().any(|(c, _)| (*c == '[') == (found == ']'));
        match (outer, is_expected_missing, found_extra) {
            // The other bracket was intended.
            (_, true, true) | (false, true, _) => {
                self.bump();
                self.adjust_bracket_count(found, -1);
                self.adjust_bracket_count(expected, 1);
                self.report(Problem::replaced(
                    Mistake::OtherBracket { expected, found },
                    start..start + 1,
                    expected,
                ));
                true
            }
            (true, true, false) | (true, false, false) => {
                let end = self.before();
                self.adjust_bracket_count(expected, 1);
                let mistake = Mistake::BracketMissing { expected, found };
                self.report(Problem::replaced(mistake, end..end, expected).related(start..start + 1));
                true
            }
            (true, false, true) | (false, false, _) => {
                self.stray_bracket();
                false
            }
        }
    }

    /// The number with a comma at `comma` that ends here, with a point.
    fn with_point(&self, comma: usize) -> String {
        let before = self.text.get(..comma).unwrap_or("");
        let start = before.trim_end_matches(|c: char| c.is_ascii_digit() || c == '-').len();
        let [whole, decimals] =
            [start..comma, comma + 1..self.offset].map(|part| self.text.get(part).unwrap_or(""));
        format!("{whole}.{decimals}")
    }

    /// Whether a quote in place of a key is the last character of its line, and a key begins on the next line.
    pub(super) fn is_lone_quote(&self) -> bool {
        let behind = self.rest().get(1..).unwrap_or("");
        let line = behind.trim_start_matches([' ', '\t']);
        let key = line
            .trim_start()
            .strip_prefix('"')
            .map(|k| k.trim_start_matches(|c: char| c.is_alphanumeric() || c == '_'));
        line.starts_with(['\n', '\r']) && key.is_some_and(|k| k.starts_with('"'))
    }

    pub(super) fn adjust_bracket_count(&mut self, bracket: char, by: i64) {
        let i = ['{', '}', '[', ']'].iter().position(|c| *c == bracket);
        if let Some(n) = i.and_then(|i| self.brackets.get_mut(i)) {
            *n += by;
        }
    }
}
