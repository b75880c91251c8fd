//! The operators: how they are written, how tightly they bind, and what they do to values (ECMAScript, chapter
//! "Expressions"). Parser, printer, constant folding and the machine all use these definitions.

use crate::value::Value;

/// Operators before one operand.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum UnaryOp {
    /// `-x`
    Minus,
    /// `+x`, the conversion to a number
    Plus,
    /// `!x`
    Not,
    /// `~x`
    BitNot,
    /// `typeof x`
    TypeOf,
}

impl UnaryOp {
    /// How it is written.
    pub fn symbol(self) -> &'static str {
        match self {
            UnaryOp::Minus => "-",
            UnaryOp::Plus => "+",
            UnaryOp::Not => "!",
            UnaryOp::BitNot => "~",
            UnaryOp::TypeOf => "typeof",
        }
    }
}

impl UnaryOp {
    /// The operator on a value.
    pub(crate) fn on_value(self, value: &Value) -> Value {
        match self {
            UnaryOp::Not => Value::Boolean(!value.truthy()),
            UnaryOp::TypeOf => value.type_name().into(),
            _ => Value::Number(self.on_number(value.to_number())),
        }
    }
}

/// Operators that choose one of their operands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum LogicalOp {
    /// `&&`
    And,
    /// `||`
    Or,
    /// `??`
    Nullish,
}

impl LogicalOp {
    /// All of them.
    pub const ALL: [LogicalOp; 3] = [LogicalOp::And, LogicalOp::Or, LogicalOp::Nullish];

    /// How it is written.
    pub fn symbol(self) -> &'static str {
        match self {
            LogicalOp::And => "&&",
            LogicalOp::Or => "||",
            LogicalOp::Nullish => "??",
        }
    }

    /// Whether `left op right` is the left operand.
    pub(crate) fn keeps(self, left: &Value) -> bool {
        match self {
            LogicalOp::And => !left.truthy(),
            LogicalOp::Or => left.truthy(),
            LogicalOp::Nullish => !left.is_nothing(),
        }
    }

    /// Binding power, see [`BinaryOp::power`].
    pub fn power(self) -> u8 {
        match self {
            LogicalOp::Or | LogicalOp::Nullish => 3,
            LogicalOp::And => 4,
        }
    }
}

/// Operators between two operands that evaluate both.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[allow(missing_docs)] // `symbol` says what each is
pub enum BinaryOp {
    Add,
    Subtract,
    Multiply,
    Divide,
    Remainder,
    Power,
    BitAnd,
    BitOr,
    BitXor,
    ShiftLeft,
    ShiftRight,
    ShiftRightUnsigned,
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
    Equal,
    NotEqual,
    StrictEqual,
    StrictNotEqual,
}

impl BinaryOp {
    /// All of them.
    pub const ALL: [BinaryOp; 20] = [
        BinaryOp::Add,
        BinaryOp::Subtract,
        BinaryOp::Multiply,
        BinaryOp::Divide,
        BinaryOp::Remainder,
        BinaryOp::Power,
        BinaryOp::BitAnd,
        BinaryOp::BitOr,
        BinaryOp::BitXor,
        BinaryOp::ShiftLeft,
        BinaryOp::ShiftRight,
        BinaryOp::ShiftRightUnsigned,
        BinaryOp::Less,
        BinaryOp::LessEqual,
        BinaryOp::Greater,
        BinaryOp::GreaterEqual,
        BinaryOp::Equal,
        BinaryOp::NotEqual,
        BinaryOp::StrictEqual,
        BinaryOp::StrictNotEqual,
    ];

    /// How it is written.
    pub fn symbol(self) -> &'static str {
        match self {
            BinaryOp::Add => "+",
            BinaryOp::Subtract => "-",
            BinaryOp::Multiply => "*",
            BinaryOp::Divide => "/",
            BinaryOp::Remainder => "%",
            BinaryOp::Power => "**",
            BinaryOp::BitAnd => "&",
            BinaryOp::BitOr => "|",
            BinaryOp::BitXor => "^",
            BinaryOp::ShiftLeft => "<<",
            BinaryOp::ShiftRight => ">>",
            BinaryOp::ShiftRightUnsigned => ">>>",
            BinaryOp::Less => "<",
            BinaryOp::LessEqual => "<=",
            BinaryOp::Greater => ">",
            BinaryOp::GreaterEqual => ">=",
            BinaryOp::Equal => "==",
            BinaryOp::NotEqual => "!=",
            BinaryOp::StrictEqual => "===",
            BinaryOp::StrictNotEqual => "!==",
        }
    }

    /// How tightly it binds; higher is tighter. 1 is assignment, 2 is `? :`, 15 is a sign, 17 is a member.
    pub fn power(self) -> u8 {
        match self {
            BinaryOp::BitOr => 5,
            BinaryOp::BitXor => 6,
            BinaryOp::BitAnd => 7,
            BinaryOp::Equal | BinaryOp::NotEqual | BinaryOp::StrictEqual | BinaryOp::StrictNotEqual => 8,
            BinaryOp::Less | BinaryOp::LessEqual | BinaryOp::Greater | BinaryOp::GreaterEqual => 9,
            BinaryOp::ShiftLeft | BinaryOp::ShiftRight | BinaryOp::ShiftRightUnsigned => 10,
            BinaryOp::Add | BinaryOp::Subtract => 11,
            BinaryOp::Multiply | BinaryOp::Divide | BinaryOp::Remainder => 12,
            BinaryOp::Power => 14,
        }
    }

    /// Whether the result is `true` or `false`.
    pub fn is_comparison(self) -> bool {
        matches!(self.power(), 8 | 9)
    }

    /// The operator on two values.
    pub(crate) fn on_values(self, a: &Value, b: &Value) -> Value {
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
