//! Converts the text of an attribute to a checked value: finite numbers, as many as the schema requires, and keywords that exist.

use std::ops::Range;
use std::rc::Rc;

use super::diagnostic::{nearest, shorten_name};
use crate::mjcf::gather::listed;
use crate::mjcf::rules::{self, Rule};
use crate::mjcf::schema::{AttributeType, Keyword};

/// The value of an attribute. Lists are shared between all copies of an element and all elements that take a default.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Value {
    /// Real numbers, all finite.
    Reals(Rc<Vec<f64>>),
    /// Integers.
    Ints(Rc<Vec<i32>>),
    /// MuJoCo's number of a keyword.
    Keyword(i32),
    /// A name or free text.
    Text(String),
    /// Invalid, and already reported: the attribute is present, but its value must not be used.
    Bad,
}

/// The longest name, bytes. Each reference to an object stores its name, and defaults copy it to many elements.
const LONGEST_NAME: usize = 1000;

/// The reason why a value is invalid.
#[derive(Debug)]
pub(crate) struct ValueProblem {
    pub(crate) code: &'static Rule,
    /// The invalid bytes of the value's text, or `None` for all of it.
    pub(crate) span: Option<Range<usize>>,
    /// The end of a sentence that starts with the attribute: "`size` of geom …".
    pub(crate) message: String,
    pub(crate) help: Option<String>,
}

impl ValueProblem {
    fn new(code: &'static Rule, message: String) -> ValueProblem {
        ValueProblem { code, span: None, message, help: None }
    }
}

/// Reads a value of the given type.
pub(crate) fn parse(kind: AttributeType, text: &str) -> Result<Value, ValueProblem> {
    match kind {
        AttributeType::Reals(min, max) => {
            let numbers = numbers(text, real)?;
            check_count(numbers.len(), min, max, "number").map(|()| Value::Reals(numbers.into()))
        }
        AttributeType::Ints(min, max) => {
            let numbers = numbers(text, integer)?;
            check_count(numbers.len(), min, max, "integer").map(|()| Value::Ints(numbers.into()))
        }
        AttributeType::Keywords(words) => keyword(words, text),
        AttributeType::Name(_) | AttributeType::Ref(_) | AttributeType::Class
            if text.len() > LONGEST_NAME =>
        {
            Err(ValueProblem::new(
                rules::LIMIT,
                format!("is too long: {} bytes, but a name can have at most {LONGEST_NAME}", text.len()),
            ))
        }
        AttributeType::Name(_) | AttributeType::Ref(_) | AttributeType::Class | AttributeType::Text => {
            Ok(Value::Text(text.to_string()))
        }
    }
}

fn keyword(words: &[Keyword], text: &str) -> Result<Value, ValueProblem> {
    if let Some(word) = words.iter().find(|w| w.text == text) {
        if word.supported {
            return Ok(Value::Keyword(word.value));
        }
        let mut problem = ValueProblem::new(
            rules::NOT_SUPPORTED,
            format!("is {}, which is not supported yet", shorten_name(text)),
        );
        problem.help = Some(format!("supported: {}", list_keywords(words)));
        return Err(problem);
    }
    let mut problem = ValueProblem::new(
        rules::KEYWORD,
        format!("is {}, which is not an allowed keyword", shorten_name(text)),
    );
    problem.help = Some(match nearest(text.trim(), words.iter().filter(|w| w.supported).map(|w| w.text)) {
        Some(word) => format!("did you mean `{word}`?"),
        None => format!("write one of: {}", list_keywords(words)),
    });
    Err(problem)
}

/// The keywords that are supported.
fn list_keywords(words: &[Keyword]) -> String {
    listed(words.iter().filter(|w| w.supported).map(|w| w.text)).join(", ")
}

/// The words of a text, each converted by `read`. Errors contain the bytes of the word.
fn numbers<T>(text: &str, read: impl Fn(&str) -> Result<T, ValueProblem>) -> Result<Vec<T>, ValueProblem> {
    let mut list = Vec::new();
    let mut rest = text;
    loop {
        rest = rest.trim_start_matches(is_space);
        if rest.is_empty() {
            return Ok(list);
        }
        let end = rest.find(is_space).unwrap_or(rest.len());
        let (word, after) = rest.split_at(end);
        let start = text.len() - rest.len();
        list.push(read(word).map_err(|p| ValueProblem { span: Some(start..start + end), ..p })?);
        rest = after;
    }
}

fn is_space(c: char) -> bool {
    matches!(c, ' ' | '\t' | '\n' | '\r')
}

fn real(word: &str) -> Result<f64, ValueProblem> {
    let plain = word.bytes().all(|b| b.is_ascii_digit() || matches!(b, b'+' | b'-' | b'.' | b'e' | b'E'));
    match word.parse::<f64>() {
        Ok(x) if plain && x.is_finite() => Ok(x),
        Ok(_) if plain => Err(ValueProblem::new(
            rules::NUMBER,
            format!("has {}, which exceeds a 64-bit number", shorten_name(word)),
        )),
        Ok(_) => Err(ValueProblem::new(
            rules::NUMBER,
            format!("has {}, but numbers must be finite", shorten_name(word)),
        )),
        Err(_) => Err(not_a_number(word, "number")),
    }
}

fn integer(word: &str) -> Result<i32, ValueProblem> {
    if let Ok(n) = word.parse::<i32>() {
        return Ok(n);
    }
    let digits = word.trim_start_matches(['+', '-']);
    if !digits.is_empty() && digits.bytes().all(|b| b.is_ascii_digit()) {
        return Err(ValueProblem::new(
            rules::NUMBER,
            format!("has {}, which does not fit into a 32-bit integer", shorten_name(word)),
        ));
    }
    Err(not_a_number(word, "integer"))
}

fn not_a_number(word: &str, noun: &str) -> ValueProblem {
    let mut problem = ValueProblem::new(
        rules::NUMBER,
        format!("has {}, which is not {} {noun}", shorten_name(word), article(noun)),
    );
    if word.contains(',') {
        let parts: Vec<&str> = word.split(',').filter(|part| !part.is_empty()).collect();
        let are_numbers = parts.iter().all(|part| part.parse::<f64>().is_ok());
        problem.help = Some(match parts.as_slice() {
            [whole, decimals] if are_numbers && decimals.bytes().all(|b| b.is_ascii_digit()) => {
                format!("write `{whole}.{decimals}` for one number, or `{whole} {decimals}` for two")
            }
            all if are_numbers && !all.is_empty() => format!("write `{}`, with spaces", all.join(" ")),
            _ => "separate numbers by spaces and write decimals with a point".into(),
        });
    } else if let Some(number) = number_before_unit(word) {
        problem.help = Some(format!("write `{number}`, without the unit"));
    }
    problem
}

/// The number before a unit: 0.002 of `0.002s`.
fn number_before_unit(word: &str) -> Option<&str> {
    let (number, unit) = word.split_at(word.find(char::is_alphabetic)?);
    let is_unit = unit.chars().all(char::is_alphabetic);
    (is_unit && number.parse::<f64>().is_ok()).then_some(number)
}

fn article(noun: &str) -> &'static str {
    if noun.starts_with('i') { "an" } else { "a" }
}

fn check_count(n: usize, min: usize, max: usize, noun: &str) -> Result<(), ValueProblem> {
    if (min..=max).contains(&n) {
        return Ok(());
    }
    let has = match n {
        0 => format!("has no {noun}"),
        1 => format!("has 1 {noun}"),
        _ => format!("has {n} {noun}s"),
    };
    let needs = match (min, max) {
        (1, 1) => "exactly one".to_string(),
        (a, b) if a == b => format!("exactly {a}"),
        (_, b) if n > b => format!("at most {b}"),
        (a, _) => format!("at least {a}"),
    };
    Err(ValueProblem::new(rules::COUNT, format!("{has}, but needs {needs}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn reals(text: &str) -> Option<Vec<f64>> {
        match parse(AttributeType::Reals(0, 9), text) {
            Ok(Value::Reals(v)) => Some(v.to_vec()),
            _ => None,
        }
    }

    #[test]
    fn numbers_are_those_of_xml_and_finite() {
        assert_eq!(reals(" 1\t-2.5\n+3e2 .5 5. "), Some(vec![1.0, -2.5, 300.0, 0.5, 5.0]));
        for bad in ["nan", "inf", "infinity", "1e999", "0x10", "1,2", "1e", "--1", "½"] {
            assert_eq!(reals(bad), None, "{bad}");
        }
    }

    #[test]
    fn a_problem_points_at_the_number() {
        let problem = parse(AttributeType::Reals(3, 3), "1  x2 3").unwrap_err();
        assert_eq!(problem.span, Some(3..5));
        assert_eq!(parse(AttributeType::Ints(1, 1), "99999999999").unwrap_err().code, rules::NUMBER);
        assert_eq!(
            parse(AttributeType::Reals(2, 3), "1").unwrap_err().message,
            "has 1 number, but needs at least 2"
        );
    }
}
