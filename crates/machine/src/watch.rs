//! What a watched run notes: where a value that is not a number was turned into something else, and how the comparisons of
//! numbers came out. Claims are decided by it: a condition that lost a NaN on its way says nothing, and how far a condition is
//! from the opposite follows from its comparisons.
//!
//! NaN and `undefined` stand for "there is no number": an event that never happened, a root of a negative number. Arithmetic
//! passes NaN on. Comparisons, tests, texts, indexes and most methods make an ordinary value of it; that is a loss.

use crate::operation::truth;
use crate::operators::{BinaryOp, UnaryOp};
use labspec_finding::Span;

/// A comparison of two numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Comparison {
    /// The left side.
    pub left: f64,
    /// The right side.
    pub right: f64,
    /// How far the sides are from giving the other answer: not negative where the comparison holds, not positive where it does
    /// not; NaN where a side is not a number.
    pub margin: f64,
    /// Whether it holds.
    pub holds: bool,
}

/// What the runs in a [`crate::context::Context`] note, once it is given to [`crate::context::Context::watch`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Watch {
    /// The number of the comparison, in the order of evaluation, that gives the opposite of what it would.
    pub turned: Option<usize>,
    /// The comparisons of the last run, if [`Watch::comparing`] made this.
    pub comparisons: Vec<Comparison>,
    /// The part of the program where a value that is not a number was turned into something else first.
    pub lost: Option<Span>,
    compares: bool,
    loses: bool,
    undefined: bool,
}

/// Comparisons kept of one run.
const MOST: usize = 4096;

impl Watch {
    /// Notes losses of NaN alone.
    pub fn losses() -> Watch {
        Watch::default()
    }

    /// Notes losses of NaN and `undefined`, and comparisons, of which one may be turned over.
    pub fn comparing(turned: Option<usize>) -> Watch {
        Watch { turned, compares: true, undefined: true, ..Watch::default() }
    }

    /// The same, but losses of `undefined` are not noted.
    pub fn without_undefined(self) -> Watch {
        Watch { undefined: false, ..self }
    }

    /// Whether `undefined` counts as what is not a number.
    pub(crate) fn counts_undefined(&self) -> bool {
        self.undefined
    }

    /// Whether it notes comparisons, besides losses.
    pub(crate) fn notes_comparisons(&self) -> bool {
        self.compares
    }

    /// Forgets the last run.
    pub fn begin(&mut self) {
        self.comparisons.clear();
        (self.lost, self.loses) = (None, false);
    }

    pub(crate) fn lose(&mut self) {
        self.loses = true;
    }

    /// Whether the operation that ran last lost a value; its place is kept.
    pub(crate) fn settle(&mut self, span: Span) {
        if std::mem::take(&mut self.loses) {
            self.lost.get_or_insert(span);
        }
    }

    /// Whether NaN is lost.
    pub fn loses(&self) -> bool {
        self.loses
    }

    /// The outcome of an operation on numbers, which it may have turned over.
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

    /// A number that decides which way is taken.
    pub(crate) fn test(&mut self, x: f64) {
        self.loses |= x.is_nan();
    }

    /// What became of operands.
    pub(crate) fn note_result(&mut self, nan: bool, result: f64) {
        self.loses |= nan && !result.is_nan();
    }

    /// Takes a comparison in, which gave `x`; gives what the program is to see.
    pub(crate) fn compared(&mut self, op: BinaryOp, a: f64, b: f64, x: f64) -> f64 {
        let Some(margin) = margin(op, a, b).filter(|_| self.compares) else { return x };
        let at = self.comparisons.len();
        if at >= MOST {
            return x;
        }
        self.comparisons.push(Comparison { left: a, right: b, margin, holds: x != 0.0 });
        if self.turned == Some(at) { truth(x == 0.0) } else { x }
    }
}

/// How far a comparison is from the other answer; `None` for what is no comparison.
fn margin(op: BinaryOp, a: f64, b: f64) -> Option<f64> {
    Some(match op {
        BinaryOp::Less | BinaryOp::LessEqual => b - a,
        BinaryOp::Greater | BinaryOp::GreaterEqual => a - b,
        BinaryOp::Equal | BinaryOp::StrictEqual => -(a - b).abs(),
        BinaryOp::NotEqual | BinaryOp::StrictNotEqual => (a - b).abs(),
        _ => return None,
    })
}
