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

use super::Ready;
use crate::finding::Finding;
use crate::run::Cell;
use bench::Bench;

/// Work for the runs that make sure, for each lab.
const WORK: u64 = 600_000_000;

/// A lab that was looked at.
struct Looked<'a> {
    /// As it stands, then with each control at its ends.
    records: &'a [Record],
    bench: Bench<'a>,
    /// What is shown from other states, once it was asked for.
    perturbed: Option<Vec<Vec<Cell>>>,
    /// How long each run was, s.
    length: f64,
    /// Controls of which something was told that says it all.
    reported: Vec<usize>,
}

impl Looked<'_> {
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
pub(super) fn check(ready: &Ready<'_>, records: &[Record], length: f64, findings: &mut Vec<Finding>) {
    let bench = Bench { ready, programs: &ready.programs, left: WORK, runs: 0 };
    let mut looked = Looked { records, bench, perturbed: None, length, reported: Vec::new() };
    start::check(&looked, findings);
    at_rest::check(&looked, findings);
    saturated::check(&looked, findings);
    jumps::check(&looked, findings);
    mixed::check(&looked, findings);
    stale::check(&mut looked, findings);
    early::check(&mut looked, findings);
    never::check(&looked, findings);
    error::check(&mut looked, findings);
    curves::check(&mut looked, findings);
    readouts::check(&looked, findings);
    begins::check(&looked, findings);
    again::check(&looked, findings);
    below_zero::check(&looked, findings);
    damping::check(&looked, findings);
    no_solver::check(&looked, findings);
    undone::check(&mut looked, findings);
    overruled::check(&mut looked, findings);
    flat::check(&mut looked, findings);
    idle::check(&mut looked, findings);
}
