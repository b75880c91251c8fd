//! What runs are held against: the closed form, else two families of methods that owe each other nothing, as far as they agree.
//!
//! The first is extrapolation of the midpoint rule, which chooses its own steps; the second a Runge–Kutta method of eighth order
//! with ever shorter ones. Where a program computes controls at every step, which are held until the next, both approach the
//! continuous controller with the first power of the step, and are extrapolated to a step of nothing.

use super::case::{Case, Fate, Run};
use super::setting::{INTEGRATORS, Integrator, Setting};
use crate::run::RunError;
use labspec_core::integrator;

/// The truth as far as it is known.
pub(super) struct Reference {
    /// Values of each target at the samples.
    pub(super) values: Vec<Vec<f64>>,
    /// How far each may be off: what the two families have differed by at most so far.
    pub(super) uncertain: Vec<Vec<f64>>,
    /// What they differ by at each sample.
    pub(super) apart: Vec<Vec<f64>>,
    /// The run whose events, energy and depth are believed, and how far each event may be off.
    pub(super) run: Run,
    pub(super) unsure_of_events: Vec<f64>,
    /// What the two families are, in words.
    pub(super) how: String,
}

/// Part of its range by which the two families may differ.
const AGREE: f64 = 1e-9;
/// Steps that the second family may take at most.
const MOST_STEPS: usize = 2_000_000;

fn method(id: i32) -> Integrator {
    INTEGRATORS.into_iter().find(|i| i.id == id).unwrap_or(INTEGRATORS[0])
}

/// The reference; `None` when no method comes through the lab, or none within the work
/// that a run may do.
///
/// # Errors
/// A control that cannot be set so.
pub(super) fn reference(case: &Case<'_>, own: f64) -> Result<Option<Reference>, RunError> {
    if case.controlled() { extrapolated(case, own) } else { direct(case, own) }
}

fn run(case: &Case<'_>, id: i32, timestep: f64) -> Result<Option<Run>, RunError> {
    let seen = case.run(&Setting { integrator: method(id), timestep, solver: None }, 0.0, true)?;
    Ok(matches!(seen.fate, Fate::Good | Fate::Warned).then_some(seen))
}

fn too_long(case: &Case<'_>, timestep: f64) -> bool {
    case.count as f64 * (case.interval / timestep) > MOST_STEPS as f64
}

/// Steps of the second family that are tried, each a quarter of the one before.
const TRIES: usize = 5;

fn direct(case: &Case<'_>, own: f64) -> Result<Option<Reference>, RunError> {
    let mut first = None;
    for (id, timestep) in [(integrator::ADAPTIVE, case.interval), (integrator::GAUSS, own / 16.0)] {
        if first.is_none() && !too_long(case, timestep) {
            first = run(case, id, timestep)?.map(|run| (id, timestep, run));
        }
    }
    let mut best: Option<Reference> = None;
    let mut step = own.min(case.interval);
    for _ in 0..TRIES {
        if too_long(case, step) {
            break;
        }
        let Some(second) = run(case, integrator::RKMK8, step)? else {
            // A step that is too long for it may only be too long.
            if best.is_some() {
                break;
            }
            step /= 4.0;
            continue;
        };
        let now = match &first {
            Some((id, timestep, seen)) => {
                let how = format!(
                    "{} at {} ms and rkmk8 at {} ms",
                    method(*id).name,
                    super::milliseconds(*timestep),
                    super::milliseconds(step)
                );
                compare(seen.clone(), &second, step, how)
            }
            // One family alone: a run of half the step judges it.
            None => {
                let Some(finer) = run(case, integrator::RKMK8, step / 2.0)? else { break };
                let how = format!("rkmk8 at {} ms, and at twice that", super::milliseconds(step / 2.0));
                compare(finer, &second, step, how)
            }
        };
        if better(&mut best, now) {
            break;
        }
        step /= 4.0;
    }
    Ok(best)
}

/// With a controller: two steps of each family, extrapolated.
fn extrapolated(case: &Case<'_>, own: f64) -> Result<Option<Reference>, RunError> {
    let mut best: Option<Reference> = None;
    let mut step = (own / 2.0).min(case.interval);
    for _ in 0..4 {
        if too_long(case, step / 4.0) {
            break;
        }
        let ids = [integrator::RKMK4, integrator::RKMK8];
        let [coarse, middle, fine] = [step, step / 2.0, step / 4.0];
        let (Some(a), Some(b), Some(c), Some(d)) = (
            run(case, ids[0], coarse)?,
            run(case, ids[0], middle)?,
            run(case, ids[1], middle)?,
            run(case, ids[1], fine)?,
        ) else {
            break;
        };
        let how = format!(
            "rkmk4 and rkmk8 with the controller at steps down to {} ms, extrapolated",
            super::milliseconds(fine)
        );
        let now = compare(toward(&d, &c), &toward(&b, &a), coarse, how);
        if better(&mut best, now) {
            break;
        }
        step /= 4.0;
    }
    Ok(best)
}

/// Keeps the better of two; whether the new one agrees with itself as far as can be asked for.
fn better(best: &mut Option<Reference>, now: Reference) -> bool {
    let agreed = agrees(&now);
    if best.as_ref().is_none_or(|b| worst(&now) < worst(b)) {
        *best = Some(now);
    }
    agreed
}

/// What two runs come to with a step of nothing, where the error is in proportion to the step.
fn toward(fine: &Run, coarse: &Run) -> Run {
    let mut run = fine.clone();
    for (fine, coarse) in run.values.iter_mut().zip(&coarse.values) {
        fine.iter_mut().zip(coarse).for_each(|(f, c)| *f = 2.0 * *f - c);
    }
    run
}

/// The first as far as the second, with steps of some length, agrees. Events are those of the shorter steps: they are found
/// between the steps, to a fraction of one.
fn compare(mut first: Run, second: &Run, step: f64, how: String) -> Reference {
    let differ = |a: &f64, b: &f64| if (a - b).is_nan() { f64::INFINITY } else { (a - b).abs() };
    let each = |(a, b): (&Vec<f64>, &Vec<f64>)| a.iter().zip(b).map(|(a, b)| differ(a, b)).collect();
    let apart: Vec<Vec<f64>> = first.values.iter().zip(&second.values).map(each).collect();
    let so_far = |worst: &mut f64, d: &f64| {
        *worst = worst.max(*d);
        Some(*worst)
    };
    let uncertain = apart.iter().map(|list| list.iter().scan(0.0, so_far).collect()).collect();
    let unsure = |(a, b): (&f64, &f64)| (a - b).abs().min(step);
    let unsure_of_events = first.events.iter().zip(&second.events).map(unsure).collect();
    first.events.clone_from(&second.events);
    first.penetration = second.penetration;
    Reference { values: first.values.clone(), uncertain, apart, run: first, unsure_of_events, how }
}

/// The largest difference of the two families, as a part of the range of what it is about.
fn worst(r: &Reference) -> f64 {
    let of = |(values, uncertain): (&Vec<f64>, &Vec<f64>)| {
        uncertain.last().copied().unwrap_or(0.0) / range(values).max(f64::MIN_POSITIVE)
    };
    r.values.iter().zip(&r.uncertain).map(of).fold(0.0, f64::max)
}

fn agrees(r: &Reference) -> bool {
    r.values.iter().zip(&r.uncertain).all(|(values, uncertain)| {
        let size = values.iter().fold(0.0f64, |a, x| a.max(x.abs()));
        uncertain.last().is_none_or(|u| *u <= AGREE * range(values) || *u <= 1e-12 * size)
    })
}

/// Largest less smallest.
pub(super) fn range(values: &[f64]) -> f64 {
    let (low, high) =
        values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(*x), high.max(*x)));
    if high >= low { high - low } else { 0.0 }
}
