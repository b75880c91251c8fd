//! Why a run ended early, and what happened in one that JavaScript passes over in silence.

use std::fmt;

use crate::number;
use crate::rules::{self, Rule};
use crate::types::FieldKey;
use labspec_finding::Span;

/// Why a run ended early.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RuntimeError {
    /// What was broken, one of [`rules::ALL`].
    pub rule: &'static Rule,
    /// The part of the program that failed.
    pub span: Span,
    /// What happened.
    pub message: String,
}

impl fmt::Display for RuntimeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for RuntimeError {}

/// What happened that JavaScript passes over in silence.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EventKind {
    /// An element that does not exist was read: it is `undefined`.
    ReadPastEnd,
    /// An element that does not exist was assigned: nothing happened.
    StorePastEnd,
}

/// Something noteworthy of the last run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RuntimeEvent {
    /// What.
    pub kind: EventKind,
    /// The part of the program.
    pub span: Span,
    /// The field.
    pub field: FieldKey,
    /// The index as written, in the view; may be negative, fractional or NaN.
    pub index: f64,
    /// How many elements the view had.
    pub len: usize,
}

impl RuntimeEvent {
    /// What was broken, one of [`rules::ALL`]. To read past the end breaks nothing: it gives `undefined`, which may be meant.
    pub fn rule(&self) -> Option<&'static Rule> {
        match self.kind {
            EventKind::ReadPastEnd => None,
            EventKind::StorePastEnd => Some(rules::STORE_PAST_END),
        }
    }
}

impl fmt::Display for RuntimeEvent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let index = number::to_text(self.index);
        let outcome = match self.kind {
            EventKind::ReadPastEnd => "was read: the value is `undefined`",
            EventKind::StorePastEnd => "was assigned: nothing was stored",
        };
        let count = match self.len {
            0 => "there are none now".to_owned(),
            1 => "there is one element now, index 0".to_owned(),
            n => format!("there are {n} elements now, indexes 0 to {}", n - 1),
        };
        write!(f, "element {index} {outcome}; {count}")
    }
}
