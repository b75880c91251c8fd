//! A reference as far as two runs of different methods agree on it.

use super::case::PrecisionCase;
use super::event_finder::EventThresholds;
use super::event_time::EventTime;
use super::numbers::range;
use super::run_record::{Run, RunRequest, RunStatus};
use super::setting::Setting;
use labspec::run::RunError;
use labspec::run::{INTEGRATORS, Integrator};

/// The truth as far as it is known.
pub(super) struct Reference {
    /// Values of each target at the samples.
    pub(super) values: Vec<Vec<f64>>,
    /// How far each may be off, by what the two families have differed by at most so far.
    pub(super) uncertain: Vec<Vec<f64>>,
    /// The run whose energy and depth are believed.
    pub(super) run: Run,
    /// The same of the depth, m.
    pub(super) depth_doubt: f64,
    /// First contact, passages and turning points.
    pub(super) moments: Vec<KnownEvent>,
    /// What is looked for in other runs.
    pub(super) sought: EventThresholds,
    /// Whether a force could jump in one of the runs.
    pub(super) jumps: bool,
    /// What the two families are, in words.
    pub(super) how: String,
}

/// A moment of the truth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct KnownEvent {
    /// The time, s; NaN where it does not happen, or is not known.
    pub(super) at: f64,
    /// How far that may be off, s.
    pub(super) doubt: f64,
    /// Whether a turning point is a maximum.
    pub(super) top: bool,
}

/// How many times their difference a number may be off: both may be off to the same side, as what rounding does to the scene's own
/// numbers moves both.
const SAME_SIDE: f64 = 2.0;
/// Steps that the second family may take at most.
pub(super) const MOST_STEPS: usize = 2_000_000;
/// A moment that may be off by this part of the run is not known.
pub(super) const UNKNOWN: f64 = 0.02;

pub(super) fn method(id: i32) -> Integrator {
    INTEGRATORS.into_iter().find(|i| i.id == id).unwrap_or(INTEGRATORS[0])
}

/// A run that came to its end.
pub(super) fn run(
    case: &PrecisionCase<'_>,
    id: i32,
    timestep: f64,
    ask: RunRequest<'_>,
) -> Result<Option<Run>, RunError> {
    let seen = case.run(&Setting { integrator: method(id), timestep, solver: None }, ask)?;
    Ok(matches!(seen.status, RunStatus::Good | RunStatus::Warned).then_some(seen))
}

pub(super) fn too_long(case: &PrecisionCase<'_>, timestep: f64) -> bool {
    case.count as f64 * (case.interval / timestep) > MOST_STEPS as f64
}

/// The moments of two runs, as far as they agree. A passage is as uncertain as the number that passes, too, and all times are as
/// uncertain as a sum of so many steps.
pub(super) fn agreed(
    case: &PrecisionCase<'_>,
    uncertain: &[Vec<f64>],
    [a, b]: [&[EventTime]; 2],
    steps: f64,
) -> Vec<KnownEvent> {
    let n = case.targets.len();
    let one = |(i, (a, b)): (usize, (&EventTime, &EventTime))| {
        let target = (1..=n).contains(&i).then(|| uncertain.get(i - 1)).flatten();
        let sample = (a.at / case.interval).ceil() as usize;
        let value = target.and_then(|list| list.get(sample.min(list.len().saturating_sub(1))));
        let moved = value.map_or(0.0, |u| u / a.slope.min(b.slope).max(f64::MIN_POSITIVE));
        // What moves a turning point is seen in the difference alone.
        let apart = if i > n { 4.0 } else { 2.0 } * (a.at - b.at).abs();
        let rounding = f64::EPSILON * (8.0 + steps.sqrt()) * a.at;
        let doubt = apart + a.doubt + b.doubt + moved + rounding;
        // A difference that is no number is no moment either.
        match doubt <= UNKNOWN * case.length() && a.top == b.top {
            true => KnownEvent { at: a.at, doubt, top: a.top },
            false => KnownEvent { at: f64::NAN, doubt: f64::NAN, top: false },
        }
    };
    a.iter().zip(b).enumerate().map(one).collect()
}

/// How far one of two lists may be off, by their largest difference so far; infinite from where one is no number.
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

/// The largest difference of the two families, as a part of the range of what it is about.
pub(super) fn worst_part(values: &[Vec<f64>], uncertain: &[Vec<f64>]) -> f64 {
    let of = |(values, uncertain): (&Vec<f64>, &Vec<f64>)| {
        uncertain.last().copied().unwrap_or(0.0) / range(values).max(f64::MIN_POSITIVE)
    };
    values.iter().zip(uncertain).map(of).fold(0.0, f64::max)
}

/// Whether two families agree to a part of the range, or to rounding.
pub(super) fn agree(values: &[Vec<f64>], uncertain: &[Vec<f64>], part: f64) -> bool {
    values.iter().zip(uncertain).all(|(values, uncertain)| {
        let size = values.iter().fold(0.0f64, |a, x| a.max(x.abs()));
        uncertain.last().is_none_or(|u| *u <= part * range(values) || *u <= 1e-12 * size)
    })
}
