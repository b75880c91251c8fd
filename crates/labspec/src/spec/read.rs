//! Reads single values from JSON. A value of another type gives a problem with the expected type.

use super::problem::{Expected, Mistake, Problem};
use crate::json::{Json, Node, Number, Scalar};
use crate::source::Text;

/// Reads a text.
pub(super) fn text(node: &Node, what: &str, problems: &mut Vec<Problem>) -> Option<Text> {
    match &node.json {
        Json::Text(text) => Some(text.clone()),
        _ => {
            wrong_key(problems, node, what, Expected::Text);
            None
        }
    }
}

/// Reads a number.
pub(super) fn number(node: &Node, what: &str, problems: &mut Vec<Problem>) -> Option<Number> {
    match &node.json {
        Json::Number(value) => Some(Number { value: *value, span: node.span.clone() }),
        _ => {
            wrong_key(problems, node, what, Expected::Number);
            None
        }
    }
}

/// Reads an integer.
pub(super) fn whole(node: &Node, what: &str, problems: &mut Vec<Problem>) -> Option<Number> {
    let number = number(node, what, problems)?;
    if number.value.fract() == 0.0 {
        return Some(number);
    }
    let mistake = Mistake::NotWhole { key: what.to_string(), value: number.value };
    problems.push(mistake.at(node.span.clone()));
    None
}

/// Reads a number, a text or a boolean.
pub(super) fn scalar(node: &Node, what: &str, problems: &mut Vec<Problem>) -> Option<Scalar> {
    match &node.json {
        Json::Number(value) => Some(Scalar::Number(Number { value: *value, span: node.span.clone() })),
        Json::Text(text) => Some(Scalar::Text(text.clone())),
        Json::Bool(b) => Some(Scalar::Bool(*b, node.span.clone())),
        _ => {
            wrong_key(problems, node, what, Expected::Scalar);
            None
        }
    }
}

/// Reports that the value of a key has another type.
pub(super) fn wrong_key(problems: &mut Vec<Problem>, node: &Node, key: &str, expected: Expected) {
    wrong(problems, node, format!("`{key}`"), expected);
}

/// Reports that a value has another type. A value that could not be parsed has been reported already.
pub(super) fn wrong(problems: &mut Vec<Problem>, node: &Node, what: String, expected: Expected) {
    if node.is_broken() {
        return;
    }
    let text = match &node.json {
        Json::Text(text) => Some(text.value.clone()),
        _ => None,
    };
    problems.push(Mistake::Type { what, expected, found: node.describe(), text }.at(node.span.clone()));
}
