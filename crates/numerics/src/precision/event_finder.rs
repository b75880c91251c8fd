//! Event times of a run: first contact, zero crossings and turning points of numbers.
//!
//! An event between two steps is located by repeating the step from the state before it with shorter lengths. A one-step method
//! gives the state at any time inside a step as accurately as at its end (dense output by repeated steps). A turning point is a
//! zero of the derivative of the interpolating polynomial at Chebyshev points (Trefethen 2013, *Approximation Theory and
//! Approximation Practice*, chapters 3 and 21).

use super::chebyshev::turning_point;
use super::event_time::EventTime;
use super::numbers::range;
use super::setting::Setting;
use super::step_replay::{Evaluate, StepHistory, StepReplay};
use labspec::run::Session;
use labspec_core::Model;

/// The thresholds for a zero crossing (distance from zero on both sides) and for a turning point, as parts of the range.
/// Smaller changes are rounding, or a scene that settles.
const MIN_CROSSING: f64 = 1e-5;
const MIN_TURN: f64 = 1e-3;
/// A number that changes by less than this part of its size has no events.
const CONSTANT: f64 = 1e-9;
/// Bodies within this distance at the start are in contact, m.
const CONTACT_DISTANCE: f64 = 1e-9;
/// The maximum number of turning points of one number that are located.
const MAX_TURNING_POINTS: usize = 100;
/// The number of bisections that locate a time up to rounding.
const BISECTIONS: usize = 80;

/// The thresholds of the events of each target: for zero crossings and for turning points.
#[derive(Clone, Debug)]
pub(super) struct EventThresholds {
    least: Vec<[f64; 2]>,
}

impl EventThresholds {
    /// Computes the thresholds for numbers with such values. A constant number has no events.
    pub(super) fn for_values(values: &[Vec<f64>]) -> EventThresholds {
        let least = |values: &Vec<f64>| {
            let size = values.iter().fold(0.0f64, |a, x| a.max(x.abs()));
            let range = range(values);
            let range = if range > CONSTANT * size { range } else { f64::INFINITY };
            [MIN_CROSSING * range, MIN_TURN * range]
        };
        EventThresholds { least: values.iter().map(least).collect() }
    }
}

/// The search for the first zero crossing of a number.
#[derive(Clone, Debug)]
struct ZeroCrossing {
    side: f64,
    last: f64,
    candidate: EventTime,
    done: bool,
}

/// The search for the first turning point of a number.
#[derive(Clone, Debug)]
struct TurningPoint {
    low: f64,
    high: f64,
    /// 1 for upwards, -1 for downwards, 0 while unknown.
    direction: f64,
    last: f64,
    candidate: EventTime,
    looks: usize,
    done: bool,
}

/// Finds the events of a run.
pub(super) struct EventFinder<'s> {
    sought: &'s EventThresholds,
    /// Whether the method has a high order, so that its steps can be repeated with any length.
    dense: bool,
    history: StepHistory,
    /// The length of a step, the start time, s, and the number of steps since. The engine's own time is a sum of that
    /// many steps, each rounded.
    step: f64,
    start: f64,
    made: usize,
    /// Pairs of geoms that are in contact at the start.
    touching: Vec<[usize; 2]>,
    contact: Option<EventTime>,
    passages: Vec<ZeroCrossing>,
    turns: Vec<TurningPoint>,
    /// The time at which the last event was confirmed, s.
    settled: f64,
}

impl<'s> EventFinder<'s> {
    pub(super) fn new(sought: &'s EventThresholds, m: &Model, setting: &Setting) -> EventFinder<'s> {
        let none = EventTime::NONE;
        let passage = ZeroCrossing { side: 0.0, last: f64::NAN, candidate: none, done: false };
        let (low, high) = (f64::INFINITY, f64::NEG_INFINITY);
        let turn = TurningPoint {
            low,
            high,
            direction: 0.0,
            last: f64::NAN,
            candidate: none,
            looks: 0,
            done: false,
        };
        EventFinder {
            sought,
            dense: setting.integrator.is_high(),
            history: StepHistory::new(m),
            step: setting.timestep,
            start: 0.0,
            made: 0,
            touching: Vec::new(),
            contact: None,
            passages: vec![passage; sought.least.len()],
            turns: vec![turn; sought.least.len()],
            settled: 0.0,
        }
    }

    /// The time at which the last event so far was confirmed, s.
    pub(super) fn settled(&self) -> f64 {
        self.settled
    }

    /// Whether all events have been found.
    pub(super) fn is_complete(&self) -> bool {
        self.contact.is_some() && self.passages.iter().all(|p| p.done) && self.turns.iter().all(|t| t.done)
    }

    /// Processes the state of the run after a step, with the displayed values.
    pub(super) fn observe_step(&mut self, session: &Session<'_>, values: &[f64], evaluate: &Evaluate<'_>) {
        let time = self.time(session);
        self.history.keep(session, time);
        let before = self.number_found();
        if self.history.count() == 1 {
            let near = |c: &labspec_core::Contact| c.dist <= CONTACT_DISTANCE;
            let contacts = session.world.data.fields().contact.iter().filter(|c| near(c));
            self.touching = contacts.map(|c| [c.geom1, c.geom2]).collect();
        } else if self.contact.is_none() && depth(session, &self.touching) > 0.0 {
            self.contact = Some(self.first_contact(session));
        }
        for (i, &value) in values.iter().enumerate() {
            self.observe_crossing(i, value, session, evaluate);
            self.turn(i, value, session, evaluate);
        }
        if self.number_found() > before {
            self.settled = self.history.time(0);
        }
    }

    /// The time of the next state.
    fn time(&mut self, session: &Session<'_>) -> f64 {
        let clock = session.world.data.time();
        if self.history.count() == 0 {
            self.start = clock;
        }
        let time = self.start + self.made as f64 * self.step;
        self.made += 1;
        // A button may have set the clock.
        if (time - clock).abs() <= 0.1 * self.step { time } else { clock }
    }

    fn number_found(&self) -> usize {
        let passages = self.passages.iter().filter(|p| p.done).count();
        passages + self.turns.iter().filter(|t| t.done).count() + usize::from(self.contact.is_some())
    }

    /// Returns the first contact, then all zero crossings, then all turning points.
    pub(super) fn finish(self) -> Vec<EventTime> {
        let found = |done: bool, candidate: EventTime| if done { candidate } else { EventTime::NONE };
        let contact = std::iter::once(self.contact.unwrap_or(EventTime::NONE));
        let passages = self.passages.iter().map(|p| found(p.done, p.candidate));
        let turns = self.turns.iter().map(|t| found(t.done, t.candidate));
        contact.chain(passages).chain(turns).collect()
    }

    /// Whether bodies are in contact at the start. Such contacts are not a first contact.
    pub(super) fn touches_at_start(&self) -> bool {
        !self.touching.is_empty()
    }

    fn observe_crossing(&mut self, i: usize, current: f64, session: &Session<'_>, evaluate: &Evaluate<'_>) {
        let (Some(p), Some([least, _])) = (self.passages.get_mut(i), self.sought.least.get(i)) else {
            return;
        };
        let last = std::mem::replace(&mut p.last, current);
        if p.done || !current.is_finite() {
            return;
        }
        let crossed = p.side != 0.0 && current * p.side <= 0.0 && last * p.side > 0.0;
        if p.side != 0.0 && current * p.side > 0.0 {
            p.candidate = EventTime::NONE;
        }
        if crossed {
            let side = p.side;
            let mut bench = StepReplay::new(session, &self.history);
            let found = crossing_time(&mut bench, i, side, evaluate);
            let Some(p) = self.passages.get_mut(i) else { return };
            p.candidate = found.unwrap_or_else(|| between(&self.history, last, current));
        }
        let Some(p) = self.passages.get_mut(i) else { return };
        if current.abs() > *least {
            p.done = p.side != 0.0 && current.signum() != p.side;
            p.side = current.signum();
        }
    }

    fn turn(&mut self, i: usize, current: f64, session: &Session<'_>, evaluate: &Evaluate<'_>) {
        let (Some(t), Some([_, least])) = (self.turns.get_mut(i), self.sought.least.get(i)) else { return };
        let last = std::mem::replace(&mut t.last, current);
        if t.done || !current.is_finite() {
            return;
        }
        // The last sample was the extreme value so far, and the number has turned back.
        let extreme = if t.direction > 0.0 { t.high } else { t.low };
        let begins = t.direction != 0.0 && last == extreme && (current - last) * t.direction < 0.0;
        (t.low, t.high) = (t.low.min(current), t.high.max(current));
        if t.direction == 0.0 {
            t.direction = if current - t.low > *least {
                1.0
            } else if t.high - current > *least {
                -1.0
            } else {
                0.0
            };
            return;
        }
        let back = if t.direction > 0.0 { t.high - current } else { current - t.low };
        let (direction, looks) = (t.direction, t.looks);
        if begins {
            t.looks += 1;
            let dense = self.dense && looks < MAX_TURNING_POINTS;
            let mut bench = StepReplay::new(session, &self.history);
            let found = turning_point(&mut bench, i, direction, dense, evaluate);
            let Some(t) = self.turns.get_mut(i) else { return };
            t.candidate = found.unwrap_or(EventTime::NONE);
        }
        let Some(t) = self.turns.get_mut(i) else { return };
        t.done = back > *least;
    }

    /// The time of the first contact of bodies that were apart at the start: the shortest step that ends with a contact.
    fn first_contact(&self, session: &Session<'_>) -> EventTime {
        let mut bench = StepReplay::new(session, &self.history);
        // A displayed contact belongs to the previous step.
        let oldest = self.history.count().min(3) - 1;
        let touches = |bench: &mut StepReplay<'_>, from: usize, x: f64| {
            bench.place(from, x);
            depth(&bench.session, &self.touching)
        };
        let from = (1..=oldest).rev().find(|&j| touches(&mut bench, j - 1, 0.0) > 0.0);
        let Some(from) = from else { return EventTime::NONE };
        let h = self.history.step(from);
        let (mut low, mut high) = (0.0, h);
        let start = self.history.time(from);
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                break;
            }
            if touches(&mut bench, from, middle) > 0.0 {
                high = middle
            } else {
                low = middle
            }
            if high - low <= f64::EPSILON * (start + high) {
                break;
            }
        }
        let later = (high + 1e-3 * h).min(h);
        let speed = (touches(&mut bench, from, later) / (later - high)).abs();
        let size =
            bench.session.world.data.fields().contact.iter().map(|c| length(c.pos)).fold(1.0, f64::max);
        let rounding = 8.0 * f64::EPSILON * size / speed.max(f64::MIN_POSITIVE);
        let uncertainty = (high - low) + if rounding.is_finite() { rounding.min(h) } else { h };
        EventTime { time: start + high, uncertainty, slope: f64::INFINITY, top: false }
    }
}

fn length(v: [f64; 3]) -> f64 {
    v.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// The penetration depth of bodies that were apart at the start, m; NaN if none are near each other.
fn depth(session: &Session<'_>, touching: &[[usize; 2]]) -> f64 {
    let contacts = session.world.data.fields().contact.iter();
    let others = contacts.filter(|c| !touching.contains(&[c.geom1, c.geom2]));
    others.map(|c| -c.dist).fold(f64::NAN, f64::max)
}

/// A zero crossing between the last two samples, by linear interpolation.
fn between(history: &StepHistory, last: f64, current: f64) -> EventTime {
    let h = history.step(1);
    let part = (last / (last - current)).clamp(0.0, 1.0);
    EventTime {
        time: history.time(1) + part * h,
        uncertainty: 2.0 * h,
        slope: (current - last).abs() / h,
        top: false,
    }
}

/// The time at which a target crosses zero in the last step or in the one before.
fn crossing_time(
    bench: &mut StepReplay<'_>,
    i: usize,
    side: f64,
    evaluate: &Evaluate<'_>,
) -> Option<EventTime> {
    let oldest = bench.history.count().min(3) - 1;
    let leaves = |bench: &mut StepReplay<'_>, j: usize| {
        bench.value(j, 0.0, i, evaluate) * side > 0.0 && bench.value(j - 1, 0.0, i, evaluate) * side <= 0.0
    };
    let from = (1..=oldest).rev().find(|&j| leaves(bench, j))?;
    let (h, start) = (bench.history.step(from), bench.history.time(from));
    let (mut low, mut high) = (0.0, h);
    let mut at_low = bench.value(from, 0.0, i, evaluate) * side;
    let mut at_high = bench.value(from - 1, 0.0, i, evaluate) * side;
    // The repeated step must end at the same value.
    let again = bench.value(from, h, i, evaluate) * side;
    let residual = (again - at_high).abs();
    if again > 0.0 {
        return None;
    }
    let mut moved = 0.0;
    for k in 0..BISECTIONS {
        // The Illinois method, with bisection if it does not progress.
        let line = low + (high - low) * at_low / (at_low - at_high);
        let inside = line > low && line < high && k % 3 != 2;
        let x = if inside { line } else { 0.5 * (low + high) };
        if x <= low || x >= high || high - low <= 0.5 * f64::EPSILON * (start + high) {
            break;
        }
        let value = bench.value(from, x, i, evaluate) * side;
        if value > 0.0 {
            (low, at_low) = (x, value);
            at_high *= if moved > 0.0 { 0.5 } else { 1.0 };
        } else {
            (high, at_high) = (x, value);
            at_low *= if moved < 0.0 { 0.5 } else { 1.0 };
        }
        moved = value.signum();
        if value == 0.0 {
            low = x;
            break;
        }
    }
    let delta = 0.02 * h;
    let [a, b] = [(high - delta).max(0.0), (high + delta).min(h)];
    let slope = (bench.value(from, b, i, evaluate) - bench.value(from, a, i, evaluate)).abs() / (b - a);
    let size = bench.size.max(residual);
    let rounding = (8.0 * f64::EPSILON * size + residual) / slope.max(f64::MIN_POSITIVE);
    let uncertainty = (high - low) + rounding.min(2.0 * h);
    Some(EventTime { time: start + 0.5 * (low + high), uncertainty, slope, top: false })
}
