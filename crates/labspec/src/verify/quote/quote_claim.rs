//! A quote that is checked: what it claims, where it stands, what its expression gives, and what became of it.

use super::number::Quoted;
use super::unit_text::Unit;
use crate::source::Text;
use labspec_expr::dimension::Dimension;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// The value of the same expression in another run: with half the timestep, or from a start that is a hair away.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OtherValue {
    /// What was changed: "at half the timestep", "with the solver run to convergence", "with a start moved by 1e-14".
    pub how: &'static str,
    /// What the expression then gives.
    pub value: f64,
}

/// What became of a quote.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum QuoteState {
    /// The text stands in the lesson, and its number is what the expression gives.
    Right,
    /// The text stands in the lesson, and its number is another one.
    Wrong,
    /// It could not be checked; a finding says why.
    Unclear,
}

/// A quote that was checked.
#[derive(Clone, Debug, PartialEq)]
pub struct QuoteOutcome {
    /// What became of it.
    pub state: QuoteState,
    /// A short sentence when it is not right.
    pub reason: String,
    /// The number that was read. Of `50 %` that is 50 or 0.5, whichever the expression gives.
    pub read: Option<Quoted>,
    /// What the expression gives in the lesson's own runs.
    pub computed: f64,
    /// Where the text stands, in bytes of the file.
    pub places: Vec<Range<usize>>,
    /// Other runs in which the printed digits change, and what they print.
    pub moved: Vec<(&'static str, String)>,
}

/// What the expression of a quote gives.
#[derive(Clone, Copy)]
pub(in crate::verify) struct QuoteValue<'v> {
    /// In the lesson's own runs.
    pub(in crate::verify) computed: f64,
    /// With finer numerics.
    pub(in crate::verify) timestep: &'v [OtherValue],
    /// From starts that no reader could tell from the lesson's own.
    pub(in crate::verify) start: &'v [OtherValue],
    /// What it measures, where that is certain.
    pub(in crate::verify) unit: &'v dyn Fn() -> Option<Dimension>,
}

/// A quoted text, the part of it that states a number, and the expression that gives it.
#[derive(Clone, Copy, Debug)]
pub(in crate::verify) struct QuoteClaim<'c> {
    pub(in crate::verify) quote: &'c Text,
    pub(in crate::verify) part: &'c str,
    pub(in crate::verify) expr: &'c Text,
}

/// A place where a quote stands.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::verify) struct QuotePlace {
    /// Bytes of the file.
    pub(in crate::verify) at: Range<usize>,
    /// The unit that the text has behind the last number of the quote, or over its column, where the quote has none.
    pub(in crate::verify) unit: Option<Unit>,
}
