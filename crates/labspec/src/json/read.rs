//! Single values with their spans, and their format in messages.

use crate::source::Text;
use std::ops::Range;

/// A number and its span.
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
    /// A boolean and its span.
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

    /// Whether two values are equal, ignoring their spans.
    pub fn same(&self, other: &Scalar) -> bool {
        match (self, other) {
            (Scalar::Number(a), Scalar::Number(b)) => a.value == b.value,
            (Scalar::Text(a), Scalar::Text(b)) => a.value == b.value,
            (Scalar::Bool(a, _), Scalar::Bool(b, _)) => a == b,
            _ => false,
        }
    }

    /// Its text in JSON.
    pub fn show(&self) -> String {
        match self {
            Scalar::Number(n) => n.value.to_string(),
            Scalar::Text(t) => format!("{:?}", t.value),
            Scalar::Bool(b, _) => b.to_string(),
        }
    }
}

/// A text of the author in backticks; an empty text in quotes.
pub(crate) fn named(text: &str) -> String {
    if text.trim().is_empty() { "\"\"".to_string() } else { format!("`{}`", shorten(text)) }
}

/// A text shortened for a message: a hostile one can be long.
pub(crate) fn shorten(text: &str) -> String {
    let mut short: String = text.chars().take(60).collect();
    if short.len() < text.len() {
        short.push('…');
    }
    short
}
