//! Observations in the runs of a lab: displays without information, such as curves that cannot change, readouts with one
//! text, and controls without effect. Each finding names the runs that show it. Uncertain observations are not reported.

mod bench;
mod moves;
mod no_solver;
mod record;

pub(crate) use bench::{ObservationBench, ObservedLab};
pub(crate) use moves::{Move, Setting, settings, single_moves, values};
pub(crate) use record::{InputsOutOfRange, ObservationHash, Record, column, constant, longest_equal, same};

use super::PreparedLab;
use crate::finding::Finding;
use crate::rules;

/// Checks a lab whose runs were all completed.
pub(super) fn check_observations(
    ready: &PreparedLab<'_>,
    records: &[Record],
    length: f64,
    findings: &mut Vec<Finding>,
) {
    let mut observed = ObservedLab::new(ready, records, length);
    rules::starts_inside::check_start(&observed, findings);
    rules::not_at_rest::check_at_rest(&observed, findings);
    rules::always_saturated::check_saturation(&observed, findings);
    rules::setconst_jumps::check_jumps(&observed, findings);
    rules::mixed_away::check_contact_mixing(&observed, findings);
    rules::stale_read::check_stale_reads(&mut observed, findings);
    rules::stops_early::check_early_stop(&mut observed, findings);
    rules::stop_unreached::check_stop_reached(&observed, findings);
    rules::too_many_digits::check_surplus_digits(&mut observed, findings);
    check_curves(&mut observed, findings);
    check_readouts(&observed, findings);
    rules::energy_value::check_energies(&mut observed, findings);
    rules::shows_the_start::check_beginning(&observed, findings);
    rules::goes_on::check_repeats(&observed, findings);
    rules::below_zero::check_below_zero(&observed, findings);
    rules::damping_below_zero::check_damping(&observed, findings);
    no_solver::check_solver(&observed, findings);
    rules::undone_by_reset::check_undone_writes(&mut observed, findings);
    rules::overruled::check_overruled_controls(&mut observed, findings);
    rules::idle_range::check_flat_ranges(&mut observed, findings);
    rules::idle_control::check_idle_controls(&mut observed, findings);
}

/// Each curve has at most one finding: that it never changes, else that it equals another one, else that its plot does not
/// show it.
fn check_curves(observed: &mut ObservedLab<'_>, findings: &mut Vec<Finding>) {
    let mut first = 1;
    for plot in &observed.bench.ready.lab.plots {
        let columns = first..first + plot.traces.len();
        first = columns.end;
        let still: Vec<bool> =
            columns.clone().map(|c| constant(column(observed.records, c)).is_some()).collect();
        let others = still.iter().any(|s| !s);
        for ((c, trace), still) in columns.clone().zip(&plot.traces).zip(still) {
            let finding = if still {
                rules::constant_trace::check_still_trace(observed, c, trace, others)
            } else {
                rules::same_curve::check_moving_trace(observed, columns.start..c, c, plot)
            };
            findings
                .extend(finding.or_else(|| rules::outside_plot::check_trace_range(observed, plot, c, trace)));
        }
    }
}

/// Checks the readouts.
fn check_readouts(observed: &ObservedLab<'_>, findings: &mut Vec<Finding>) {
    let lab = observed.bench.ready.lab;
    for (readout, c) in lab.readouts.iter().zip(1 + lab.traces().count()..) {
        findings.extend(rules::label_unit::check_text_readout(observed, readout, c));
        findings.extend(rules::too_few_digits::check_readout(observed, readout, c));
        findings.extend(rules::constant_readout::check_still_readout(observed, readout, c));
    }
}
