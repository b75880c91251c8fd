//! Aggregates: functions that reduce the samples of a run to one number.

use super::curve_trail::CurveTrail;
use super::sample::Sample;
use crate::bind::functions;
use crate::source::Text;
use labspec_expr::{Aggregate, Program, Value};

/// The kind of an aggregate. The names are those of the function table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum AggregateKind {
    First,
    At,
    Before,
    Initial,
    Final,
    Previous,
    Min,
    Max,
    Mean,
    Crossing,
    Period,
    Last,
    Count,
    Crossings,
    Settles,
    Peak,
    Holds,
    Rate,
    Integral,
    Rms,
}

impl AggregateKind {
    pub(super) fn of_aggregate(aggregate: &Aggregate) -> Option<AggregateKind> {
        Some(match functions::name(aggregate.function)? {
            "first" => AggregateKind::First,
            "at" => AggregateKind::At,
            "before" => AggregateKind::Before,
            "initial" => AggregateKind::Initial,
            "final" => AggregateKind::Final,
            "previous" => AggregateKind::Previous,
            "min" => AggregateKind::Min,
            "max" => AggregateKind::Max,
            "mean" => AggregateKind::Mean,
            "crossing" => AggregateKind::Crossing,
            "period" => AggregateKind::Period,
            "last" => AggregateKind::Last,
            "count" => AggregateKind::Count,
            "crossings" => AggregateKind::Crossings,
            "settles" => AggregateKind::Settles,
            "peak" => AggregateKind::Peak,
            "holds" => AggregateKind::Holds,
            "rate" => AggregateKind::Rate,
            "integral" => AggregateKind::Integral,
            "rms" => AggregateKind::Rms,
            _ => return None,
        })
    }
}

/// One aggregate while the samples are processed.
#[derive(Debug)]
pub(super) struct RunningAggregate<'a> {
    kind: AggregateKind,
    args: &'a [Program],
    /// The aggregates in its arguments. They process each sample before this aggregate does.
    inner: Vec<RunningAggregate<'a>>,
    pub(super) slot: usize,
    /// The result so far, NaN before the first.
    result: f64,
    /// Whether the condition has held, or the first sample was processed.
    done: bool,
    /// The value at the previous sample.
    previous: f64,
    /// State of the measures that interpolate between samples.
    trail: CurveTrail,
    /// Samples without a number, where they leave the result undecided.
    pub(super) gaps: MissingNumbers,
    /// Whether the previous sample had no number.
    lacked: bool,
    /// Whether a sample was processed.
    is_started: bool,
    /// Whether the event happens at the first sample.
    pub(super) at_start: bool,
}

/// Samples without a number.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct MissingNumbers {
    pub(super) count: usize,
    /// Time of the first one, s.
    pub(super) first: f64,
}

impl<'a> RunningAggregate<'a> {
    /// The aggregates of a program, before the first sample.
    pub(super) fn all(program: &'a Program) -> Vec<RunningAggregate<'a>> {
        let start = |a: &'a Aggregate| {
            let kind = AggregateKind::of_aggregate(a)?;
            Some(RunningAggregate {
                kind,
                args: &a.args,
                inner: a.args.iter().flat_map(RunningAggregate::all).collect(),
                slot: a.slot,
                result: RunningAggregate::before_first(kind),
                done: false,
                previous: f64::NAN,
                trail: CurveTrail::START,
                gaps: MissingNumbers::default(),
                lacked: false,
                is_started: false,
                at_start: false,
            })
        };
        program.aggregates().iter().filter_map(start).collect()
    }

    /// The result before the first sample: 0 for counts and integrals, 1 (true) for `holds`, else NaN.
    fn before_first(kind: AggregateKind) -> f64 {
        match kind {
            AggregateKind::Count | AggregateKind::Crossings | AggregateKind::Integral => 0.0,
            AggregateKind::Holds => 1.0,
            _ => f64::NAN,
        }
    }

    /// The result so far; NaN if samples without a number leave it undecided.
    pub(super) fn result(&self) -> f64 {
        if self.gaps.count > 0 { f64::NAN } else { self.result }
    }

    /// What did not happen, if the aggregate has no result for this reason.
    pub(super) fn absent_event(&self) -> Option<String> {
        use AggregateKind::{At, Before, Crossing, First, Last, Period, Settles};
        if self.done || !self.result.is_nan() {
            return None;
        }
        match self.kind {
            First | At | Last => Some("the condition never holds".into()),
            Before => Some("the condition never holds, or it holds at the first sample".into()),
            Crossing => Some("the value never passes the level".into()),
            Period => {
                let passages = match self.trail.count {
                    0 => "the value never rises through the level",
                    _ => "the value rises through the level only once",
                };
                Some(format!("{passages}, and a period needs two passages"))
            }
            Settles => Some("the value is outside of the band at the end".into()),
            _ => None,
        }
    }

    /// Whether an argument reads the sample before the first one.
    fn has_no_past(&self) -> bool {
        self.inner.iter().any(|r| r.kind == AggregateKind::Previous && !r.done || r.has_no_past())
    }

    /// Whether no later sample can change the result.
    fn is_final(&self) -> bool {
        use AggregateKind::{At, Before, Crossing, First, Initial};
        self.done && matches!(self.kind, First | At | Before | Crossing | Initial)
    }

    /// Processes the current sample. The arguments contain the inner aggregates over the samples up to this one.
    pub(super) fn sample(&mut self, session: &mut dyn Sample, text: &Text) {
        let first = self.has_no_past();
        for inner in &mut self.inner {
            inner.sample(session, text);
            session.context().set_aggregate(inner.slot, inner.result());
        }
        if self.is_final() {
            return;
        }
        let time = session.time();
        let mut args = AggregateArguments { programs: self.args, text, session, lack: false };
        // This sample decides what earlier samples left undecided.
        if self.take(time, &mut args) {
            self.gaps = MissingNumbers::default();
        }
        let is_event =
            matches!(self.kind, AggregateKind::First | AggregateKind::At | AggregateKind::Crossing);
        self.at_start |= !std::mem::replace(&mut self.is_started, true) && is_event && self.done;
        if args.lack && !first {
            if self.gaps.count == 0 {
                self.gaps.first = time;
            }
            self.gaps.count += 1;
        }
    }

    /// Includes a sample in the result. Returns whether it decides what earlier samples left undecided. The function is
    /// long because it has one arm for each kind of aggregate.
    fn take(&mut self, time: f64, args: &mut AggregateArguments<'_>) -> bool {
        match self.kind {
            AggregateKind::First => self.finish_where(args, |_| time),
            AggregateKind::At => self.finish_where(args, |args| args.number(1)),
            AggregateKind::Before => self.take_before(args),
            AggregateKind::Initial => (self.result, self.done) = (args.number(0), true),
            AggregateKind::Final => {
                self.result = args.number(0);
                return true;
            }
            AggregateKind::Previous => self.take_previous(args),
            AggregateKind::Min => self.result = least(self.result, args.number(0)),
            AggregateKind::Max => self.result = -least(-self.result, -args.number(0)),
            AggregateKind::Mean => {
                self.trail.add_area(time, args.number(0));
                self.result = self.trail.mean();
            }
            AggregateKind::Crossing => self.take_crossing(time, args),
            AggregateKind::Period => {
                self.trail.oscillate(time, args.above_level());
                self.result = self.trail.period();
            }
            AggregateKind::Last => {
                if args.value(0).truthy() {
                    self.result = time;
                    return !args.lack;
                }
            }
            AggregateKind::Count => {
                let holds = args.value(0).truthy();
                self.result += f64::from(holds && !self.done);
                self.done = holds;
            }
            AggregateKind::Crossings => {
                self.trail.pass(time, args.above_level());
                self.result = self.trail.count as f64;
            }
            AggregateKind::Settles => return self.take_settles(time, args),
            AggregateKind::Peak => {
                let x = args.number(0);
                if x > self.previous || (self.previous.is_nan() && !x.is_nan()) {
                    (self.result, self.previous) = (time, x);
                }
            }
            AggregateKind::Holds => return self.take_holds(args),
            AggregateKind::Rate => {
                self.trail.line.add(time, args.number(0));
                self.result = self.trail.line.slope();
            }
            AggregateKind::Integral => {
                self.trail.add_area(time, args.number(0));
                self.result = self.trail.area;
            }
            AggregateKind::Rms => {
                let x = args.number(0);
                self.trail.add_area(time, x * x);
                self.result = self.trail.mean().sqrt();
            }
        }
        false
    }

    /// Sets the result at the first sample at which the condition holds.
    fn finish_where(
        &mut self,
        args: &mut AggregateArguments<'_>,
        result: impl FnOnce(&mut AggregateArguments<'_>) -> f64,
    ) {
        if args.value(0).truthy() {
            (self.result, self.done) = (result(args), true);
        }
    }

    /// The value at the sample before the condition holds. A number that is missing at that sample is reported when the
    /// condition holds.
    fn take_before(&mut self, args: &mut AggregateArguments<'_>) {
        let holds = args.value(0).truthy();
        let open = std::mem::replace(&mut args.lack, false);
        let x = args.number(1);
        let before = std::mem::replace(&mut self.lacked, args.lack);
        args.lack = open || holds && before;
        if holds {
            (self.result, self.done) = (self.previous, true);
        } else {
            self.previous = x;
        }
    }

    fn take_previous(&mut self, args: &mut AggregateArguments<'_>) {
        let x = args.number(0);
        let x = if std::mem::replace(&mut args.lack, false) { f64::NAN } else { x };
        (self.result, self.previous, self.done) = (self.previous, x, true);
    }

    fn take_crossing(&mut self, time: f64, args: &mut AggregateArguments<'_>) {
        let x = args.above_level();
        if let Some(zero) = self.trail.zero(time, x) {
            (self.result, self.done) = (zero, true);
        }
        self.trail.remember(time, x);
    }

    /// The time since which the value has been inside the band.
    fn take_settles(&mut self, time: f64, args: &mut AggregateArguments<'_>) -> bool {
        let [x, target, band] = [0, 1, 2].map(|i| args.number(i));
        let inside = (x - target).abs() <= band;
        if !inside {
            self.result = f64::NAN;
        } else if self.result.is_nan() {
            self.result = time;
        }
        !inside && !args.lack
    }

    fn take_holds(&mut self, args: &mut AggregateArguments<'_>) -> bool {
        if !args.value(0).truthy() && !args.lack {
            self.result = 0.0;
        }
        // After one failure, no later sample changes the result.
        let decided = self.result == 0.0;
        args.lack = args.lack && !decided;
        decided
    }
}

/// The arguments of an aggregate at a sample.
struct AggregateArguments<'s> {
    programs: &'s [Program],
    text: &'s Text,
    session: &'s mut dyn Sample,
    /// Whether an argument is not a number.
    lack: bool,
}

impl AggregateArguments<'_> {
    fn value(&mut self, i: usize) -> Value {
        let program = self.programs.get(i);
        let value = program.and_then(|p| self.session.evaluate(p, self.text)).unwrap_or(Value::Undefined);
        let nothing = matches!(value, Value::Undefined) || matches!(value, Value::Number(x) if x.is_nan());
        if nothing || self.session.context().watched().is_some_and(|watch| watch.lost.is_some()) {
            self.lack = true;
        }
        value
    }

    fn number(&mut self, i: usize) -> f64 {
        self.value(i).to_number()
    }

    /// The first argument minus the level (the second argument); the first argument itself if there is no level.
    fn above_level(&mut self) -> f64 {
        let level = if self.programs.len() > 1 { self.number(1) } else { 0.0 };
        self.number(0) - level
    }
}

/// The smaller of the minimum so far (NaN before the first) and a number.
fn least(so_far: f64, x: f64) -> f64 {
    if so_far.is_nan() || x < so_far { x } else { so_far }
}
