//! Reads single values out of JSON: each of its type, or a finding that says what it should be.

use super::literal::repaired;
use super::{Json, Node};
use crate::finding::Finding;
use crate::rules;
use crate::source::Text;
use std::ops::Range;

/// A number and its place.
#[derive(Clone, Debug, PartialEq)]
pub struct Number {
    /// The number; finite.
    pub value: f64,
    /// Bytes of the file.
    pub span: Range<usize>,
}

/// A value that a control can take.
#[derive(Clone, Debug, PartialEq)]
pub enum Scalar {
    /// A number.
    Number(Number),
    /// A text.
    Text(Text),
    /// A truth value and its place.
    Bool(bool, Range<usize>),
}

impl Scalar {
    /// Bytes of the file.
    pub fn span(&self) -> Range<usize> {
        match self {
            Scalar::Number(n) => n.span.clone(),
            Scalar::Text(t) => t.span(),
            Scalar::Bool(_, span) => span.clone(),
        }
    }

    /// The number, if it is one.
    pub fn number(&self) -> Option<f64> {
        match self {
            Scalar::Number(n) => Some(n.value),
            _ => None,
        }
    }

    /// Whether two values are the same, wherever they stand.
    pub fn same(&self, other: &Scalar) -> bool {
        match (self, other) {
            (Scalar::Number(a), Scalar::Number(b)) => a.value == b.value,
            (Scalar::Text(a), Scalar::Text(b)) => a.value == b.value,
            (Scalar::Bool(a, _), Scalar::Bool(b, _)) => a == b,
            _ => false,
        }
    }

    /// As it stands in JSON.
    pub fn show(&self) -> String {
        match self {
            Scalar::Number(n) => n.value.to_string(),
            Scalar::Text(t) => format!("{:?}", t.value),
            Scalar::Bool(b, _) => b.to_string(),
        }
    }
}

/// A text, or a finding.
pub(crate) fn text(node: &Node, what: &str, findings: &mut Vec<Finding>) -> Option<Text> {
    match &node.json {
        Json::Text(text) => Some(text.clone()),
        _ => {
            wrong_key(findings, node, what, "a text in double quotes");
            None
        }
    }
}

/// A number, or a finding.
pub(crate) fn number(node: &Node, what: &str, findings: &mut Vec<Finding>) -> Option<Number> {
    match &node.json {
        Json::Number(value) => Some(Number { value: *value, span: node.span.clone() }),
        _ => {
            wrong_key(findings, node, what, "a number, without quotes");
            None
        }
    }
}

/// A number without decimals, or a finding.
pub(crate) fn whole(node: &Node, what: &str, findings: &mut Vec<Finding>) -> Option<Number> {
    let number = number(node, what, findings)?;
    if number.value.fract() == 0.0 {
        return Some(number);
    }
    findings.push(
        Finding::new(
            rules::WRONG_TYPE,
            node.span.clone(),
            format!("`{what}` is a whole number, not {}", number.value),
        )
        .help("write a number without a point"),
    );
    None
}

/// A number, a text or a truth value, or a finding.
pub(crate) fn scalar(node: &Node, what: &str, findings: &mut Vec<Finding>) -> Option<Scalar> {
    match &node.json {
        Json::Number(value) => Some(Scalar::Number(Number { value: *value, span: node.span.clone() })),
        Json::Text(text) => Some(Scalar::Text(text.clone())),
        Json::Bool(b) => Some(Scalar::Bool(*b, node.span.clone())),
        _ => {
            wrong_key(findings, node, what, "a number, a text or true/false");
            None
        }
    }
}

/// Says that the value of a key has another type.
pub(crate) fn wrong_key(findings: &mut Vec<Finding>, node: &Node, key: &str, expected: &str) {
    wrong(findings, node, &format!("`{key}`"), expected);
}

/// Says that something has another type.
pub(crate) fn wrong(findings: &mut Vec<Finding>, node: &Node, what: &str, expected: &str) {
    if node.is_broken() {
        return;
    }
    let finding = Finding::new(
        rules::WRONG_TYPE,
        node.span.clone(),
        format!("{what} must be {expected}; this is {}", node.describe()),
    );
    // "5" for 5 is the common case, and it has one repair.
    findings.push(match &node.json {
        Json::Text(text) if expected.starts_with("a number") => match repaired(text.value.trim()) {
            Some(bare) => {
                finding.help(format!("write {bare} without the quotes")).fix(node.span.clone(), bare)
            }
            None => finding.help(format!("write {expected}")),
        },
        Json::Text(text) if expected.starts_with("true or false") && is_flag(&text.value) => {
            let bare = text.value.trim().to_string();
            finding.help(format!("write {bare} without the quotes")).fix(node.span.clone(), bare)
        }
        Json::Number(_) if expected.starts_with("a text") => finding.help("put quotes around it"),
        _ => finding.help(format!("write {expected}")),
    });
}

fn is_flag(text: &str) -> bool {
    matches!(text.trim(), "true" | "false")
}

/// What an author wrote, in backticks; nothing is named as that.
pub(crate) fn named(text: &str) -> String {
    if text.trim().is_empty() { "\"\"".to_string() } else { format!("`{}`", shorten(text)) }
}

/// A key as it may be shown: a hostile one can be long.
pub(crate) fn shorten(text: &str) -> String {
    let mut short: String = text.chars().take(60).collect();
    if short.len() < text.len() {
        short.push('…');
    }
    short
}
