//! The kind of a measure: which values it can have. It is determined by evaluating its program with random values for
//! everything that it reads.

use super::aggregate::AggregateKind;
use super::anything::Anything;
use super::bound_run::CompiledText;
use super::draws::Draws;
use crate::bind::World;
use labspec_expr::{Aggregate, Context, Program};

/// Which values a measure can have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ValueKind {
    /// Never below zero.
    pub(super) positive: bool,
    /// Always an integer.
    pub(super) whole: bool,
    /// Never above one.
    pub(super) truth: bool,
}

impl ValueKind {
    pub(super) const ANY: ValueKind = ValueKind { positive: false, whole: false, truth: false };
    pub(super) const COUNT: ValueKind = ValueKind { positive: true, whole: true, ..ValueKind::ANY };
    const TIME: ValueKind = ValueKind { positive: true, ..ValueKind::ANY };
    const TRUTH_VALUE: ValueKind = ValueKind { truth: true, ..ValueKind::COUNT };

    /// Whether a value is of this kind.
    pub(super) fn has(self, x: f64) -> bool {
        (!self.positive || x >= 0.0)
            && (!self.whole || x.fract() == 0.0)
            && (!self.truth || x <= 1.0)
            && x.is_finite()
    }

    /// The nearest value of this kind.
    pub(super) fn nearest(self, x: f64) -> f64 {
        let x = if self.positive { x.abs() } else { x };
        let x = if self.whole { x.round() } else { x };
        if self.truth { x.min(1.0) } else { x }
    }

    /// The kind of a list of sampled values.
    fn of_values(values: &[f64]) -> ValueKind {
        let some = values.iter().filter(|x| !x.is_nan());
        if some.clone().count() == 0 {
            return ValueKind::ANY;
        }
        let all = |f: fn(f64) -> bool| some.clone().all(|x| f(*x));
        let (positive, whole) = (all(|x| x >= 0.0), all(|x| x.fract() == 0.0));
        ValueKind { positive, whole, truth: positive && whole && all(|x| x <= 1.0) }
    }
}

/// Number of evaluations of a program that determine its kind.
const DRAWS: usize = 48;

/// The kind of a measure, determined by evaluating its program with random inputs.
pub(super) fn kind_of(measure: &CompiledText<'_>, world: &World, context: &mut Context) -> ValueKind {
    program_kind(&measure.program, world, &mut context.copy())
}

/// The kinds of the aggregates of a program, in order.
pub(super) fn kinds_of(program: &Program, world: &World, context: &mut Context) -> Vec<ValueKind> {
    let mut context = context.copy();
    program.aggregates().iter().map(|a| aggregate_kind(a, world, &mut context)).collect()
}

fn program_kind(program: &Program, world: &World, context: &mut Context) -> ValueKind {
    let kinds: Vec<ValueKind> =
        program.aggregates().iter().map(|a| aggregate_kind(a, world, context)).collect();
    // The aggregates get values of their own kinds, so a measure that consists of one aggregate is of the kind of that
    // aggregate.
    let mut values = Vec::new();
    let mut draws = Draws::new(1);
    for seed in 0..DRAWS as u64 {
        for (a, kind) in program.aggregates().iter().zip(&kinds) {
            context.set_aggregate(a.slot, kind.nearest(draws.any()));
        }
        let mut host = Anything::sample_of(world, seed);
        context.allow(100_000);
        if let Ok(value) = program.run(&mut host, context, None) {
            values.push(value.to_number());
        }
    }
    ValueKind::of_values(&values)
}

fn aggregate_kind(a: &Aggregate, world: &World, context: &mut Context) -> ValueKind {
    let mut of_argument =
        |i: usize| a.args.get(i).map_or(ValueKind::ANY, |p| program_kind(p, world, context));
    match AggregateKind::of_aggregate(a) {
        Some(
            AggregateKind::First
            | AggregateKind::Last
            | AggregateKind::Peak
            | AggregateKind::Crossing
            | AggregateKind::Period
            | AggregateKind::Settles,
        ) => ValueKind::TIME,
        Some(AggregateKind::Count | AggregateKind::Crossings) => ValueKind::COUNT,
        Some(AggregateKind::Holds) => ValueKind::TRUTH_VALUE,
        Some(AggregateKind::At | AggregateKind::Before) => of_argument(1),
        Some(
            AggregateKind::Initial
            | AggregateKind::Final
            | AggregateKind::Previous
            | AggregateKind::Min
            | AggregateKind::Max,
        ) => of_argument(0),
        Some(AggregateKind::Mean | AggregateKind::Integral) => {
            ValueKind { whole: false, truth: false, ..of_argument(0) }
        }
        Some(AggregateKind::Rms) => ValueKind { positive: true, ..ValueKind::ANY },
        Some(AggregateKind::Rate) | None => ValueKind::ANY,
    }
}
