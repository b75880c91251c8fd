//! The numeric meaning of the operators, defined once: folding, formulas (by row and by column) and the virtual machine use it.
//! The functions of `Math` have a separate table, `math`.
//!
//! Everything is inlined, so that an operator that is known at compile time costs no dispatch.

use crate::number::to_int32;
use crate::operators::{BinaryOp, UnaryOp};

/// Whether a number is truthy.
#[inline(always)]
pub fn truthy(x: f64) -> bool {
    x != 0.0 && !x.is_nan()
}

/// A boolean as a number.
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
    /// Applies the operator to a number. `typeof` gives a string and is not used here.
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
    /// Applies the operator to two numbers; comparisons give 1 or 0.
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
            _ => self.on_numbers_rare(a, b),
        }
    }

    /// The less frequent operators, out of line, so that frequently executed code stays short.
    #[inline(never)]
    fn on_numbers_rare(self, a: f64, b: f64) -> f64 {
        match self {
            // Rust's remainder has the sign of the dividend, as in JavaScript.
            BinaryOp::Remainder => a % b,
            BinaryOp::Power => crate::math::pow(a, b),
            BinaryOp::BitAnd => f64::from(to_int32(a) & to_int32(b)),
            BinaryOp::BitOr => f64::from(to_int32(a) | to_int32(b)),
            BinaryOp::BitXor => f64::from(to_int32(a) ^ to_int32(b)),
            // Only the low five bits of the shift count are used.
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

/// Evaluates `$run` with the operator as a constant if it is a frequent one, so that the dispatch happens only once.
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
