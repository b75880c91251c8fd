//! A compiled expression over the measures, the numbers with which it is evaluated, and the result of an evaluation.

use super::outcome_names::NamesRead;
use crate::bind::functions;
use labspec_core::reflect::{FieldId, Object, data};
use labspec_expr::{Comparison, Effects, Finding, Program, Span, Value};

/// A compiled claim of a lesson.
#[derive(Debug)]
pub(super) struct CompiledClaim {
    /// `None` if it has errors.
    pub(super) program: Option<Program>,
    pub(super) diagnostics: Vec<Finding>,
    /// The positions of the numbers that it may read.
    pub(super) reads: Vec<usize>,
    /// Whether it reads the simulation outside of aggregates.
    pub(super) outside: bool,
    /// The names of runs and measures in the text. A name without a position among `reads` is in code that is never
    /// evaluated.
    pub(super) names: NamesRead,
    /// Number literals of the text.
    pub(super) constants: Vec<f64>,
    /// Whether its aggregates depend on variables of `ctx` that the lab computes from the simulation.
    pub(super) reads_simulated_ctx: bool,
}

/// The numbers with which a claim is evaluated.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct ClaimInputs {
    /// Indexed by the positions of the layout.
    pub(super) numbers: Vec<f64>,
    /// The values of the aggregates in the text of the claim, in order.
    pub(super) parts: Vec<f64>,
}

impl ClaimInputs {
    /// Copies the numbers of `other` without allocating.
    pub(super) fn copy(&mut self, other: &ClaimInputs) {
        self.numbers.clone_from(&other.numbers);
        self.parts.clone_from(&other.parts);
    }

    /// The number at a position: first those of the layout, then the parts.
    pub(super) fn at(&self, place: usize) -> Option<f64> {
        match place.checked_sub(self.numbers.len()) {
            None => self.numbers.get(place).copied(),
            Some(part) => self.parts.get(part).copied(),
        }
    }

    /// Replaces the number at a position.
    pub(super) fn set_value(&mut self, place: usize, x: f64) {
        let number = match place.checked_sub(self.numbers.len()) {
            None => self.numbers.get_mut(place),
            Some(part) => self.parts.get_mut(part),
        };
        if let Some(number) = number {
            *number = x;
        }
    }
}

/// The result of an evaluation.
#[derive(Clone, Debug)]
pub(super) struct TracedValue {
    pub(super) value: Value,
    /// The span of the text at which NaN or undefined was converted to another value.
    pub(super) lost: Option<Span>,
    pub(super) comparisons: Vec<Comparison>,
}

/// Whether effects include reads of simulation data.
pub(super) fn reads_data(e: &Effects) -> bool {
    reads_any(e, &|field| field.info().object == Object::Data)
}

/// Whether effects include a read of a field that satisfies `counts`, or a read of unknown fields.
fn reads_any(e: &Effects, counts: &dyn Fn(FieldId) -> bool) -> bool {
    let read = |a: &labspec_expr::Access| FieldId::new(a.field.0 as usize).is_some_and(counts);
    e.reads_everything
        || e.calls.iter().any(|&f| functions::reads(f))
        || e.calls_values
        || e.reads.iter().any(read)
}

/// Whether a program reads results of a simulation, directly or in an aggregate. The time advances in every simulation, so
/// it counts as a result only where the run ends by its own `stop`.
pub(super) fn reads_run(program: &Program, stops: bool) -> bool {
    let counts = |field: FieldId| field.info().object == Object::Data && (stops || field != data::time);
    reads_any(program.effects(), &counts)
        || program.aggregates().iter().flat_map(|a| &a.args).any(|arg| reads_run(arg, stops))
}

/// Whether a program reads variables of `ctx`, directly or in an aggregate.
pub(super) fn reads_ctx(program: &Program) -> bool {
    let effects = program.effects();
    effects.any_ctx
        || !effects.ctx_reads.is_empty()
        || program.aggregates().iter().flat_map(|a| &a.args).any(reads_ctx)
}
