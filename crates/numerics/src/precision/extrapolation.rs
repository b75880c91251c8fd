//! The reference of a lab with a controller. Its controls are constant during a step, so the results have an expansion in
//! powers of the timestep. A table of runs with halved timesteps is extrapolated to a timestep of zero (Aitken and Neville;
//! Hairer, Nørsett and Wanner 1993, *Solving Ordinary Differential Equations I*, section II.9). Steps in which controls
//! jump are split at the jump.

use super::agreement::{
    ReferenceSolution, agree, agreed, largest_relative_difference, run, so_far, too_long,
};
use super::case::PrecisionCase;
use super::event_finder::EventThresholds;
use super::event_time::EventTime;
use super::numbers::milliseconds;
use super::run_record::{RecordRequest, SampledRun};
use labspec::run::RunError;
use labspec_core::integrator;

/// The number of timesteps, each half of the previous one.
const LEVELS: usize = 8;
/// The part of its range by which two entries may differ. A further level costs little and improves the result considerably.
const MAX_DIFFERENCE: f64 = 1e-11;

/// An entry of the extrapolation table.
#[derive(Clone)]
struct TableEntry {
    values: Vec<Vec<f64>>,
    moments: Vec<f64>,
}

impl TableEntry {
    fn from_run(run: &SampledRun) -> TableEntry {
        TableEntry { values: run.values.clone(), moments: run.moments.iter().map(|m| m.time).collect() }
    }

    /// Extrapolates this entry and the one with twice the step, if the lowest power of the error is `power`.
    fn extrapolate(&self, coarse: &TableEntry, power: i32) -> TableEntry {
        let weight = 1.0 / (2f64.powi(power) - 1.0);
        let list = |(fine, coarse): (&Vec<f64>, &Vec<f64>)| {
            fine.iter().zip(coarse).map(|(f, c)| f + (f - c) * weight).collect()
        };
        TableEntry {
            values: self.values.iter().zip(&coarse.values).map(list).collect(),
            moments: list((&self.moments, &coarse.moments)),
        }
    }
}

/// The best entry so far, with the one of twice its step in the same column.
struct BestEntry {
    entry: TableEntry,
    coarse: TableEntry,
    uncertain: Vec<Vec<f64>>,
    run: SampledRun,
    step: f64,
}

impl BestEntry {
    fn worst(&self) -> f64 {
        largest_relative_difference(&self.entry.values, &self.uncertain)
    }
}

/// Computes the reference of a lab with a controller.
pub(super) fn extrapolated(
    case: &PrecisionCase<'_>,
    timestep: f64,
) -> Result<Option<ReferenceSolution>, RunError> {
    let first = (timestep / 2.0).min(case.interval);
    let ask = RecordRequest { cut: true, ..RecordRequest::REFERENCE_REQUEST };
    let Some(look) = run(case, integrator::RKMK8, first, ask)? else { return Ok(None) };
    let sought = EventThresholds::for_values(&look.values);
    let ask = RecordRequest { sought: Some(&sought), ..ask };
    let mut before: Vec<TableEntry> = Vec::new();
    let mut best: Option<BestEntry> = None;
    let mut step = first;
    for _ in 0..LEVELS {
        if too_long(case, step) {
            break;
        }
        let Some(current) = run(case, integrator::RKMK8, step, ask)? else { break };
        let row = next_row(&current, &before);
        for (entry, coarse) in row.iter().zip(&before) {
            let uncertain = so_far(entry.values.iter().zip(&coarse.values));
            let (entry, coarse) = (entry.clone(), coarse.clone());
            let one = BestEntry { entry, coarse, uncertain, run: current.clone(), step };
            if best.as_ref().is_none_or(|b| one.worst() < b.worst()) {
                best = Some(one);
            }
        }
        if best.as_ref().is_some_and(|b| agree(&b.entry.values, &b.uncertain, MAX_DIFFERENCE)) {
            break;
        }
        before = row;
        step /= 2.0;
    }
    let Some(best) = best else { return Ok(None) };
    finish(case, best, sought.clone(), first).map(Some)
}

/// The next row of the table, from the row with twice the step.
fn next_row(run: &SampledRun, before: &[TableEntry]) -> Vec<TableEntry> {
    let mut row = vec![TableEntry::from_run(run)];
    for (coarse, power) in before.iter().zip(1..) {
        let Some(last) = row.last() else { break };
        let next = last.extrapolate(coarse, power);
        row.push(next);
    }
    row
}

/// Compares the integration between controls with that of another family of methods, and builds the reference.
fn finish(
    case: &PrecisionCase<'_>,
    best: BestEntry,
    sought: EventThresholds,
    first: f64,
) -> Result<ReferenceSolution, RunError> {
    let BestEntry { entry, coarse, mut uncertain, run: mut seen, step } = best;
    let ask = RecordRequest { cut: true, ..RecordRequest::REFERENCE_REQUEST };
    let other = if too_long(case, step) { None } else { run(case, integrator::GAUSS, step, ask)? };
    if let Some(other) = &other {
        let more = so_far(seen.values.iter().zip(&other.values));
        for (list, more) in uncertain.iter_mut().zip(&more) {
            list.iter_mut().zip(more).for_each(|(u, m)| *u += m);
        }
    }
    let depth_doubt = other.as_ref().map_or(f64::NAN, |o| (o.penetration - seen.penetration).abs());
    let event_times = |moments: &[f64], uncertainties: bool| -> Vec<EventTime> {
        let one = |(m, time): (&EventTime, &f64)| EventTime {
            time: *time,
            uncertainty: if uncertainties { m.uncertainty } else { 0.0 },
            ..*m
        };
        seen.moments.iter().zip(moments).map(one).collect()
    };
    let (fine, rough) = (event_times(&entry.moments, true), event_times(&coarse.moments, false));
    let moments = agreed(case, &uncertain, [&fine, &rough], case.length() / step);
    let how = format!(
        "rkmk8{} with the controller at steps from {} to {} ms, extrapolated to none",
        if other.is_some() { " (and gauss)" } else { "" },
        milliseconds(first),
        milliseconds(step)
    );
    let jumps = seen.jumps;
    seen.values.clone_from(&entry.values);
    let values = entry.values;
    Ok(ReferenceSolution { values, uncertain, run: seen, depth_doubt, moments, sought, jumps, how })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_polynomial_of_the_step_is_extrapolated_to_its_constant() {
        let run = |h: f64| SampledRun {
            values: vec![vec![1.0 + 3.0 * h - 2.0 * h * h + h.powi(3)]],
            ..SampledRun::default()
        };
        let mut row = Vec::new();
        for k in 0..4 {
            row = next_row(&run(0.5f64.powi(k)), &row);
        }
        assert!((row[3].values[0][0] - 1.0).abs() < 1e-14);
    }
}
