//! Readouts that hardly change what they print while their value changes.

use super::Looked;
use crate::check::refresh::digits;
use crate::finding::Finding;
use crate::rules;
use crate::run::Cell;
use std::collections::BTreeSet;

/// A value that changes by less than this share of itself hardly changes.
const CHANGES: f64 = 0.5;
/// So many different values are no count of something.
const MANY: usize = 20;

pub(super) fn check(looked: &Looked<'_>, findings: &mut Vec<Finding>) {
    let lab = looked.bench.ready.lab;
    let traces = lab.traces().count();
    for (i, readout) in lab.readouts.iter().enumerate() {
        let cells = || looked.records.iter().flat_map(|r| &r.rows).filter_map(|row| row.get(1 + traces + i));
        let numbers = || cells().map(Cell::number);
        if cells().any(|c| !matches!(c, Cell::Number(x) if x.is_finite())) {
            continue;
        }
        let (low, high) =
            numbers().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
        let unit = 10_f64.powi(-(readout.digits() as i32));
        let values: BTreeSet<u64> = numbers().filter(|x| x.fract() != 0.0).map(f64::to_bits).collect();
        // What is nearly 0 is printed with an exponent, and so not rounded.
        let rounded = 4 * numbers().filter(|x| *x == 0.0 || x.abs() >= 1e-3).count() >= 3 * numbers().count();
        let changes = high - low > CHANGES * low.abs().max(high.abs()) && values.len() >= MANY;
        if !(changes && rounded && high - low < 2.0 * unit) {
            continue;
        }
        let [low, high] = [low, high].map(|x| digits(x, 3));
        let message = format!("\"{}\" is printed with too few decimals", readout.label.value);
        let place = readout.digits.as_ref().map_or(readout.expr.span(), |d| d.span.clone());
        findings.push(
            Finding::warning(rules::TOO_FEW_DIGITS, readout.expr.span(), message)
                .why(format!(
                    "its value goes from {low} to {high} in {}, which is less than two units of the last decimal that is printed",
                    looked.runs()
                ))
                .related(place, "decimals")
                .help("print more decimals: `digits`"),
        );
    }
}
