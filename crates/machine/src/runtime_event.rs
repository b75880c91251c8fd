//! Errors that end a run, and events of a run that JavaScript ignores silently.

use std::fmt;

use crate::number;
use crate::rules::{self, Rule};
use crate::types::FieldKey;
use labspec_finding::Span;

/// The error that ended a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RuntimeError {
    /// The violated rule, one of [`rules::ALL`].
    pub rule: &'static Rule,
    /// The part of the program that failed.
    pub span: Span,
    /// The message.
    pub message: String,
}

impl fmt::Display for RuntimeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for RuntimeError {}

/// The kind of an event that JavaScript ignores silently.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EventKind {
    /// An element that does not exist was read; the value is `undefined`.
    ReadPastEnd,
    /// An element that does not exist was assigned, without effect.
    StorePastEnd,
}

/// An event of the last run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RuntimeEvent {
    /// The kind.
    pub kind: EventKind,
    /// The part of the program.
    pub span: Span,
    /// The field.
    pub field: FieldKey,
    /// The index in the view, as computed; may be negative, fractional or NaN.
    pub index: f64,
    /// The number of elements of the view.
    pub len: usize,
}

impl RuntimeEvent {
    /// The violated rule, one of [`rules::ALL`]. A read past the end violates none: it gives
    /// `undefined`, which may be intended.
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
