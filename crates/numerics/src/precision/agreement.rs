//! The reference solution, as far as two runs with different methods agree on it.

use super::case::PrecisionCase;
use super::event_finder::EventThresholds;
use super::event_time::EventTime;
use super::numbers::range;
use super::run_record::{RecordRequest, RunStatus, SampledRun};
use super::setting::Setting;
use labspec::run::RunError;
use labspec::run::{INTEGRATORS, Integrator};

/// The reference solution, as far as it is known.
pub(super) struct ReferenceSolution {
    /// The values of each target at the samples.
    pub(super) values: Vec<Vec<f64>>,
    /// The uncertainty of each value, from the largest difference of the two families so far.
    pub(super) uncertain: Vec<Vec<f64>>,
    /// The run from which energy and penetration depth are taken.
    pub(super) run: SampledRun,
    /// The uncertainty of the penetration depth, m.
    pub(super) depth_doubt: f64,
    /// The times of the first contact, of zero crossings and of turning points.
    pub(super) moments: Vec<KnownEvent>,
    /// The thresholds of the events to find in other runs.
    pub(super) sought: EventThresholds,
    /// Whether a force could be discontinuous in one of the runs.
    pub(super) jumps: bool,
    /// The two families in words.
    pub(super) how: String,
}

/// An event of the reference solution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct KnownEvent {
    /// The time, s; NaN if the event does not happen or its time is unknown.
    pub(super) time: f64,
    /// The uncertainty of the time, s.
    pub(super) uncertainty: f64,
    /// Whether a turning point is a maximum.
    pub(super) top: bool,
}

/// The uncertainty of a number as a multiple of the difference between the families. The errors of both may have the same sign,
/// for example because rounding the parameters of the scene shifts both.
const SAME_SIDE: f64 = 2.0;
/// The maximum number of steps of the second family.
pub(super) const MOST_STEPS: usize = 2_000_000;
/// The time of an event counts as unknown if its uncertainty exceeds this part of the run.
pub(super) const UNKNOWN: f64 = 0.02;

pub(super) fn method(id: i32) -> Integrator {
    INTEGRATORS.into_iter().find(|i| i.id == id).unwrap_or(INTEGRATORS[0])
}

/// Performs a run, and returns it if it reaches its end.
pub(super) fn run(
    case: &PrecisionCase<'_>,
    id: i32,
    timestep: f64,
    ask: RecordRequest<'_>,
) -> Result<Option<SampledRun>, RunError> {
    let seen = case.run(&Setting { integrator: method(id), timestep, solver: None }, ask)?;
    Ok(matches!(seen.status, RunStatus::Good | RunStatus::Warned).then_some(seen))
}

pub(super) fn too_long(case: &PrecisionCase<'_>, timestep: f64) -> bool {
    case.count as f64 * (case.interval / timestep) > MOST_STEPS as f64
}

/// The event times of two runs, as far as they agree. The time of a zero crossing inherits the uncertainty of the number. All
/// times have the rounding error of a sum of this many steps.
pub(super) fn agreed(
    case: &PrecisionCase<'_>,
    uncertain: &[Vec<f64>],
    [a, b]: [&[EventTime]; 2],
    steps: f64,
) -> Vec<KnownEvent> {
    let n = case.targets.len();
    let one = |(i, (a, b)): (usize, (&EventTime, &EventTime))| {
        let target = (1..=n).contains(&i).then(|| uncertain.get(i - 1)).flatten();
        let sample = (a.time / case.interval).ceil() as usize;
        let value = target.and_then(|list| list.get(sample.min(list.len().saturating_sub(1))));
        let moved = value.map_or(0.0, |u| u / a.slope.min(b.slope).max(f64::MIN_POSITIVE));
        // The shift of a turning point shows only in the difference.
        let difference = if i > n { 4.0 } else { 2.0 } * (a.time - b.time).abs();
        let rounding = f64::EPSILON * (8.0 + steps.sqrt()) * a.time;
        let uncertainty = difference + a.uncertainty + b.uncertainty + moved + rounding;
        // If the difference is NaN, the event is unknown.
        match uncertainty <= UNKNOWN * case.length() && a.top == b.top {
            true => KnownEvent { time: a.time, uncertainty, top: a.top },
            false => KnownEvent { time: f64::NAN, uncertainty: f64::NAN, top: false },
        }
    };
    a.iter().zip(b).enumerate().map(one).collect()
}

/// The uncertainty of a list: the largest difference so far to another one; infinite from the first NaN on.
pub(super) fn so_far<'a>(pairs: impl Iterator<Item = (&'a Vec<f64>, &'a Vec<f64>)>) -> Vec<Vec<f64>> {
    let differ = |a: f64, b: f64| if (a - b).is_nan() { f64::INFINITY } else { SAME_SIDE * (a - b).abs() };
    let each = |(a, b): (&Vec<f64>, &Vec<f64>)| {
        let mut worst = 0.0f64;
        let so_far = a.iter().zip(b).map(|(a, b)| {
            worst = worst.max(differ(*a, *b));
            worst
        });
        so_far.collect()
    };
    pairs.map(each).collect()
}

/// The largest difference of the two families, relative to the range of the quantity.
pub(super) fn largest_relative_difference(values: &[Vec<f64>], uncertain: &[Vec<f64>]) -> f64 {
    let relative_error = |(values, uncertain): (&Vec<f64>, &Vec<f64>)| {
        uncertain.last().copied().unwrap_or(0.0) / range(values).max(f64::MIN_POSITIVE)
    };
    values.iter().zip(uncertain).map(relative_error).fold(0.0, f64::max)
}

/// Whether two families agree up to a part of the range, or up to rounding.
pub(super) fn agree(values: &[Vec<f64>], uncertain: &[Vec<f64>], part: f64) -> bool {
    values.iter().zip(uncertain).all(|(values, uncertain)| {
        let size = values.iter().fold(0.0f64, |a, x| a.max(x.abs()));
        uncertain.last().is_none_or(|u| *u <= part * range(values) || *u <= 1e-12 * size)
    })
}
