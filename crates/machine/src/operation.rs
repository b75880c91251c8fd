//! What the operators mean to numbers, defined once: folding, formulas (by row and by column) and the machine all ask here.
//! The functions of `Math` stand in a table of their own, `math`.
//!
//! Everything is inlined: where an operator is known while this crate is compiled, nothing is left of the choice.

use crate::number::to_int32;
use crate::operators::{BinaryOp, UnaryOp};

/// Whether a number counts as true.
#[inline(always)]
pub fn truthy(x: f64) -> bool {
    x != 0.0 && !x.is_nan()
}

/// A truth value as a number.
#[inline(always)]
pub fn truth(holds: bool) -> f64 {
    f64::from(u8::from(holds))
}

/// `test ? yes : no`
#[inline(always)]
pub fn select<T>(test: f64, yes: T, no: T) -> T {
    if truthy(test) { yes } else { no }
}

impl UnaryOp {
    /// The operator on a number. `typeof` gives a text and never comes here.
    #[inline(always)]
    pub fn on_number(self, x: f64) -> f64 {
        match self {
            UnaryOp::Minus => -x,
            UnaryOp::Not => truth(!truthy(x)),
            UnaryOp::BitNot => f64::from(!to_int32(x)),
            UnaryOp::Plus | UnaryOp::TypeOf => x,
        }
    }
}

impl BinaryOp {
    /// The operator on two numbers; comparisons give 1 or 0.
    #[inline(always)]
    pub fn on_numbers(self, a: f64, b: f64) -> f64 {
        match self {
            BinaryOp::Add => a + b,
            BinaryOp::Subtract => a - b,
            BinaryOp::Multiply => a * b,
            BinaryOp::Divide => a / b,
            BinaryOp::Less => truth(a < b),
            BinaryOp::LessEqual => truth(a <= b),
            BinaryOp::Greater => truth(a > b),
            BinaryOp::GreaterEqual => truth(a >= b),
            BinaryOp::Equal | BinaryOp::StrictEqual => truth(a == b),
            BinaryOp::NotEqual | BinaryOp::StrictNotEqual => truth(a != b),
            _ => self.on_numbers_seldom(a, b),
        }
    }

    /// The rest, in a place of its own: what runs often stays short.
    #[inline(never)]
    fn on_numbers_seldom(self, a: f64, b: f64) -> f64 {
        match self {
            // Rust's remainder has the sign of the dividend, as JavaScript's.
            BinaryOp::Remainder => a % b,
            BinaryOp::Power => crate::math::pow(a, b),
            BinaryOp::BitAnd => f64::from(to_int32(a) & to_int32(b)),
            BinaryOp::BitOr => f64::from(to_int32(a) | to_int32(b)),
            BinaryOp::BitXor => f64::from(to_int32(a) ^ to_int32(b)),
            // Only the low five bits of a shift count.
            BinaryOp::ShiftLeft => f64::from(to_int32(a).wrapping_shl(to_int32(b) as u32)),
            BinaryOp::ShiftRight => f64::from(to_int32(a).wrapping_shr(to_int32(b) as u32)),
            BinaryOp::ShiftRightUnsigned => f64::from((to_int32(a) as u32).wrapping_shr(to_int32(b) as u32)),
            BinaryOp::Add
            | BinaryOp::Subtract
            | BinaryOp::Multiply
            | BinaryOp::Divide
            | BinaryOp::Less
            | BinaryOp::LessEqual
            | BinaryOp::Greater
            | BinaryOp::GreaterEqual
            | BinaryOp::Equal
            | BinaryOp::StrictEqual
            | BinaryOp::NotEqual
            | BinaryOp::StrictNotEqual => self.on_numbers(a, b),
        }
    }
}

/// `$run` of an operator between two numbers; of a frequent one it is known which it is, and the choice costs nothing.
#[macro_export]
macro_rules! known_operator {
    ($op:expr, $run:expr) => {
        match $op {
            BinaryOp::Add => $run(BinaryOp::Add),
            BinaryOp::Subtract => $run(BinaryOp::Subtract),
            BinaryOp::Multiply => $run(BinaryOp::Multiply),
            BinaryOp::Divide => $run(BinaryOp::Divide),
            BinaryOp::Less => $run(BinaryOp::Less),
            BinaryOp::LessEqual => $run(BinaryOp::LessEqual),
            BinaryOp::Greater => $run(BinaryOp::Greater),
            BinaryOp::GreaterEqual => $run(BinaryOp::GreaterEqual),
            other => $run(other),
        }
    };
}
pub use known_operator;
