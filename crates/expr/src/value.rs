//! Values of a program: JavaScript's primitive values and their conversions (ECMAScript, "Type Conversion" and
//! "Testing and Comparison Operations").

use std::fmt;
use std::sync::Arc;

use crate::number;
use crate::schema::Type;

/// A value of JavaScript.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Value {
    /// `undefined`
    #[default]
    Undefined,
    /// `null`
    Null,
    /// A double.
    Number(f64),
    /// `true` or `false`
    Boolean(bool),
    /// Text.
    String(Arc<str>),
}

impl Value {
    /// The type of this value.
    pub fn type_of(&self) -> Type {
        match self {
            Value::Undefined => Type::Undefined,
            Value::Null => Type::Null,
            Value::Number(_) => Type::Number,
            Value::Boolean(_) => Type::Boolean,
            Value::String(_) => Type::String,
        }
    }

    /// JavaScript's `Number(v)`.
    pub fn to_number(&self) -> f64 {
        match self {
            Value::Undefined => f64::NAN,
            Value::Null => 0.0,
            Value::Number(x) => *x,
            Value::Boolean(b) => f64::from(u8::from(*b)),
            Value::String(s) => number::from_text(s),
        }
    }

    /// JavaScript's `Boolean(v)`: false for `undefined`, `null`, 0, NaN, `false` and the empty string.
    pub fn truthy(&self) -> bool {
        match self {
            Value::Undefined | Value::Null => false,
            Value::Number(x) => truthy(*x),
            Value::Boolean(b) => *b,
            Value::String(s) => !s.is_empty(),
        }
    }

    /// `a + b`: concatenation when either is a string.
    pub(crate) fn plus(&self, other: &Value) -> Value {
        match (self, other) {
            (Value::String(_), _) | (_, Value::String(_)) => Value::String(format!("{self}{other}").into()),
            _ => Value::Number(self.to_number() + other.to_number()),
        }
    }

    /// Bytes of the text, 0 for what is not text.
    pub(crate) fn text_len(&self) -> usize {
        if let Value::String(s) = self { s.len() } else { 0 }
    }

    /// `a === b`
    pub fn strictly_equals(&self, other: &Value) -> bool {
        // Derived equality is exactly that: same type, same value, NaN unlike itself, 0 like -0.
        self == other
    }

    /// `a == b`
    pub fn loosely_equals(&self, other: &Value) -> bool {
        match (self, other) {
            (Value::Undefined | Value::Null, Value::Undefined | Value::Null) => true,
            (Value::Undefined | Value::Null, _) | (_, Value::Undefined | Value::Null) => false,
            (Value::String(a), Value::String(b)) => a == b,
            _ => self.to_number() == other.to_number(),
        }
    }
}

/// Whether a number counts as true.
#[inline]
pub(crate) fn truthy(x: f64) -> bool {
    x != 0.0 && !x.is_nan()
}

/// JavaScript's `String(v)`.
impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Value::Undefined => f.write_str("undefined"),
            Value::Null => f.write_str("null"),
            Value::Number(x) => f.write_str(&number::to_text(*x)),
            Value::Boolean(b) => write!(f, "{b}"),
            Value::String(s) => f.write_str(s),
        }
    }
}

impl From<f64> for Value {
    fn from(x: f64) -> Value {
        Value::Number(x)
    }
}

impl From<bool> for Value {
    fn from(b: bool) -> Value {
        Value::Boolean(b)
    }
}

impl From<&str> for Value {
    fn from(s: &str) -> Value {
        Value::String(s.into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn loose_equality() {
        let text = |s: &str| Value::from(s);
        assert!(Value::Null.loosely_equals(&Value::Undefined));
        assert!(!Value::Null.loosely_equals(&Value::Number(0.0)));
        assert!(text("0").loosely_equals(&Value::Boolean(false)));
        assert!(text("").loosely_equals(&Value::Number(0.0)));
        assert!(!text("a").loosely_equals(&Value::Number(f64::NAN)));
        assert!(!Value::Number(f64::NAN).strictly_equals(&Value::Number(f64::NAN)));
        assert!(Value::Number(0.0).strictly_equals(&Value::Number(-0.0)));
        assert!(!Value::Number(1.0).strictly_equals(&Value::Boolean(true)));
    }

    #[test]
    fn plus_concatenates_when_one_side_is_text() {
        assert_eq!(Value::from("q").plus(&Value::Number(2.0)), Value::from("q2"));
        assert_eq!(Value::Null.plus(&Value::from("!")), Value::from("null!"));
        assert_eq!(Value::Boolean(true).plus(&Value::Number(2.0)), Value::Number(3.0));
    }
}
