//! Operations on the accumulator.

use crate::operators::{BinaryOp, UnaryOp};

/// An operation on the accumulator `x`; `r` is a register and `k` a constant. The most frequent operations have separate
/// variants, and so does each order of their operands.
#[derive(Clone, Copy, Debug)]
pub enum RowOp {
    /// x = r
    Take(u8),
    /// r = x
    Keep(u8),
    /// r = k
    Put(u8, f64),
    /// x + r
    Add(u8),
    /// x - r
    Subtract(u8),
    /// r - x
    SubtractFrom(u8),
    /// x r
    Multiply(u8),
    /// x / r
    Divide(u8),
    /// r / x
    DivideInto(u8),
    /// x + k
    AddConstant(f64),
    /// x k
    MultiplyConstant(f64),
    /// x of r
    Binary(BinaryOp, u8),
    /// r of x
    Round(BinaryOp, u8),
    /// x of k
    Right(BinaryOp, f64),
    /// k of x
    Left(BinaryOp, f64),
    /// op x
    Unary(UnaryOp),
    /// The first register if x is truthy, otherwise the second.
    Select(u8, u8),
    /// f(x)
    One(fn(f64) -> f64),
    /// f(x), where f tests x for NaN.
    Asks(fn(f64) -> f64),
    /// f(x, r)
    Two(fn(f64, f64) -> f64, u8),
    /// f of several arguments: their number, and their start in the list of arguments.
    Many(fn(&[f64]) -> f64, u8, u16),
}

impl RowOp {
    /// The registers that it reads directly, not through the list of arguments.
    pub(super) fn reads(self) -> [Option<u8>; 2] {
        match self {
            RowOp::Take(r)
            | RowOp::Add(r)
            | RowOp::Subtract(r)
            | RowOp::SubtractFrom(r)
            | RowOp::Multiply(r) => [Some(r), None],
            RowOp::Divide(r) | RowOp::DivideInto(r) | RowOp::Binary(_, r) => [Some(r), None],
            RowOp::Round(_, r) | RowOp::Two(_, r) => [Some(r), None],
            RowOp::Select(yes, no) => [Some(yes), Some(no)],
            _ => [None, None],
        }
    }

    /// Whether the result is known to be NaN whenever an operand is NaN.
    pub(super) fn passes_nan(self) -> bool {
        use BinaryOp::{Add, Divide, Multiply, Remainder, Subtract};
        match self {
            RowOp::Binary(op, _) | RowOp::Round(op, _) | RowOp::Right(op, _) | RowOp::Left(op, _) => {
                matches!(op, Add | Subtract | Multiply | Divide | Remainder)
            }
            RowOp::Unary(op) => matches!(op, UnaryOp::Minus | UnaryOp::Plus),
            RowOp::One(f) => f(f64::NAN).is_nan(),
            RowOp::Select(..) | RowOp::Two(..) | RowOp::Many(..) => false,
            _ => true,
        }
    }
}
