//! The values of a sweep that the number in the first cell of a row may state.

use super::number::{NumberForm, Quoted};
use super::read::QuoteReading;

/// Tolerance for the rounding error of a converted value, relative to the stated number.
const ROUNDING: f64 = 1e-9;

/// The indexes of the values that a number may state. A single number states the value nearest to it among those that print
/// like it; an interval or an approximate number may state every value in it. A bound states no value.
pub(in crate::verify) fn stated_values(reading: &QuoteReading, values: &[f64]) -> Vec<usize> {
    let readings = [Some(reading.read), reading.share].into_iter().flatten();
    let others = reading.ambiguities.iter().map(|(other, _)| *other);
    let mut members: Vec<usize> =
        readings.chain(others).flat_map(|read| nearest(&read, reading.is_approximate, values)).collect();
    members.sort_unstable();
    members.dedup();
    members
}

/// The indexes of the values that one reading of a number may state.
fn nearest(read: &Quoted, is_approximate: bool, values: &[f64]) -> Vec<usize> {
    let distance = |x: f64| match read.form {
        NumberForm::Interval(low, high) if !(low.is_finite() && high.is_finite()) => f64::INFINITY,
        _ if is_approximate => 0.0,
        NumberForm::PlusMinus(..) | NumberForm::Range(..) | NumberForm::Interval(..) => 0.0,
        NumberForm::Magnitude => (x.abs() - read.value).abs(),
        NumberForm::Plain(_) | NumberForm::Fraction | NumberForm::Share => (x - read.value).abs(),
    };
    let matching = || values.iter().enumerate().filter(|(_, x)| read.is(**x)).map(|(i, x)| (i, distance(*x)));
    let least = matching().map(|(_, distance)| distance).fold(f64::INFINITY, f64::min);
    let most = least + ROUNDING * read.value.abs();
    matching().filter(|(_, distance)| distance.is_finite() && *distance <= most).map(|(i, _)| i).collect()
}
