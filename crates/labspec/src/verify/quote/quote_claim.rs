//! A checked quote: its text, its places, the value of its expression, and the result.

use super::clause::Clause;
use super::number::Quoted;
use super::unit_text::Unit;
use crate::source::Text;
use labspec_expr::dimension::Dimension;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// The value of the same expression under perturbed numerics: half the timestep, or a perturbed start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OtherValue {
    /// The perturbation: "at half the timestep", "with the solver run to convergence", "with a start moved by 1e-14".
    pub how: &'static str,
    /// The value of the expression.
    pub value: f64,
}

/// The state of a quote.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum QuoteState {
    /// The text appears in the lesson, and its number equals the value of the expression.
    Right,
    /// The text appears in the lesson, and its number differs.
    Wrong,
    /// It could not be checked; a finding states why.
    Unclear,
}

/// The result of checking a quote.
#[derive(Clone, Debug, PartialEq)]
pub struct QuoteOutcome {
    /// The state.
    pub state: QuoteState,
    /// The reason in a short sentence, when it is not right.
    pub reason: String,
    /// The number that was read. For `50 %` it is 50 or 0.5, whichever equals the expression.
    pub read: Option<Quoted>,
    /// The value of the expression in the nominal runs.
    pub computed: f64,
    /// The places of the text, in bytes of the file.
    pub places: Vec<Range<usize>>,
    /// The perturbed runs in which the printed digits change, and what they print.
    pub moved: Vec<(&'static str, String)>,
}

/// The values of the expression of a quote.
#[derive(Clone, Copy)]
pub(in crate::verify) struct QuoteValue<'v> {
    /// In the nominal runs.
    pub(in crate::verify) computed: f64,
    /// At half the timestep.
    pub(in crate::verify) timestep: &'v [OtherValue],
    /// From perturbed starts.
    pub(in crate::verify) start: &'v [OtherValue],
    /// Its dimension, where that is certain.
    pub(in crate::verify) unit: &'v dyn Fn() -> Option<Dimension>,
    /// Whether it is the reciprocal of a period, which counts turns.
    pub(in crate::verify) counts_turns: bool,
}

/// A quoted text, the part of it that states a number, and the expression for the number.
#[derive(Clone, Copy, Debug)]
pub(in crate::verify) struct QuoteClaim<'c> {
    pub(in crate::verify) quote: &'c Text,
    pub(in crate::verify) part: &'c str,
    pub(in crate::verify) expr: &'c Text,
}

/// A place where a quote appears.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::verify) struct QuotePlace {
    /// Bytes of the file.
    pub(in crate::verify) span: Range<usize>,
    /// The unit that the text has after the last number of the quote, or in the heading of its column, where the quote
    /// itself has none.
    pub(in crate::verify) unit: Option<Unit>,
    /// The value of constant arithmetic before it and an equality sign.
    pub(in crate::verify) arithmetic: Option<f64>,
    /// The clause around it, or the first cell of its row.
    pub(in crate::verify) clause: Clause,
}
