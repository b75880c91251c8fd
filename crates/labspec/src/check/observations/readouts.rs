//! Readouts that hardly change what they print while their value changes.

use super::ObservedLab;
use crate::check::setconst::digits;
use crate::finding::Finding;
use crate::rules;
use crate::run::Cell;
use crate::spec::Readout;
use std::collections::BTreeSet;

/// A value that changes by less than this share of itself hardly changes.
const CHANGES: f64 = 0.5;
/// The same where one text is printed whatever happens, and where two are, without decimals.
const HARDLY: f64 = 0.05;
const SOME: f64 = 0.1;
/// So many different values are no count of something.
const MANY: usize = 20;

/// A readout whose label has a unit, and that is a text in every run.
fn text_with_unit<'c>(
    observed: &ObservedLab<'_>,
    readout: &Readout,
    mut cells: impl Iterator<Item = &'c Cell>,
) -> Option<Finding> {
    let (unit, _) = crate::bind::of_label(readout.label.as_str())?;
    let Cell::Text(first) = cells.next()? else { return None };
    let words = first.chars().filter(|c| c.is_alphabetic()).count() > 1;
    (words && cells.all(|c| matches!(c, Cell::Text(_)))).then(|| {
        let message = format!("the label says {unit}, but the value is a string");
        Finding::warning(rules::LABEL_UNIT, readout.label.span(), message)
            .why(format!(
                "it is a string at every sample of {}: \"{}\" at first",
                observed.runs(),
                crate::json::read::shorten(first)
            ))
            .related(readout.expr.span(), "this is a string")
            .help("display the number that the label names; two labels may be exchanged")
    })
}

pub(super) fn check_readouts(observed: &ObservedLab<'_>, findings: &mut Vec<Finding>) {
    let lab = observed.bench.ready.lab;
    let traces = lab.traces().count();
    for (i, readout) in lab.readouts.iter().enumerate() {
        let cells =
            || observed.records.iter().flat_map(|r| &r.rows).filter_map(|row| row.get(1 + traces + i));
        let numbers = || cells().map(Cell::number);
        findings.extend(text_with_unit(observed, readout, cells()));
        if cells().any(|c| !matches!(c, Cell::Number(x) if x.is_finite())) {
            continue;
        }
        let (low, high) =
            numbers().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
        let unit = 10_f64.powi(-(readout.digits() as i32));
        let values: BTreeSet<u64> = numbers().filter(|x| x.fract() != 0.0).map(f64::to_bits).collect();
        // What is nearly 0 is printed with an exponent, and so not rounded.
        let rounded = 4 * numbers().filter(|x| *x == 0.0 || x.abs() >= 1e-3).count() >= 3 * numbers().count();
        let many = values.len() >= MANY && rounded;
        let share = (high - low) / low.abs().max(high.abs());
        let printed: BTreeSet<String> =
            cells().map(|c| c.rounded(readout.digits()).trim_start_matches('-').to_string()).collect();
        // One text, or two next to each other, for all that it does.
        let few = readout.digits() == 0
            && (printed.len() == 1 && share > HARDLY || printed.len() == 2 && share > SOME);
        // A number that is never 0, and is printed as 0.
        let nothing = printed.iter().all(|t| t == "0") && (low >= 1e-3 || high <= -1e-3);
        let few = few || nothing;
        if !nothing && !(many && (share > CHANGES && high - low < 2.0 * unit || few)) {
            continue;
        }
        let texts = printed.iter().take(2).cloned().collect::<Vec<_>>().join(" and ");
        let [low, high] = [low, high].map(|x| digits(x, 3));
        let message = format!("\"{}\" is printed with too few decimals", readout.label.value);
        let place = readout.digits.as_ref().map_or(readout.expr.span(), |d| d.span.clone());
        findings.push(
            Finding::warning(rules::TOO_FEW_DIGITS, readout.expr.span(), message)
                .why(format!(
                    "its value goes from {low} to {high} in {}, but it prints {}",
                    observed.runs(),
                    if few { texts } else { "numbers within two units of the last decimal".into() }
                ))
                .related(place, "decimals")
                .help("increase `digits`"),
        );
    }
}
