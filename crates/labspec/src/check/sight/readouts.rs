//! Readouts that print one text while their value changes.

use super::Looked;
use crate::check::refresh::digits;
use crate::finding::Finding;
use crate::rules;
use crate::run::{self, Cell};

/// A value that changes by less than this share of itself hardly changes.
const CHANGES: f64 = 0.5;

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
        // A number that is nearly 0 is printed with an exponent, and flashes by.
        let plain = || numbers().filter(|x| *x == 0.0 || x.abs() >= 1e-3);
        if 4 * plain().count() < 3 * numbers().count() {
            continue;
        }
        let mut printed = plain().map(|x| run::shown(x, readout.digits()));
        let Some(text) = printed.next() else { continue };
        if high - low <= CHANGES * low.abs().max(high.abs()) || !printed.all(|t| t == text) {
            continue;
        }
        let [low, high] = [low, high].map(|x| digits(x, 3));
        let message = format!("\"{}\" always prints {text}", readout.label.value);
        let place = readout.digits.as_ref().map_or(readout.expr.span(), |d| d.span.clone());
        findings.push(
            Finding::warning(rules::TOO_FEW_DIGITS, readout.expr.span(), message)
                .why(format!("its value goes from {low} to {high} in {}", looked.runs()))
                .related(place, "decimals")
                .help("print more decimals: `digits`"),
        );
    }
}
