//! What runs are held against: the closed form, else two families of methods that owe each other nothing, as far as they agree.
//!
//! The first is extrapolation of the midpoint rule, which chooses its own steps; the second a Runge–Kutta method of eighth order
//! with ever shorter ones. Where a program computes controls at every step, which are held until the next, the runs approach the
//! continuous controller with the powers of the step: a table of ever shorter steps is extrapolated to a step of nothing
//! (`extrapolation.rs`).

use super::case::{Ask, Fate, PrecisionCase, Run};
use super::extrapolation::extrapolated;
use super::moments::{Moment, Sought};
use super::setting::{INTEGRATORS, Integrator, Setting};
use crate::run::RunError;
use labspec_core::integrator;

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
    pub(super) moments: Vec<Known>,
    /// What is looked for in other runs.
    pub(super) sought: Sought,
    /// Whether a force could jump in one of the runs.
    pub(super) jumps: bool,
    /// What the two families are, in words.
    pub(super) how: String,
}

/// A moment of the truth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Known {
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
/// Part of its range by which the two families may differ.
const AGREE: f64 = 1e-9;
/// Steps that the second family may take at most.
pub(super) const MOST_STEPS: usize = 2_000_000;
/// Steps of the second family that are tried, each a quarter of the one before.
const TRIES: usize = 5;
/// A moment that may be off by this part of the run is not known.
const UNKNOWN: f64 = 0.02;

pub(super) fn method(id: i32) -> Integrator {
    INTEGRATORS.into_iter().find(|i| i.id == id).unwrap_or(INTEGRATORS[0])
}

/// The reference; `None` when no method comes through the lab, or none within the work
/// that a run may do.
///
/// # Errors
/// A control that cannot be set so.
pub(super) fn reference(case: &PrecisionCase<'_>, own: f64) -> Result<Option<Reference>, RunError> {
    if case.controlled() { extrapolated(case, own) } else { direct(case, own) }
}

/// A run that came to its end.
pub(super) fn run(
    case: &PrecisionCase<'_>,
    id: i32,
    timestep: f64,
    ask: Ask<'_>,
) -> Result<Option<Run>, RunError> {
    let seen = case.run(&Setting { integrator: method(id), timestep, solver: None }, ask)?;
    Ok(matches!(seen.fate, Fate::Good | Fate::Warned).then_some(seen))
}

pub(super) fn too_long(case: &PrecisionCase<'_>, timestep: f64) -> bool {
    case.count as f64 * (case.interval / timestep) > MOST_STEPS as f64
}

/// A method and a step.
type Way = (i32, f64);

/// Two runs beside each other.
struct Pair {
    reference: Reference,
    ways: [Way; 2],
}

fn direct(case: &PrecisionCase<'_>, own: f64) -> Result<Option<Reference>, RunError> {
    let mut first = None;
    for way in [(integrator::ADAPTIVE, case.interval), (integrator::GAUSS, own / 16.0)] {
        if first.is_none() && !too_long(case, way.1) {
            first = run(case, way.0, way.1, Ask::FRESH)?.map(|run| (way, run));
        }
    }
    let mut best: Option<Pair> = None;
    let mut step = own.min(case.interval);
    for _ in 0..TRIES {
        if too_long(case, step) {
            break;
        }
        let Some(second) = run(case, integrator::RKMK8, step, Ask::FRESH)? else {
            // A step that is too long for it may only be too long.
            if best.is_some() {
                break;
            }
            step /= 4.0;
            continue;
        };
        let mine = (integrator::RKMK8, step);
        let now = match &first {
            Some((way, seen)) => {
                let how = format!("{} and {}", in_words(*way), in_words(mine));
                Pair { reference: compare(seen.clone(), &second, how), ways: [*way, mine] }
            }
            // One family alone: a run of half the step judges it.
            None => {
                let half = (integrator::RKMK8, step / 2.0);
                let Some(finer) = run(case, half.0, half.1, Ask::FRESH)? else { break };
                let how = format!("{}, and at twice that", in_words(half));
                Pair { reference: compare(finer, &second, how), ways: [half, mine] }
            }
        };
        let agreed = agrees(&now.reference);
        if best.as_ref().is_none_or(|b| worst(&now.reference) < worst(&b.reference)) {
            best = Some(now);
        }
        if agreed {
            break;
        }
        step /= 4.0;
    }
    let Some(mut best) = best else { return Ok(None) };
    find_moments(case, &mut best)?;
    Ok(Some(best.reference))
}

fn in_words((id, timestep): Way) -> String {
    format!("{} at {} ms", method(id).name, super::milliseconds(timestep))
}

/// Runs both once more, for what happens in them.
fn find_moments(case: &PrecisionCase<'_>, pair: &mut Pair) -> Result<(), RunError> {
    let r = &mut pair.reference;
    let mut found: Vec<Run> = Vec::new();
    for (id, timestep) in pair.ways {
        // The other one finds the same, or nothing.
        let late = |run: &Run| run.settled + UNKNOWN * case.length() + 8.0 * timestep;
        let stop = found.first().map_or(f64::INFINITY, late);
        let ask = Ask { sought: Some(&r.sought), stop: Some(stop), ..Ask::FRESH };
        let setting = Setting { integrator: method(id), timestep, solver: None };
        found.push(case.run(&setting, ask)?);
    }
    if let [a, b] = found.as_slice() {
        r.run.touching = a.touching;
        let steps = case.length() / pair.ways[0].1.min(pair.ways[1].1);
        r.moments = known(case, &r.uncertain, [&a.moments, &b.moments], steps);
    }
    Ok(())
}

/// The moments of two runs, as far as they agree. A passage is as uncertain as the number that passes, too, and all times are as
/// uncertain as a sum of so many steps.
pub(super) fn known(
    case: &PrecisionCase<'_>,
    uncertain: &[Vec<f64>],
    [a, b]: [&[Moment]; 2],
    steps: f64,
) -> Vec<Known> {
    let n = case.targets.len();
    let one = |(i, (a, b)): (usize, (&Moment, &Moment))| {
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
            true => Known { at: a.at, doubt, top: a.top },
            false => Known { at: f64::NAN, doubt: f64::NAN, top: false },
        }
    };
    a.iter().zip(b).enumerate().map(one).collect()
}

/// The first as far as the second agrees.
fn compare(mut first: Run, second: &Run, how: String) -> Reference {
    let uncertain = so_far(first.values.iter().zip(&second.values));
    let depth_doubt = (first.penetration - second.penetration).abs();
    let jumps = first.jumps || second.jumps;
    first.penetration = second.penetration;
    let values = first.values.clone();
    let sought = Sought::of(&values);
    Reference { values, uncertain, run: first, depth_doubt, moments: Vec::new(), sought, jumps, how }
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

fn worst(r: &Reference) -> f64 {
    worst_part(&r.values, &r.uncertain)
}

/// Whether two families agree to a part of the range, or to rounding.
pub(super) fn agree(values: &[Vec<f64>], uncertain: &[Vec<f64>], part: f64) -> bool {
    values.iter().zip(uncertain).all(|(values, uncertain)| {
        let size = values.iter().fold(0.0f64, |a, x| a.max(x.abs()));
        uncertain.last().is_none_or(|u| *u <= part * range(values) || *u <= 1e-12 * size)
    })
}

fn agrees(r: &Reference) -> bool {
    agree(&r.values, &r.uncertain, AGREE)
}

/// Largest less smallest.
pub(super) fn range(values: &[f64]) -> f64 {
    let (low, high) =
        values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(*x), high.max(*x)));
    if high >= low { high - low } else { 0.0 }
}
