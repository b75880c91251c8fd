//! The truth for the comparison: the closed form, otherwise two independent families of methods, as far as they agree.
//!
//! The first family is the extrapolated midpoint rule, which chooses its own steps; the second is a Runge–Kutta method of order
//! eight with decreasing timesteps. If a program computes controls that are constant during each step, the runs converge to the
//! continuous controller with powers of the timestep: a table of runs with decreasing timesteps is extrapolated to a timestep
//! of zero (`extrapolation.rs`).

use super::agreement::{
    ReferenceSolution, UNKNOWN, agree, agreed, largest_relative_difference, method, run, so_far, too_long,
};
use super::case::PrecisionCase;
use super::event_finder::EventThresholds;
use super::extrapolation::extrapolated;
use super::numbers::milliseconds;
use super::run_record::{RecordRequest, SampledRun};
use super::setting::Setting;
use labspec::run::RunError;
use labspec_core::integrator;

/// The part of its range by which the two families may differ.
const MAX_DIFFERENCE: f64 = 1e-9;
/// The number of timesteps of the second family, each a quarter of the previous one.
const MAX_REFINEMENTS: usize = 5;
/// Returns the reference, or `None` if no method can simulate the lab within the work limit of a run.
///
/// # Errors
/// A control cannot be set to its value.
pub(super) fn reference(
    case: &PrecisionCase<'_>,
    timestep: f64,
) -> Result<Option<ReferenceSolution>, RunError> {
    if case.controlled() { extrapolated(case, timestep) } else { direct(case, timestep) }
}

/// An integrator id and a timestep.
type MethodStep = (i32, f64);

/// Two runs that agree.
struct AgreeingRuns {
    reference: ReferenceSolution,
    methods: [MethodStep; 2],
}

fn direct(case: &PrecisionCase<'_>, timestep: f64) -> Result<Option<ReferenceSolution>, RunError> {
    let mut first = None;
    for method_step in [(integrator::ADAPTIVE, case.interval), (integrator::GAUSS, timestep / 16.0)] {
        if first.is_none() && !too_long(case, method_step.1) {
            first = run(case, method_step.0, method_step.1, RecordRequest::REFERENCE_REQUEST)?
                .map(|run| (method_step, run));
        }
    }
    let mut best: Option<AgreeingRuns> = None;
    let mut step = timestep.min(case.interval);
    for _ in 0..MAX_REFINEMENTS {
        if too_long(case, step) {
            break;
        }
        let Some(second) = run(case, integrator::RKMK8, step, RecordRequest::REFERENCE_REQUEST)? else {
            // The method may fail only because the step is too long.
            if best.is_some() {
                break;
            }
            step /= 4.0;
            continue;
        };
        let method = (integrator::RKMK8, step);
        let current = match &first {
            Some((method_step, seen)) => {
                let how = format!("{} and {}", in_words(*method_step), in_words(method));
                AgreeingRuns {
                    reference: compare(seen.clone(), &second, how),
                    methods: [*method_step, method],
                }
            }
            // Only one family succeeds: a run with half the step serves for comparison.
            None => {
                let half = (integrator::RKMK8, step / 2.0);
                let Some(finer) = run(case, half.0, half.1, RecordRequest::REFERENCE_REQUEST)? else { break };
                let how = format!("{}, and at twice that", in_words(half));
                AgreeingRuns { reference: compare(finer, &second, how), methods: [half, method] }
            }
        };
        let agreed = agrees(&current.reference);
        if best.as_ref().is_none_or(|b| worst(&current.reference) < worst(&b.reference)) {
            best = Some(current);
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

fn in_words((id, timestep): MethodStep) -> String {
    format!("{} at {} ms", method(id).name, milliseconds(timestep))
}

/// Repeats both runs to find their events.
fn find_moments(case: &PrecisionCase<'_>, pair: &mut AgreeingRuns) -> Result<(), RunError> {
    let r = &mut pair.reference;
    let mut found: Vec<SampledRun> = Vec::new();
    for (id, timestep) in pair.methods {
        // The other run finds the same events by then, or none.
        let late = |run: &SampledRun| run.settled + UNKNOWN * case.length() + 8.0 * timestep;
        let stop = found.first().map_or(f64::INFINITY, late);
        let ask =
            RecordRequest { sought: Some(&r.sought), stop: Some(stop), ..RecordRequest::REFERENCE_REQUEST };
        let setting = Setting { integrator: method(id), timestep, solver: None };
        found.push(case.run(&setting, ask)?);
    }
    if let [a, b] = found.as_slice() {
        r.run.touching = a.touching;
        let steps = case.length() / pair.methods[0].1.min(pair.methods[1].1);
        r.moments = agreed(case, &r.uncertain, [&a.moments, &b.moments], steps);
    }
    Ok(())
}

/// The reference from the first run, with the uncertainty given by the second.
fn compare(mut first: SampledRun, second: &SampledRun, how: String) -> ReferenceSolution {
    let uncertain = so_far(first.values.iter().zip(&second.values));
    let depth_doubt = (first.penetration - second.penetration).abs();
    let jumps = first.jumps || second.jumps;
    first.penetration = second.penetration;
    let values = first.values.clone();
    let sought = EventThresholds::for_values(&values);
    ReferenceSolution { values, uncertain, run: first, depth_doubt, moments: Vec::new(), sought, jumps, how }
}

fn worst(r: &ReferenceSolution) -> f64 {
    largest_relative_difference(&r.values, &r.uncertain)
}

fn agrees(r: &ReferenceSolution) -> bool {
    agree(&r.values, &r.uncertain, MAX_DIFFERENCE)
}
