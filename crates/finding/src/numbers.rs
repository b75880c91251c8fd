//! Numbers as texts for people.

use std::ops::Range;

/// A number that is not written as plain decimals: NaN, an infinity, or one whose magnitude is outside a range, with an
/// exponent and two decimals. `None` for zero and for all others.
pub fn scientific(x: f64, plain: Range<f64>) -> Option<String> {
    if x.is_nan() {
        return Some("nan".into());
    }
    if x.is_infinite() {
        return Some(if x > 0.0 { "inf" } else { "-inf" }.into());
    }
    if x == 0.0 || plain.contains(&x.abs()) {
        return None;
    }
    let text = format!("{x:.2e}");
    // JavaScript writes the sign of the exponent.
    Some(if text.contains("e-") { text } else { text.replace('e', "e+") })
}

/// Two significant digits as plain decimals: `0.85`, `0.00018`; larger numbers as integers. Very small or large numbers
/// have an exponent.
pub fn two_digits(x: f64) -> String {
    let size = x.abs();
    if size == 0.0 || !(1e-6..1e7).contains(&size) {
        return scientific(x, 1e-6..1e7).unwrap_or_else(|| "0.00".into());
    }
    let places = (1.0 - size.log10().floor()).clamp(0.0, 9.0) as usize;
    without_zeros(format!("{x:.places$}"))
}

/// A decimal number without trailing zeros.
pub fn without_zeros(text: String) -> String {
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}
