//! Values without quotes: numbers, `true`, `false`, `null`, and other texts that authors write for them.

use super::node::{Json, Node};
use super::parser::JsonParser;
use super::problem::{self, Mistake, Problem};
use crate::source::Text;
use labspec_finding::distance;
use std::ops::Range;

impl JsonParser<'_> {
    /// Reads a number or a word, or a text without its quotes.
    pub(super) fn literal(&mut self) -> Node {
        let start = self.offset;
        let length = self.rest().find(|c: char| !is_part(c)).unwrap_or(self.rest().len());
        let token = self.rest().get(..length).unwrap_or("");
        let behind = self.rest().get(length..).unwrap_or("").trim_start_matches([' ', '\t']);
        if let Some(json) = exact(token).filter(|_| !computes(behind)) {
            self.offset += length;
            return self.node(json, start);
        }
        // The rest of the line after the word belongs to it, unless the word is a value by itself.
        let word = word(token);
        if !ends_value(behind) && word.is_none() {
            return self.bare_text();
        }
        self.offset += length;
        let range = start..self.offset;
        match word {
            Some(ForeignWord::Means(json, right)) => {
                let mistake = Mistake::Word { word: token.to_string(), right };
                self.report(Problem::replaced(mistake, range, right));
                self.node(json, start)
            }
            Some(ForeignWord::NotFinite) => {
                self.report(Problem::new(Mistake::NotFinite(token.to_string()), range));
                self.node(Json::Broken, start)
            }
            None if is_number(token) => {
                self.report(Problem::new(Mistake::TooLarge, range));
                self.node(Json::Broken, start)
            }
            None => {
                if let Some(right) = repaired(token)
                    && let Ok(value) = right.parse::<f64>()
                {
                    self.report(problem::number_form(range, token, Some(right)));
                    return self.node(Json::Number(value), start);
                }
                if token.starts_with(|c: char| c.is_ascii_digit()) {
                    self.report(problem::number_form(range, token, None));
                    let number = number_before_unit(token).and_then(|number| number.parse::<f64>().ok());
                    return self.node(number.map_or(Json::Broken, Json::Number), start);
                }
                self.offset = start;
                self.bare_text()
            }
        }
    }

    /// Reads a text without quotes: up to the comma or bracket that ends it, or to the end of the line.
    fn bare_text(&mut self) -> Node {
        let range = self.bare_run();
        let start = range.start;
        self.offset = range.end;
        let text = self.text.get(range.clone()).unwrap_or("");
        if text.chars().any(char::is_alphabetic) && !text.starts_with(|c: char| c.is_ascii_digit()) {
            self.report(problem::bare(Mistake::BareText, range.clone(), text));
            let text = self.verbatim(range);
            return self.node(Json::Text(text), start);
        }
        self.report(Problem::new(Mistake::NotJson(text.to_string()), range));
        self.node(Json::Broken, start)
    }

    fn bare_run(&mut self) -> Range<usize> {
        let start = self.offset;
        self.bump();
        let mut depth = usize::from(self.text.get(start..self.offset).is_some_and(|t| t == "("));
        while let Some(c) = self.peek() {
            match c {
                '\n' | '\r' => break,
                ',' | ';' | '}' | ']' if depth == 0 => break,
                '(' | '[' | '{' => depth += 1,
                ')' | ']' | '}' => depth = depth.saturating_sub(1),
                '"' | '\'' => {
                    // Quotes inside brackets belong to a call: data.body("ball").
                    let line = self.line_end();
                    let inside = self.text.get(self.offset + 1..line).unwrap_or("");
                    match inside.find(c).filter(|_| depth > 0) {
                        Some(close) => self.offset += 1 + close,
                        None => break,
                    }
                }
                _ if c.is_whitespace() && self.is_comment(self.offset + c.len_utf8()) => break,
                _ => {}
            }
            self.bump();
        }
        start..start + self.text.get(start..self.offset).map_or(0, |t| t.trim_end().len())
    }

    /// The length of the name that begins here: letters, digits, `_`, `$`, `-`.
    pub(super) fn word_length(&self) -> usize {
        let rest = self.rest();
        rest.find(|c: char| !(c.is_alphanumeric() || matches!(c, '_' | '$' | '-'))).unwrap_or(rest.len())
    }

    /// A text that is copied from the file, byte for byte.
    pub(super) fn verbatim(&self, range: Range<usize>) -> Text {
        let value = self.text.get(range.clone()).unwrap_or("").to_string();
        Text { value, map: crate::source::SourceMap::verbatim(range).then(self.below) }
    }
}

/// The number before a unit: 6 of `6s`.
pub(crate) fn number_before_unit(token: &str) -> Option<&str> {
    let (number, unit) = token.split_at(token.find(char::is_alphabetic)?);
    let is_unit = unit.chars().all(|c| c.is_alphabetic() || matches!(c, '/' | '^' | '\u{b2}'));
    let is_number = number.ends_with(|c: char| c.is_ascii_digit()) && number.parse::<f64>().is_ok();
    (is_unit && is_number).then_some(number)
}

fn is_part(c: char) -> bool {
    c.is_alphanumeric() || matches!(c, '_' | '$' | '.' | '-' | '+')
}

/// Whether the text continues a calculation.
fn computes(behind: &str) -> bool {
    let mut chars = behind.chars();
    match chars.next() {
        Some('*' | '%' | '^' | '&' | '|' | '<' | '>' | '?' | '(') => true,
        Some('/') => !matches!(chars.next(), Some('/' | '*')),
        Some('+' | '-') => matches!(chars.next(), Some(' ')),
        _ => false,
    }
}

/// Whether a value may end before this text.
fn ends_value(behind: &str) -> bool {
    behind.is_empty()
        || behind.starts_with([',', ';', '}', ']', '\n', '\r', '"', '\'', ':', '#'])
        || behind.starts_with("//")
        || behind.starts_with("/*")
        || behind.starts_with(crate::markdown::is_typographic)
}

/// A literal in valid JSON.
fn exact(token: &str) -> Option<Json> {
    match token {
        "true" => Some(Json::Bool(true)),
        "false" => Some(Json::Bool(false)),
        "null" => Some(Json::Null),
        _ => {
            let x = token.parse::<f64>().ok().filter(|_| is_number(token))?;
            x.is_finite().then_some(Json::Number(x))
        }
    }
}

/// A number by JSON's grammar: -? (0 | [1-9][0-9]*) (\. [0-9]+)? ([eE] [+-]? [0-9]+)?
fn is_number(token: &str) -> bool {
    let digits = |t: &str| t.len() - t.trim_start_matches(|c: char| c.is_ascii_digit()).len();
    let mut rest = token.strip_prefix('-').unwrap_or(token);
    let whole = digits(rest);
    if whole == 0 || (whole > 1 && rest.starts_with('0')) {
        return false;
    }
    rest = rest.get(whole..).unwrap_or("");
    if let Some(fraction) = rest.strip_prefix('.') {
        let n = digits(fraction);
        if n == 0 {
            return false;
        }
        rest = fraction.get(n..).unwrap_or("");
    }
    if let Some(exponent) = rest.strip_prefix(['e', 'E']) {
        let exponent = exponent.strip_prefix(['+', '-']).unwrap_or(exponent);
        let n = digits(exponent);
        return n > 0 && n == exponent.len();
    }
    rest.is_empty()
}

/// The intended number in valid JSON.
pub(crate) fn repaired(token: &str) -> Option<String> {
    let (sign, digits) = match token.strip_prefix('-') {
        Some(rest) => ("-", rest),
        None => ("", token.strip_prefix('+').unwrap_or(token)),
    };
    for (prefix, radix) in [("0x", 16), ("0b", 2), ("0o", 8)] {
        if digits.get(..2).is_some_and(|p| p.eq_ignore_ascii_case(prefix)) {
            let n = u32::from_str_radix(digits.get(2..)?, radix).ok()?;
            return Some(format!("{sign}{n}"));
        }
    }
    let mut number = digits.replace('_', "");
    if number.len() < digits.len() && (digits.starts_with('_') || digits.ends_with('_')) {
        return None;
    }
    let zeros = number.len() - number.trim_start_matches('0').len();
    if zeros > 0 && number.get(zeros..).is_some_and(|t| t.starts_with(|c: char| c.is_ascii_digit())) {
        number.replace_range(..zeros, "");
    } else if zeros > 1 {
        number.replace_range(..zeros - 1, "");
    }
    if number.starts_with('.') {
        number.insert(0, '0');
    }
    if let Some(bare) = number.strip_suffix('f') {
        number = bare.to_string();
    }
    if let Some(whole) = number.strip_suffix('.') {
        number = whole.to_string();
    }
    number = number.replace(".e", "e").replace(".E", "E");
    let number = format!("{sign}{number}");
    (is_number(&number) && number.parse::<f64>().is_ok_and(f64::is_finite)).then_some(number)
}

/// A word that denotes a value in another language.
enum ForeignWord {
    Means(Json, &'static str),
    NotFinite,
}

fn word(token: &str) -> Option<ForeignWord> {
    Some(match token.to_ascii_lowercase().as_str() {
        "true" => ForeignWord::Means(Json::Bool(true), "true"),
        "false" => ForeignWord::Means(Json::Bool(false), "false"),
        "null" | "none" | "nil" | "undefined" => ForeignWord::Means(Json::Null, "null"),
        "nan" | "infinity" | "inf" | "-infinity" | "-inf" | "+infinity" | "+inf" | "-nan" | "+nan" => {
            ForeignWord::NotFinite
        }
        misspelt if distance(misspelt, "true") == 1 => ForeignWord::Means(Json::Bool(true), "true"),
        misspelt if distance(misspelt, "false") == 1 => ForeignWord::Means(Json::Bool(false), "false"),
        _ => return None,
    })
}

/// Whether a word denotes a value in JSON or another language.
pub(super) fn is_word(token: &str) -> bool {
    word(token).is_some()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_repaired_only_where_they_are_certain() {
        for (token, right) in [
            ("+1", Some("1")),
            (".5", Some("0.5")),
            ("-.5", Some("-0.5")),
            ("5.", Some("5")),
            ("5.e3", Some("5e3")),
            ("007", Some("7")),
            ("00", Some("0")),
            ("01.5", Some("1.5")),
            ("0x1F", Some("31")),
            ("1_000", Some("1000")),
            ("0.5f", Some("0.5")),
            ("1e", None),
            ("1e999", None),
            ("5kg", None),
            ("--5", None),
            ("1.2.3", None),
            ("", None),
            ("+", None),
        ] {
            assert_eq!(repaired(token).as_deref(), right, "{token}");
        }
    }
}
