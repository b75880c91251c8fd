//! Measures: what becomes of an expression over all samples of a run.

use crate::run::Session;
use crate::source::Text;
use labspec_expr::{Aggregate, Context, Program, Value, Watch};
use std::cell::Cell;

/// How the samples of a run become one number. The names are those of the function table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum How {
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

impl How {
    pub(super) fn of(aggregate: &Aggregate) -> Option<How> {
        Some(match crate::bind::functions::name(aggregate.function)? {
            "first" => How::First,
            "at" => How::At,
            "before" => How::Before,
            "initial" => How::Initial,
            "final" => How::Final,
            "previous" => How::Previous,
            "min" => How::Min,
            "max" => How::Max,
            "mean" => How::Mean,
            "crossing" => How::Crossing,
            "period" => How::Period,
            "last" => How::Last,
            "count" => How::Count,
            "crossings" => How::Crossings,
            "settles" => How::Settles,
            "peak" => How::Peak,
            "holds" => How::Holds,
            "rate" => How::Rate,
            "integral" => How::Integral,
            "rms" => How::Rms,
            _ => return None,
        })
    }
}

/// What a measure looks at: a simulation, sample after sample.
pub(super) trait Sample {
    /// Time of the sample, s.
    fn time(&self) -> f64;

    /// What programs run in.
    fn context(&mut self) -> &mut Context;

    /// The value of a program; `None` where it throws.
    fn evaluate(&mut self, program: &Program, text: &Text) -> Option<Value>;
}

impl Sample for Session<'_> {
    fn time(&self) -> f64 {
        self.world.data.time()
    }

    fn context(&mut self) -> &mut Context {
        &mut self.context
    }

    fn evaluate(&mut self, program: &Program, text: &Text) -> Option<Value> {
        Session::evaluate(self, program, text)
    }
}

/// One aggregate on its way through the samples.
#[derive(Debug)]
struct Running<'a> {
    how: How,
    args: &'a [Program],
    /// The aggregates in its arguments, which look at each sample before it does.
    inner: Vec<Running<'a>>,
    slot: usize,
    /// The result so far, NaN before there is one.
    result: f64,
    /// The condition has held, or the first sample was seen.
    done: bool,
    /// The value at the sample before.
    previous: f64,
    /// What the measures between samples remember.
    trail: Trail,
    /// Samples at which there was no number to look at, where that leaves the result open.
    gaps: Gaps,
    /// The sample before had no number.
    lacked: bool,
}

/// Samples without a number.
#[derive(Clone, Copy, Debug, Default)]
struct Gaps {
    count: usize,
    /// Time of the first one, s.
    first: f64,
}

/// Why a measure has no value although its events happened: some samples had no number.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Doubt {
    /// The part of the measure, as written.
    pub(crate) part: String,
    /// Samples without a number, of how many.
    pub(crate) gaps: usize,
    pub(crate) samples: usize,
    /// Time of the first one, s.
    pub(crate) first: f64,
}

impl std::fmt::Display for Doubt {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Doubt { part, gaps, samples, first } = self;
        if *samples == 0 {
            return write!(f, "`{part}` compares NaN");
        }
        let first = crate::run::time(*first);
        let verb = if *gaps == 1 { "has" } else { "have" };
        write!(f, "in `{part}` {gaps} of {samples} samples {verb} no number, the first at t = {first} s")
    }
}

/// What became of a measure.
#[derive(Clone, Debug)]
pub(crate) struct Sampled {
    /// Its value; NaN where samples had no number.
    pub(crate) value: f64,
    /// The results of its aggregates, in order.
    pub(crate) parts: Vec<f64>,
    pub(crate) doubt: Option<Doubt>,
}

/// What is remembered of a curve from sample to sample.
#[derive(Debug)]
struct Trail {
    /// Time and value at the sample before; NaN before the first one.
    time: f64,
    value: f64,
    /// The last value that was not zero was below it.
    below: bool,
    /// When the curve reached zero exactly, coming from below.
    reached: Option<f64>,
    /// First and last time at which it passed zero upwards, and how often it did.
    first: f64,
    last: f64,
    count: usize,
    /// Area under the curve, and the time that it covers.
    area: f64,
    covered: f64,
    /// The side of zero that it was last seen on; zero when it is not known.
    side: f64,
    line: Line,
}

/// The straight line through points that is nearest to them: its sums, about the means of the points so far (Welford 1962).
#[derive(Clone, Copy, Debug, Default)]
struct Line {
    count: f64,
    mean: [f64; 2],
    /// Sums of (t - t̄)² and (t - t̄)(x - x̄).
    squares: f64,
    products: f64,
}

impl Line {
    fn add(&mut self, t: f64, x: f64) {
        self.count += 1.0;
        let [dt, dx] = [t - self.mean[0], x - self.mean[1]];
        self.mean[0] += dt / self.count;
        self.mean[1] += dx / self.count;
        self.squares += dt * (t - self.mean[0]);
        self.products += dt * (x - self.mean[1]);
    }

    fn slope(&self) -> f64 {
        if self.squares > 0.0 { self.products / self.squares } else { f64::NAN }
    }
}

impl Trail {
    const START: Trail = Trail {
        time: f64::NAN,
        value: f64::NAN,
        below: false,
        reached: None,
        first: f64::NAN,
        last: f64::NAN,
        count: 0,
        area: 0.0,
        covered: 0.0,
        side: 0.0,
        line: Line { count: 0.0, mean: [0.0; 2], squares: 0.0, products: 0.0 },
    };

    /// The time at which a straight line from the sample before to this one is zero. A sample that is zero is one at
    /// its own time.
    fn zero(&self, time: f64, value: f64) -> Option<f64> {
        if value == 0.0 {
            return Some(time);
        }
        // Not across a reset, which turns time back.
        let passes = self.time < time && self.value * value < 0.0;
        passes.then(|| self.time + (time - self.time) * (self.value / (self.value - value)))
    }

    /// Takes a sample in as a part of an oscillation.
    fn oscillate(&mut self, time: f64, value: f64) {
        let goes_on = self.time < time;
        if !goes_on || value.is_nan() {
            // Nothing is known of what was before a gap or a reset.
            (self.below, self.reached) = (false, None);
        }
        let zero = self.zero(time, value);
        if value == 0.0 && self.below {
            self.reached = self.reached.or(zero);
        } else if value > 0.0 && self.below {
            if let Some(at) = self.reached.or(zero) {
                self.first = if self.count == 0 { at } else { self.first };
                (self.last, self.count) = (at, self.count + 1);
            }
            (self.below, self.reached) = (false, None);
        } else if value < 0.0 {
            (self.below, self.reached) = (true, None);
        }
        self.remember(time, value);
    }

    /// Counts passages in either direction. What touches zero and goes back has not passed.
    fn pass(&mut self, time: f64, value: f64) {
        if value.is_nan() || self.time > time {
            self.side = 0.0;
        } else if value != 0.0 {
            self.count += usize::from(self.side * value < 0.0);
            self.side = value.signum();
        }
        self.remember(time, value);
    }

    /// Adds the area between the sample before and this one.
    fn add_area(&mut self, time: f64, value: f64) {
        if self.time < time {
            self.area += 0.5 * (self.value + value) * (time - self.time);
            self.covered += time - self.time;
        }
        self.remember(time, value);
    }

    fn remember(&mut self, time: f64, value: f64) {
        (self.time, self.value) = (time, value);
    }

    /// Mean time from one upward passage to the next; NaN with fewer than two.
    fn period(&self) -> f64 {
        if self.count < 2 { f64::NAN } else { (self.last - self.first) / (self.count - 1) as f64 }
    }

    /// The mean over time; the value itself when there is one sample.
    fn mean(&self) -> f64 {
        if self.covered > 0.0 { self.area / self.covered } else { self.value }
    }
}

impl<'a> Running<'a> {
    /// The aggregates of a program, before the first sample.
    fn all(program: &'a Program) -> Vec<Running<'a>> {
        let start = |a: &'a Aggregate| {
            let how = How::of(a)?;
            Some(Running {
                how,
                args: &a.args,
                inner: a.args.iter().flat_map(Running::all).collect(),
                slot: a.slot,
                result: Running::before(how),
                done: false,
                previous: f64::NAN,
                trail: Trail::START,
                gaps: Gaps::default(),
                lacked: false,
            })
        };
        program.aggregates().iter().filter_map(start).collect()
    }

    /// The result before the first sample: nothing is there yet, nothing was counted, nothing has failed.
    fn before(how: How) -> f64 {
        match how {
            How::Count | How::Crossings | How::Integral => 0.0,
            How::Holds => 1.0,
            _ => f64::NAN,
        }
    }

    /// The result, as far as it is known: NaN where samples had no number.
    fn known(&self) -> f64 {
        if self.gaps.count > 0 { f64::NAN } else { self.result }
    }

    /// Whether an argument looks at the sample before the first one.
    fn has_no_past(&self) -> bool {
        self.inner.iter().any(|r| r.how == How::Previous && !r.done || r.has_no_past())
    }

    /// Looks at the current sample. What stands in its arguments is what it is up to this sample.
    fn sample(&mut self, session: &mut dyn Sample, text: &Text) {
        let first = self.has_no_past();
        for inner in &mut self.inner {
            inner.sample(session, text);
            session.context().set_aggregate(inner.slot, inner.known());
        }
        let (r, time) = (self, session.time());
        if r.done && matches!(r.how, How::First | How::At | How::Before | How::Crossing | How::Initial) {
            return;
        }
        let lacks = Cell::new(false);
        let mut value = |i: usize| {
            let value = r.args.get(i).and_then(|p| session.evaluate(p, text)).unwrap_or(Value::Undefined);
            let nothing =
                matches!(value, Value::Undefined) || matches!(value, Value::Number(x) if x.is_nan());
            let mut lost = || session.context().watched().is_some_and(|watch| watch.lost.is_some());
            if nothing || lost() {
                lacks.set(true);
            }
            value
        };
        // A later sample decides whatever earlier ones left open.
        let mut decided = false;
        match r.how {
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
                let holds = value(0).truthy();
                let open = lacks.replace(false);
                let x = value(1).to_number();
                let before = std::mem::replace(&mut r.lacked, lacks.get());
                lacks.set(open || holds && before);
                if holds {
                    (r.result, r.done) = (r.previous, true);
                } else {
                    r.previous = x;
                }
            }
            How::Initial => (r.result, r.done) = (value(0).to_number(), true),
            How::Final => {
                r.result = value(0).to_number();
                decided = true;
            }
            How::Previous => {
                let x = value(0).to_number();
                let x = if lacks.replace(false) { f64::NAN } else { x };
                (r.result, r.previous, r.done) = (r.previous, x, true);
            }
            How::Min => r.result = least(r.result, value(0).to_number()),
            How::Max => r.result = -least(-r.result, -value(0).to_number()),
            How::Mean => {
                r.trail.add_area(time, value(0).to_number());
                r.result = r.trail.mean();
            }
            How::Crossing => {
                let x = above(&mut value, r.args);
                if let Some(at) = r.trail.zero(time, x) {
                    (r.result, r.done) = (at, true);
                }
                r.trail.remember(time, x);
            }
            How::Period => {
                let x = above(&mut value, r.args);
                r.trail.oscillate(time, x);
                r.result = r.trail.period();
            }
            How::Last => {
                if value(0).truthy() {
                    r.result = time;
                    decided = !lacks.get();
                }
            }
            How::Count => {
                let holds = value(0).truthy();
                r.result += f64::from(holds && !r.done);
                r.done = holds;
            }
            How::Crossings => {
                let x = above(&mut value, r.args);
                r.trail.pass(time, x);
                r.result = r.trail.count as f64;
            }
            How::Settles => {
                let [x, target, band] = [0, 1, 2].map(|i| value(i).to_number());
                let inside = (x - target).abs() <= band;
                decided = !inside && !lacks.get();
                r.result = if !inside {
                    f64::NAN
                } else if r.result.is_nan() {
                    time
                } else {
                    r.result
                };
            }
            How::Peak => {
                let x = value(0).to_number();
                if x > r.previous || (r.previous.is_nan() && !x.is_nan()) {
                    (r.result, r.previous) = (time, x);
                }
            }
            How::Holds => {
                if !value(0).truthy() && !lacks.get() {
                    r.result = 0.0;
                }
                // Once it has failed, nothing that comes makes it hold.
                decided = r.result == 0.0;
                lacks.set(lacks.get() && !decided);
            }
            How::Rate => {
                r.trail.line.add(time, value(0).to_number());
                r.result = r.trail.line.slope();
            }
            How::Integral => {
                r.trail.add_area(time, value(0).to_number());
                r.result = r.trail.area;
            }
            How::Rms => {
                let x = value(0).to_number();
                r.trail.add_area(time, x * x);
                r.result = r.trail.mean().sqrt();
            }
        }
        if decided {
            r.gaps = Gaps::default();
        }
        if lacks.get() && !first {
            if r.gaps.count == 0 {
                r.gaps.first = time;
            }
            r.gaps.count += 1;
        }
    }
}

/// The smaller of the extreme so far, NaN before there is one, and a number.
fn least(so_far: f64, x: f64) -> f64 {
    if so_far.is_nan() || x < so_far { x } else { so_far }
}

/// The aggregates of one measure.
#[derive(Debug)]
pub(super) struct Measure<'a> {
    program: &'a Program,
    text: &'a Text,
    running: Vec<Running<'a>>,
    samples: usize,
    /// Watches its own programs, and no others.
    watch: Option<Box<Watch>>,
}

impl<'a> Measure<'a> {
    /// A measure before the first sample.
    pub(super) fn new(program: &'a Program, text: &'a Text) -> Measure<'a> {
        let watch = Some(Box::new(Watch::losses()));
        Measure { program, text, running: Running::all(program), samples: 0, watch }
    }

    /// Looks at the current sample.
    pub(super) fn sample(&mut self, session: &mut dyn Sample) {
        self.samples += 1;
        session.context().watch(self.watch.take());
        self.running.iter_mut().for_each(|r| r.sample(session, self.text));
        self.watch = session.context().watch(None);
    }

    /// The results of its aggregates, when the run is over.
    pub(super) fn parts(&self) -> Vec<f64> {
        self.running.iter().map(Running::known).collect()
    }

    /// The measure, when the run is over.
    pub(super) fn finish(mut self, session: &mut dyn Sample) -> Sampled {
        for r in &self.running {
            session.context().set_aggregate(r.slot, r.known());
        }
        session.context().watch(self.watch.take());
        let value = session.evaluate(self.program, self.text).map_or(f64::NAN, |v| v.to_number());
        let lost = session.context().watch(None).and_then(|watch| watch.lost);
        let part = |start: usize, end: usize| {
            self.text.value.get(start..end).unwrap_or(&self.text.value).to_string()
        };
        let open = self.running.iter().zip(self.program.aggregates()).find(|(r, _)| r.gaps.count > 0);
        let doubt = match (open, lost) {
            (Some((r, aggregate)), _) => Some(Doubt {
                part: part(aggregate.span.start, aggregate.span.end),
                gaps: r.gaps.count,
                samples: self.samples,
                first: r.gaps.first,
            }),
            (None, Some(span)) => {
                Some(Doubt { part: part(span.start, span.end), gaps: 0, samples: 0, first: 0.0 })
            }
            (None, None) => None,
        };
        let parts = self.parts();
        Sampled { value: if doubt.is_some() { f64::NAN } else { value }, parts, doubt }
    }
}

/// How far the first argument is above the second one, the level; above zero when there is no level.
fn above(value: &mut impl FnMut(usize) -> Value, args: &[Program]) -> f64 {
    let level = if args.len() > 1 { value(1).to_number() } else { 0.0 };
    value(0).to_number() - level
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn crossing(samples: &[(f64, f64)]) -> f64 {
        let mut trail = Trail::START;
        for &(time, value) in samples {
            if let Some(at) = trail.zero(time, value) {
                return at;
            }
            trail.remember(time, value);
        }
        f64::NAN
    }

    fn period(samples: &[(f64, f64)]) -> f64 {
        let mut trail = Trail::START;
        samples.iter().for_each(|&(t, x)| trail.oscillate(t, x));
        trail.period()
    }

    fn mean(samples: &[(f64, f64)]) -> f64 {
        let mut trail = Trail::START;
        samples.iter().for_each(|&(t, x)| trail.add_area(t, x));
        trail.mean()
    }

    #[test]
    fn a_crossing_lies_between_two_samples() {
        assert_eq!(crossing(&[(0.0, 1.0), (1.0, -3.0)]), 0.25);
        assert_eq!(crossing(&[(0.0, -3.0), (1.0, 1.0)]), 0.75);
        // A sample that is zero counts, a start too.
        assert_eq!(crossing(&[(0.0, 1.0), (1.0, 0.0), (2.0, 1.0)]), 1.0);
        assert_eq!(crossing(&[(0.0, 0.0), (1.0, 1.0)]), 0.0);
        for never in [&[(0.0, 1.0), (1.0, 2.0)][..], &[(0.0, 1.0), (1.0, f64::NAN), (2.0, -1.0)], &[]] {
            assert!(crossing(never).is_nan(), "{never:?}");
        }
        // A reset turns time back: nothing happened between the two.
        assert!(crossing(&[(5.0, 1.0), (0.0, -1.0)]).is_nan());
    }

    #[test]
    fn a_period_is_from_upward_passage_to_upward_passage() {
        let saw = |n: usize| -> Vec<(f64, f64)> {
            (0..n).map(|i| (i as f64, [-1.0, 1.0, 1.0, -1.0][i % 4])).collect()
        };
        assert_eq!(period(&saw(9)), 4.0);
        assert!(period(&saw(5)).is_nan());
        // Zeros on the way count once, and a touch from below does not.
        assert_eq!(period(&[(0.0, -1.0), (1.0, 0.0), (2.0, 0.0), (3.0, 1.0), (4.0, -1.0), (5.0, 1.0)]), 3.5);
        assert!(period(&[(0.0, -1.0), (1.0, 0.0), (2.0, -1.0), (3.0, 0.0), (4.0, -1.0)]).is_nan());
        // What was before a gap is not known.
        assert!(period(&[(0.0, -1.0), (1.0, 1.0), (2.0, -1.0), (3.0, f64::NAN), (4.0, 1.0)]).is_nan());
    }

    #[test]
    fn a_mean_is_over_time() {
        assert_eq!(mean(&[(0.0, 0.0), (1.0, 1.0), (3.0, 1.0)]), 2.5 / 3.0);
        assert_eq!(mean(&[(0.0, 7.0)]), 7.0);
        assert!(mean(&[(0.0, f64::NAN), (1.0, 1.0)]).is_nan() && mean(&[]).is_nan());
    }

    proptest! {
        /// A zero between two samples is missed by O(h^2) when it is interpolated (and by h when it is not).
        #[test]
        fn the_period_of_a_sine_is_found_between_samples(omega in 1.0f64..20.0, phase in 0.0f64..6.2, h in 1e-4f64..5e-3) {
            let true_period = 2.0 * std::f64::consts::PI / omega;
            let n = (5.2 * true_period / h) as usize;
            let samples: Vec<_> = (0..n).map(|i| i as f64 * h).map(|t| (t, (omega * t + phase).sin())).collect();
            let found = period(&samples);
            // A chord misses a zero of a sine by less than (omega h)^3 / 15 of a radian.
            let bound = (omega * h).powi(3) / omega + 1e-12;
            prop_assert!((found - true_period).abs() <= bound, "{} and not {}", found, true_period);
            let first = crossing(&samples);
            let exact = (std::f64::consts::PI - phase).rem_euclid(std::f64::consts::PI) / omega;
            prop_assert!((first - exact).abs() <= bound || (first - exact).abs() > true_period / 2.0 - bound, "{} and not {}", first, exact);
        }
    }
}
