//! Values of a program: JavaScript's primitive values and their conversions (ECMAScript, "Type Conversion" and
//! "Testing and Comparison Operations"), what the operators do to values, and
//! references to lists, records and functions, which live in a [`crate::heap::Heap`].

use std::fmt;
use std::sync::Arc;

use crate::number;
use crate::operation::truthy;
use crate::operators::{BinaryOp, LogicalOp, UnaryOp};
use crate::types::{FieldKey, Type};

/// The number of a list, record or function in its [`crate::heap::Heap`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Ref(pub(crate) u32);

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
    /// A list of values, or a copy of an array of the simulation.
    List(Ref),
    /// Values with names.
    Record(Ref),
    /// A function of a text.
    Function(Ref),
    /// An array of the simulation itself: reading and writing its elements reads and writes the simulation.
    View(View),
}

/// A part of a field, in elements of the whole field.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct View {
    /// The field.
    pub field: FieldKey,
    /// Its first element.
    pub first: u32,
    count: u32,
}

impl View {
    /// `count` elements from `first` on; without a count up to the end, which may move while running.
    pub fn new(field: FieldKey, first: usize, count: Option<usize>) -> View {
        let small = |n: usize| u32::try_from(n).unwrap_or(u32::MAX - 1).min(u32::MAX - 1);
        View { field, first: small(first), count: count.map_or(u32::MAX, small) }
    }

    /// Number of elements; `None` when it may change while running.
    pub fn count(self) -> Option<usize> {
        (self.count != u32::MAX).then_some(self.count as usize)
    }
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
            Value::List(_) => Type::List,
            Value::Record(_) => Type::Record,
            Value::Function(_) => Type::Function,
            Value::View(_) => Type::View,
        }
    }

    /// What `typeof` says.
    pub(crate) fn type_name(&self) -> &'static str {
        match self {
            Value::Undefined => "undefined",
            Value::Number(_) => "number",
            Value::Boolean(_) => "boolean",
            Value::String(_) => "string",
            Value::Function(_) => "function",
            Value::Null | Value::List(_) | Value::Record(_) | Value::View(_) => "object",
        }
    }

    /// Whether it is `undefined` or `null`.
    pub fn is_nothing(&self) -> bool {
        matches!(self, Value::Undefined | Value::Null)
    }

    /// Whether it is a number, a truth value, a text or nothing: all that needs no heap.
    pub fn is_primitive(&self) -> bool {
        !matches!(self, Value::List(_) | Value::Record(_) | Value::Function(_) | Value::View(_))
    }

    /// JavaScript's `Number(v)` of a primitive value; of others NaN, see [`crate::heap::Heap::number`].
    pub fn to_number(&self) -> f64 {
        match self {
            Value::Undefined => f64::NAN,
            Value::Null => 0.0,
            Value::Number(x) => *x,
            Value::Boolean(b) => f64::from(u8::from(*b)),
            Value::String(s) => number::from_text(s),
            Value::List(_) | Value::Record(_) | Value::Function(_) | Value::View(_) => f64::NAN,
        }
    }

    /// Whether it is NaN itself.
    pub fn is_nan(&self) -> bool {
        matches!(self, Value::Number(x) if x.is_nan())
    }

    /// JavaScript's `Boolean(v)`: false for `undefined`, `null`, 0, NaN, `false` and the empty string.
    pub fn truthy(&self) -> bool {
        match self {
            Value::Undefined | Value::Null => false,
            Value::Number(x) => truthy(*x),
            Value::Boolean(b) => *b,
            Value::String(s) => !s.is_empty(),
            Value::List(_) | Value::Record(_) | Value::Function(_) | Value::View(_) => true,
        }
    }

    /// `a + b` of primitive values: concatenation when either is a string.
    pub(crate) fn plus(&self, other: &Value) -> Value {
        match (self, other) {
            (Value::String(_), _) | (_, Value::String(_)) => Value::String(format!("{self}{other}").into()),
            _ => Value::Number(self.to_number() + other.to_number()),
        }
    }

    /// Bytes of the text, 0 for what is not text.
    pub fn text_len(&self) -> usize {
        if let Value::String(s) = self { s.len() } else { 0 }
    }

    /// `a === b`
    pub fn strictly_equals(&self, other: &Value) -> bool {
        // Derived equality is exactly that: same type, same value, NaN unlike itself, 0 like -0.
        self == other
    }

    /// `a == b` of primitive values
    pub fn loosely_equals(&self, other: &Value) -> bool {
        match (self, other) {
            (Value::Undefined | Value::Null, Value::Undefined | Value::Null) => true,
            (Value::Undefined | Value::Null, _) | (_, Value::Undefined | Value::Null) => false,
            (Value::String(a), Value::String(b)) => a == b,
            (a, b) if !a.is_primitive() || !b.is_primitive() => a == b,
            _ => self.to_number() == other.to_number(),
        }
    }
}

/// JavaScript's `String(v)` of a primitive value; of others only what it is, see [`crate::heap::Heap::text`].
impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Value::Undefined => f.write_str("undefined"),
            Value::Null => f.write_str("null"),
            Value::Number(x) => f.write_str(&number::to_text(*x)),
            Value::Boolean(b) => write!(f, "{b}"),
            Value::String(s) => f.write_str(s),
            Value::List(_) | Value::View(_) => f.write_str("[object Array]"),
            Value::Record(_) => f.write_str("[object Object]"),
            Value::Function(_) => f.write_str("function"),
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

impl UnaryOp {
    /// The operator on a value.
    pub fn on_value(self, value: &Value) -> Value {
        match self {
            UnaryOp::Not => Value::Boolean(!value.truthy()),
            UnaryOp::TypeOf => value.type_name().into(),
            _ => Value::Number(self.on_number(value.to_number())),
        }
    }
}

impl LogicalOp {
    /// Whether `left op right` is the left operand.
    pub fn keeps(self, left: &Value) -> bool {
        match self {
            LogicalOp::And => !left.truthy(),
            LogicalOp::Or => left.truthy(),
            LogicalOp::Nullish => !left.is_nothing(),
        }
    }
}

impl BinaryOp {
    /// The operator on two values.
    pub fn on_values(self, a: &Value, b: &Value) -> Value {
        match self {
            BinaryOp::Add => a.plus(b),
            BinaryOp::Equal => Value::Boolean(a.loosely_equals(b)),
            BinaryOp::NotEqual => Value::Boolean(!a.loosely_equals(b)),
            BinaryOp::StrictEqual => Value::Boolean(a.strictly_equals(b)),
            BinaryOp::StrictNotEqual => Value::Boolean(!a.strictly_equals(b)),
            _ if self.is_comparison() => match (a, b) {
                (Value::String(x), Value::String(y)) => Value::Boolean(self.on_order(compare_utf16(x, y))),
                _ => Value::Boolean(self.on_numbers(a.to_number(), b.to_number()) != 0.0),
            },
            _ => Value::Number(self.on_numbers(a.to_number(), b.to_number())),
        }
    }

    /// Whether a comparison holds of two things in this order.
    fn on_order(self, order: std::cmp::Ordering) -> bool {
        match self {
            BinaryOp::Less => order.is_lt(),
            BinaryOp::LessEqual => order.is_le(),
            BinaryOp::Greater => order.is_gt(),
            _ => order.is_ge(),
        }
    }
}

/// JavaScript orders strings by UTF-16 code units, which differs from Rust's order beyond the basic plane.
fn compare_utf16(a: &str, b: &str) -> std::cmp::Ordering {
    a.encode_utf16().cmp(b.encode_utf16())
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
