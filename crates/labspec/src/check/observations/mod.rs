//! What a student sees in the runs of a lab, and what only seems to show something: curves that cannot change, readouts that print
//! one text, controls that do nothing. Each is told with the runs that show it; what is not certain is not told.

mod again;
mod at_rest;
mod begins;
mod below_zero;
mod bench;
mod curves;
mod damping;
mod early;
mod error;
mod flat;
mod idle;
mod jumps;
mod mixed;
mod never;
mod no_solver;
mod overruled;
mod readouts;
mod record;
mod saturated;
mod stale;
mod start;
mod undone;

pub(super) use record::{Mark, Record};
pub(super) use saturated::Beyond;

use super::PreparedLab;
use crate::finding::Finding;
use crate::run::Cell;
use bench::ObservationBench;

/// Work for the runs that make sure, for each lab.
const WORK: u64 = 600_000_000;

/// A lab that was observed at.
struct ObservedLab<'a> {
    /// As it stands, then with each control at its ends.
    records: &'a [Record],
    bench: ObservationBench<'a>,
    /// What is shown from other states, once it was asked for.
    perturbed: Option<Vec<Vec<Cell>>>,
    /// How long each run was, s.
    length: f64,
    /// Controls of which something was told that says it all.
    reported: Vec<usize>,
}

impl ObservedLab<'_> {
    fn perturbed_rows(&mut self) -> &[Vec<Cell>] {
        let bench = &mut self.bench;
        self.perturbed.get_or_insert_with(|| bench.perturbed_run())
    }

    /// The runs in words.
    fn runs(&self) -> String {
        match self.records.len() {
            1 => "the run".into(),
            n => format!("{n} runs, with every control moved"),
        }
    }
}

/// Looks at a lab whose runs all came to their end.
pub(super) fn check_observations(
    ready: &PreparedLab<'_>,
    records: &[Record],
    length: f64,
    findings: &mut Vec<Finding>,
) {
    let bench = ObservationBench { ready, programs: &ready.programs, left: WORK, runs: 0 };
    let mut observed = ObservedLab { records, bench, perturbed: None, length, reported: Vec::new() };
    start::check_start(&observed, findings);
    at_rest::check_at_rest(&observed, findings);
    saturated::check_saturation(&observed, findings);
    jumps::check_jumps(&observed, findings);
    mixed::check_mixed_dimensions(&observed, findings);
    stale::check_stale_reads(&mut observed, findings);
    early::check_early_stop(&mut observed, findings);
    never::check_stop_reached(&observed, findings);
    error::check_error_readouts(&mut observed, findings);
    curves::check_curves(&mut observed, findings);
    readouts::check_readouts(&observed, findings);
    begins::check_beginning(&observed, findings);
    again::check_repeats(&observed, findings);
    below_zero::check_below_zero(&observed, findings);
    damping::check_damping(&observed, findings);
    no_solver::check_solver(&observed, findings);
    undone::check_undone_writes(&mut observed, findings);
    overruled::check_overruled_controls(&mut observed, findings);
    flat::check_flat_curves(&mut observed, findings);
    idle::check_idle_controls(&mut observed, findings);
}
