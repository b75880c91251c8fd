//! Ranges of values, and times in messages.

/// A time in milliseconds, for people.
pub fn milliseconds(seconds: f64) -> String {
    labspec::verify::significant(1e3 * seconds)
}

/// The largest minus the smallest value.
pub(super) fn range(values: &[f64]) -> f64 {
    let (low, high) =
        values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(*x), high.max(*x)));
    if high >= low { high - low } else { 0.0 }
}
