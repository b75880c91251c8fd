//! Measures: what becomes of an expression over all samples of a run.

use crate::run::Session;
use crate::source::Text;
use labspec_expr::{Aggregate, Program, Value};

/// How the samples of a run become one number. The names are those of the function table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum How {
    First,
    At,
    Before,
    Initial,
    Final,
    Min,
    Max,
}

impl How {
    fn of(aggregate: &Aggregate) -> Option<How> {
        Some(match crate::bind::functions::name(aggregate.function)? {
            "first" => How::First,
            "at" => How::At,
            "before" => How::Before,
            "initial" => How::Initial,
            "final" => How::Final,
            "min" => How::Min,
            "max" => How::Max,
            _ => return None,
        })
    }
}

/// One aggregate on its way through the samples.
#[derive(Debug)]
struct Running<'a> {
    how: How,
    args: &'a [Program],
    slot: usize,
    /// The result so far, NaN before there is one.
    result: f64,
    /// The condition has held, or the first sample was seen.
    done: bool,
    /// The value at the sample before.
    previous: f64,
}

/// The aggregates of one measure.
#[derive(Debug)]
pub(super) struct Measure<'a> {
    program: &'a Program,
    text: &'a Text,
    running: Vec<Running<'a>>,
}

impl<'a> Measure<'a> {
    /// A measure before the first sample.
    pub(super) fn new(program: &'a Program, text: &'a Text) -> Measure<'a> {
        let start = |a: &'a Aggregate| {
            let how = How::of(a)?;
            Some(Running {
                how,
                args: &a.args,
                slot: a.slot,
                result: f64::NAN,
                done: false,
                previous: f64::NAN,
            })
        };
        Measure { program, text, running: program.aggregates().iter().filter_map(start).collect() }
    }

    /// Looks at the current sample.
    pub(super) fn sample(&mut self, session: &mut Session<'_>) {
        let time = session.world.data.time;
        for r in &mut self.running {
            let mut value = |i: usize| {
                r.args.get(i).and_then(|p| session.evaluate(p, self.text)).unwrap_or(Value::Undefined)
            };
            match r.how {
                How::First | How::At | How::Before if r.done => {}
                How::First => {
                    if value(0).truthy() {
                        (r.result, r.done) = (time, true);
                    }
                }
                How::At => {
                    if value(0).truthy() {
                        (r.result, r.done) = (value(1).to_number(), true);
                    }
                }
                How::Before => {
                    if value(0).truthy() {
                        (r.result, r.done) = (r.previous, true);
                    } else {
                        r.previous = value(1).to_number();
                    }
                }
                How::Initial => {
                    if !r.done {
                        (r.result, r.done) = (value(0).to_number(), true);
                    }
                }
                How::Final => r.result = value(0).to_number(),
                // The extremes of what is a number: a NaN among the samples says nothing.
                How::Min => r.result = r.result.min(value(0).to_number()),
                How::Max => r.result = r.result.max(value(0).to_number()),
            }
        }
    }

    /// The measure, when the run is over.
    pub(super) fn finish(self, session: &mut Session<'_>) -> f64 {
        for r in &self.running {
            session.context.set_aggregate(r.slot, r.result);
        }
        session.evaluate(self.program, self.text).map_or(f64::NAN, |v| v.to_number())
    }
}
