//! The watch of a run: it records where a value that is not a number was turned into an ordinary value, and the results of
//! comparisons of numbers. Claims depend on it: a condition that lost a NaN during its evaluation proves nothing, and the
//! comparisons show how far a condition is from the opposite result.
//!
//! NaN and `undefined` mean "there is no number": an event that never happened, or the root of a negative number. Arithmetic
//! propagates NaN. Comparisons, branches, strings, indexes and most methods turn it into an ordinary value, which is a loss.

use crate::operation::truth;
use crate::operators::{BinaryOp, UnaryOp};
use labspec_finding::Span;

/// A comparison of two numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Comparison {
    /// The left operand.
    pub left: f64,
    /// The right operand.
    pub right: f64,
    /// How far the operands are from the opposite result: not negative if the comparison holds, not positive if it does not,
    /// NaN if an operand is not a number.
    pub margin: f64,
    /// Whether it holds.
    pub holds: bool,
}

/// The records of the runs in a `Context`, after it was passed to `Context::watch`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Watch {
    /// The index of the comparison, in the order of evaluation, whose result is inverted.
    pub turned: Option<usize>,
    /// The comparisons of the last run, if this watch was created by [`Watch::comparing`].
    pub comparisons: Vec<Comparison>,
    /// The first part of the program where a value that is not a number was turned into an ordinary value.
    pub lost: Option<Span>,
    compares: bool,
    loses: bool,
    undefined: bool,
}

/// Limit on the comparisons stored per run.
const MOST: usize = 4096;

impl Watch {
    /// A watch that records only losses of NaN.
    pub fn losses() -> Watch {
        Watch::default()
    }

    /// A watch that records losses of NaN and `undefined`, and comparisons, one of which may be inverted.
    pub fn comparing(turned: Option<usize>) -> Watch {
        Watch { turned, compares: true, undefined: true, ..Watch::default() }
    }

    /// The same, but losses of `undefined` are not noted.
    pub fn without_undefined(self) -> Watch {
        Watch { undefined: false, ..self }
    }

    /// Whether `undefined` counts as not being a number.
    pub(crate) fn counts_undefined(&self) -> bool {
        self.undefined
    }

    /// Whether it records comparisons in addition to losses.
    pub(crate) fn notes_comparisons(&self) -> bool {
        self.compares
    }

    /// Clears the records of the last run.
    pub fn begin(&mut self) {
        self.comparisons.clear();
        (self.lost, self.loses) = (None, false);
    }

    pub(crate) fn lose(&mut self) {
        self.loses = true;
    }

    /// Records the span of the last operation if it lost a value.
    pub(crate) fn settle(&mut self, span: Span) {
        if std::mem::take(&mut self.loses) {
            self.lost.get_or_insert(span);
        }
    }

    /// Whether NaN is lost.
    pub fn loses(&self) -> bool {
        self.loses
    }

    /// The result of an operation on numbers, which is inverted if it is the chosen comparison.
    pub(crate) fn binary(&mut self, op: BinaryOp, a: f64, b: f64) -> f64 {
        let x = op.on_numbers(a, b);
        self.note_result(a.is_nan() || b.is_nan(), x);
        if margin(op, a, b).is_some() { self.compared(op, a, b, x) } else { x }
    }

    pub(crate) fn unary(&mut self, op: UnaryOp, a: f64) -> f64 {
        let x = op.on_number(a);
        self.note_result(a.is_nan(), x);
        x
    }

    /// Records a number that decides a branch.
    pub(crate) fn test(&mut self, x: f64) {
        self.loses |= x.is_nan();
    }

    /// Records a loss if an operand was NaN and the result is not.
    pub(crate) fn note_result(&mut self, nan: bool, result: f64) {
        self.loses |= nan && !result.is_nan();
    }

    /// Records a comparison with the result `x`, and returns the result that the program receives.
    pub(crate) fn compared(&mut self, op: BinaryOp, a: f64, b: f64, x: f64) -> f64 {
        let Some(margin) = margin(op, a, b).filter(|_| self.compares) else { return x };
        let index = self.comparisons.len();
        if index >= MOST {
            return x;
        }
        self.comparisons.push(Comparison { left: a, right: b, margin, holds: x != 0.0 });
        if self.turned == Some(index) { truth(x == 0.0) } else { x }
    }
}

/// How far a comparison is from the opposite result, or `None` if the operator is not a comparison.
fn margin(op: BinaryOp, a: f64, b: f64) -> Option<f64> {
    Some(match op {
        BinaryOp::Less | BinaryOp::LessEqual => b - a,
        BinaryOp::Greater | BinaryOp::GreaterEqual => a - b,
        BinaryOp::Equal | BinaryOp::StrictEqual => -(a - b).abs(),
        BinaryOp::NotEqual | BinaryOp::StrictNotEqual => (a - b).abs(),
        _ => return None,
    })
}
