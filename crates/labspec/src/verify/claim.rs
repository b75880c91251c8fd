//! An expression over the measures: compiled once, evaluated with the numbers of every numerics, and traced. What it is worth
//! follows from how its value came to be: which numbers it read, whether one of them was missing, and how its comparisons
//! came out.

use super::bound::BoundVerify;
use super::layout::Slot;
use super::outcome::{Named, Outcome, OutcomeNames};
use crate::bind::{NUMBERS, Scope, functions};
use crate::run::Budget;
use labspec_core::reflect::{FieldId, Object, data};
use labspec_expr::{Comparison, Compiler, Effects, Finding, Program, RuntimeError, Span, Value, Watch};

/// A claim of a lesson, compiled.
#[derive(Debug)]
pub(super) struct Claim {
    /// `None` where it has mistakes.
    pub(super) program: Option<Program>,
    pub(super) diagnostics: Vec<Finding>,
    /// The places of the numbers that it may read.
    pub(super) reads: Vec<usize>,
    /// Where it looks at the simulation outside of what is taken over a run.
    pub(super) outside: bool,
    /// What of the runs it names; with no place among `reads`, the text never comes to it.
    pub(super) names: Named,
    /// Numbers that stand in the text.
    pub(super) constants: Vec<f64>,
}

/// The numbers that a claim is evaluated with.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Inputs {
    /// By the places of the layout.
    pub(super) numbers: Vec<f64>,
    /// What the aggregates in its own text give, in order.
    pub(super) parts: Vec<f64>,
}

impl Inputs {
    /// Takes the numbers of others, in the memory that it has.
    pub(super) fn copy(&mut self, other: &Inputs) {
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
pub(super) struct Traced {
    pub(super) value: Value,
    /// The part of the text where a NaN, or nothing, was turned into something else.
    pub(super) lost: Option<Span>,
    pub(super) comparisons: Vec<Comparison>,
}

impl Claim {
    /// Compiles a text for the runs and measures of an object.
    pub(super) fn of(bound: &BoundVerify<'_>, text: &str) -> Option<Claim> {
        let base = bound.base()?;
        let layout = bound.layout();
        let names = OutcomeNames::new(layout, base.names(Scope::Measure));
        let mut globals = base.globals.clone();
        let compiled = Compiler::new(&names, &mut globals).expression(text);
        let mut reads = Vec::new();
        let mut outside = false;
        if let Some(program) = &compiled.program {
            let effects = program.effects();
            for access in effects.reads.iter().filter(|a| a.field == NUMBERS) {
                let count = access.count.unwrap_or(layout.slots.len().saturating_sub(access.first));
                reads.extend(access.first..access.first.saturating_add(count).min(layout.slots.len()));
            }
            reads.sort_unstable();
            reads.dedup();
            outside = looks(effects) || effects.any_ctx || !effects.ctx_reads.is_empty();
        }
        let constants = super::condition::numbers_in(text);
        Some(Claim {
            program: compiled.program,
            diagnostics: compiled.diagnostics,
            reads,
            outside,
            names: names.met(),
            constants,
        })
    }

    /// The numbers of an outcome that it is evaluated with.
    pub(super) fn inputs(&self, bound: &BoundVerify<'_>, outcome: &Outcome, parts: Vec<f64>) -> Inputs {
        Inputs { numbers: bound.layout().numbers(outcome), parts }
    }

    /// The places of what was measured, among the numbers and then among the parts.
    pub(super) fn measured(&self, bound: &BoundVerify<'_>) -> Vec<usize> {
        let slots = &bound.layout().slots;
        let simulated = |place: &usize| match slots.get(*place) {
            Some(Slot::Measure(run, m)) => bound.is_simulated(*run, *m),
            Some(Slot::Warnings(_) | Slot::Found(_)) => true,
            Some(Slot::Swept(_) | Slot::Missing) | None => false,
        };
        let own = self.program.iter().flat_map(|p| p.aggregates().iter().enumerate());
        let stops = bound.runs.first().is_some_and(|run| run.stop.is_some());
        let own = own.filter(|(_, a)| a.args.iter().any(|arg| looks_over_run(arg, stops)));
        let own = own.map(|(i, _)| slots.len() + i);
        self.reads.iter().copied().filter(simulated).chain(own).collect()
    }

    /// Its value with these numbers.
    ///
    /// # Errors
    /// It throws, as when a list lacks an element that is asked for its parts.
    pub(super) fn evaluate(
        &self,
        bound: &BoundVerify<'_>,
        inputs: &Inputs,
        turned: Option<usize>,
    ) -> Option<Result<Traced, RuntimeError>> {
        let program = self.program.as_ref()?;
        bound.idle(|session| {
            session.world.numbers.clone_from(&inputs.numbers);
            for (aggregate, x) in program.aggregates().iter().zip(&inputs.parts) {
                session.context.set_aggregate(aggregate.slot, *x);
            }
            session.context.allow(Budget::SAMPLE.left);
            session.context.watch(Some(Box::new(Watch::comparing(turned))));
            let value = program.run(&mut session.world, &mut session.context, None);
            let missing = session.context.events().first().map(|event| event.span);
            let watch = session.context.watch(None).map_or(Watch::default(), |watch| *watch);
            let lost = watch.lost.or(missing);
            value.map(|value| Traced { value, lost, comparisons: watch.comparisons })
        })
    }
}

/// Whether effects look at the data of a simulation.
pub(super) fn looks(e: &Effects) -> bool {
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
