//! The events of the reference, the timing errors of other runs, and how long runs with nearby starts stay together.

use super::agreement::{KnownEvent, ReferenceSolution, method};
use super::case::PrecisionCase;
use super::judge::Compared;
use super::run_record::{RecordRequest, SampledRun};
use super::setting::Setting;
use labspec::run::RunError;
use labspec_core::integrator;
use schemars::JsonSchema;
use serde::Serialize;

/// The distance of nearby starts, and the part of its range by which a number counts as different.
const PERTURBATION: f64 = 1e-9;
const LEFT: f64 = 0.01;

/// An event of the reference.
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    /// The event in words.
    pub name: String,
    /// The time, s.
    pub time: f64,
    /// The uncertainty of the time, s.
    pub uncertain: f64,
}

/// How long two starts that nobody could tell apart show the same.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct NearbyStarts {
    /// How far apart the starts are.
    ///
    /// In the unit of each coordinate.
    #[serde(rename = "apart")]
    pub distance: f64,
    /// Until when they show the same, in seconds; null where they do to the end.
    ///
    /// The same: all numbers agree within a hundredth of their ranges.
    pub until: Option<f64>,
}

/// The events of the reference before its horizon.
pub(super) fn events(
    case: &PrecisionCase<'_>,
    truth: &ReferenceSolution,
    targets: &[Compared],
) -> Vec<Event> {
    let n = case.targets.len();
    let all = targets.iter().filter_map(|t| t.until).reduce(f64::min);
    let contact = if truth.run.touching { "first new contact" } else { "first contact" };
    let event = |(i, exact_event): (usize, &KnownEvent)| {
        let target = i.checked_sub(1).and_then(|k| targets.get(k % n.max(1)));
        let name = match target {
            None => contact.to_string(),
            Some(t) if i <= n => format!("\"{}\" passes through zero", t.label),
            Some(t) => {
                let which = if exact_event.top { "maximum" } else { "minimum" };
                format!("first {which} of \"{}\"", t.label)
            }
        };
        // A number that is both plotted and displayed with digits has its events only once.
        let text = |k: usize| case.targets.get(k).map(|t| t.bound.text.value.as_str());
        let again =
            i.checked_sub(1).map(|k| k % n.max(1)).is_some_and(|k| (0..k).any(|j| text(j) == text(k)));
        let horizon = target.map_or(all, |t| if t.blank { Some(0.0) } else { t.until });
        match !again && horizon.is_none_or(|until| exact_event.time + exact_event.uncertainty <= until) {
            true => Event { name, time: exact_event.time, uncertain: exact_event.uncertainty },
            false => Event { name, time: f64::NAN, uncertain: f64::NAN },
        }
    };
    truth.moments.iter().enumerate().map(event).collect()
}

/// The timing errors of a run's events, s; never smaller than the uncertainty of the event.
pub(super) fn timing_errors(run: &SampledRun, events: &[Event]) -> Vec<f64> {
    let off = |(i, event): (usize, &Event)| {
        let found = run.moments.get(i).map_or(f64::NAN, |m| m.time);
        let off = (found - event.time).abs();
        if off.is_nan() { f64::NAN } else { off.max(event.uncertain) }
    };
    events.iter().enumerate().map(off).collect()
}

/// Determines how long two runs with indistinguishable starts agree.
pub(super) fn nearby(
    case: &PrecisionCase<'_>,
    targets: &[Compared],
    timestep: f64,
) -> Result<NearbyStarts, RunError> {
    let setting = Setting { integrator: method(integrator::RKMK8), timestep: timestep / 2.0, solver: None };
    let (one, other) = (
        case.run(&setting, RecordRequest::REFERENCE_REQUEST)?,
        case.run(&setting, RecordRequest { perturbation: PERTURBATION, ..RecordRequest::REFERENCE_REQUEST })?,
    );
    let leaves = |((a, b), target): ((&Vec<f64>, &Vec<f64>), &Compared)| {
        let far = LEFT * target.range;
        // Equal means a smaller difference than `far`; NaN always counts as different.
        a.iter().zip(b).position(|(a, b)| (a - b).abs() > far || (a - b).is_nan())
    };
    let first = one.values.iter().zip(&other.values).zip(targets).filter_map(leaves).min();
    let interval = case.sampling_plan(setting.timestep).stride as f64 * case.interval;
    Ok(NearbyStarts { distance: PERTURBATION, until: first.map(|i| i as f64 * interval) })
}
