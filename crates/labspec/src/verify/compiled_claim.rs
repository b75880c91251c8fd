//! A compiled expression over the measures, the numbers that it is evaluated with, and what an evaluation gives.

use super::outcome_names::NamesRead;
use crate::bind::functions;
use labspec_core::reflect::{FieldId, Object, data};
use labspec_expr::{Comparison, Effects, Finding, Program, Span, Value};

/// A claim of a lesson, compiled.
#[derive(Debug)]
pub(super) struct CompiledClaim {
    /// `None` where it has mistakes.
    pub(super) program: Option<Program>,
    pub(super) diagnostics: Vec<Finding>,
    /// The places of the numbers that it may read.
    pub(super) reads: Vec<usize>,
    /// Where it looks at the simulation outside of what is taken over a run.
    pub(super) outside: bool,
    /// What of the runs it names; with no place among `reads`, the text never comes to it.
    pub(super) names: NamesRead,
    /// Numbers that stand in the text.
    pub(super) constants: Vec<f64>,
}

/// The numbers that a claim is evaluated with.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct ClaimInputs {
    /// By the places of the layout.
    pub(super) numbers: Vec<f64>,
    /// What the aggregates in its own text give, in order.
    pub(super) parts: Vec<f64>,
}

impl ClaimInputs {
    /// Takes the numbers of others, in the memory that it has.
    pub(super) fn copy(&mut self, other: &ClaimInputs) {
        self.numbers.clone_from(&other.numbers);
        self.parts.clone_from(&other.parts);
    }

    /// The number at a place: of the layout, and then of the parts.
    pub(super) fn at(&self, place: usize) -> Option<f64> {
        match place.checked_sub(self.numbers.len()) {
            None => self.numbers.get(place).copied(),
            Some(part) => self.parts.get(part).copied(),
        }
    }

    /// Puts another number at a place.
    pub(super) fn put(&mut self, place: usize, x: f64) {
        let number = match place.checked_sub(self.numbers.len()) {
            None => self.numbers.get_mut(place),
            Some(part) => self.parts.get_mut(part),
        };
        if let Some(number) = number {
            *number = x;
        }
    }
}

/// An evaluation.
#[derive(Clone, Debug)]
pub(super) struct TracedValue {
    pub(super) value: Value,
    /// The part of the text where a NaN, or nothing, was turned into something else.
    pub(super) lost: Option<Span>,
    pub(super) comparisons: Vec<Comparison>,
}

/// Whether effects look at the data of a simulation.
pub(super) fn looks_at_data(e: &Effects) -> bool {
    looks_at(e, &|field| field.info().object == Object::Data)
}

/// Whether effects read a field of which this holds, or what may be any.
fn looks_at(e: &Effects, counts: &dyn Fn(FieldId) -> bool) -> bool {
    let read = |a: &labspec_expr::Access| FieldId::new(a.field.0 as usize).is_some_and(counts);
    e.reads_everything
        || e.calls.iter().any(|&f| functions::reads(f))
        || e.calls_values
        || e.reads.iter().any(read)
}

/// Whether a program looks at what a simulation gives, itself or in what it takes over a run. The time goes on whatever is
/// simulated: it says something only where the run ends by its own `stop`.
pub(super) fn looks_over_run(program: &Program, stops: bool) -> bool {
    let counts = |field: FieldId| field.info().object == Object::Data && (stops || field != data::time);
    looks_at(program.effects(), &counts)
        || program.aggregates().iter().flat_map(|a| &a.args).any(|arg| looks_over_run(arg, stops))
}
