//! Numbers: decimal exponents, logarithms and short text, with the same result on every platform.
//!
//! `f64::log10` comes from the platform and may differ in its last bit, which is enough to change a printed digit. Decimal
//! exponents come from Rust's exact formatting instead, and the logarithm from the series of artanh.

use std::f64::consts::{LOG10_2, LOG10_E, SQRT_2};

/// Larger magnitudes are treated as infinite, so that the difference of two values stays finite.
pub(super) const HUGE: f64 = 1e300;

/// Whether a value can be drawn on a linear axis.
pub(super) fn drawable(value: f64) -> bool {
    value.abs() <= HUGE
}

/// 10 to the power `exponent`, correctly rounded; 0 or infinity beyond the range of doubles.
pub(super) fn pow10(exponent: i32) -> f64 {
    format!("1e{exponent}").parse().unwrap_or(0.0)
}

/// Splits a positive finite number into its leading part in 1 ≤ m < 10 and its decimal exponent.
pub(super) fn decade(value: f64) -> (f64, i32) {
    let text = format!("{value:e}");
    let parts = text.split_once('e');
    parts.and_then(|(m, e)| Some((m.parse().ok()?, e.parse().ok()?))).unwrap_or((1.0, 0))
}

/// The decimal logarithm of a positive finite number; NaN for any other.
///
/// With v = m 2^e and m between 1/√2 and √2: ln m = 2 artanh s = 2 (s + s³/3 + s⁵/5 + …) for s = (m-1)/(m+1).
/// As |s| < 0.172, eleven terms reach the last digit.
pub(super) fn log10(value: f64) -> f64 {
    if value.is_nan() || value <= 0.0 || value == f64::INFINITY {
        return f64::NAN;
    }
    let (value, shift) = if value < f64::MIN_POSITIVE { (value * 2f64.powi(54), 54.0) } else { (value, 0.0) };
    let bits = value.to_bits();
    let mut exponent = ((bits >> 52) & 0x7ff) as f64 - 1023.0 - shift;
    let mut m = f64::from_bits((bits & ((1 << 52) - 1)) | (1023 << 52));
    if m > SQRT_2 {
        m /= 2.0;
        exponent += 1.0;
    }
    let s = (m - 1.0) / (m + 1.0);
    let series = (0..=11).rev().fold(0.0, |sum, i| sum * s * s + 1.0 / f64::from(2 * i + 1));
    exponent * LOG10_2 + 2.0 * s * series * LOG10_E
}

/// Formats a coordinate in pixels: at most two decimals, in a form that every renderer accepts.
pub(super) fn px(value: f64) -> String {
    if !drawable(value) {
        return String::from("0");
    }
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if matches!(text, "-0" | "") { String::from("0") } else { text.to_owned() }
}

/// Formats a value for a sentence: four significant digits, with an exponent if that is shorter.
pub(super) fn short(value: f64) -> String {
    if !value.is_finite() {
        return String::from("not finite");
    }
    if value == 0.0 {
        return String::from("0");
    }
    // Rounded first, because 9.9996 then has the exponent of 10.
    let rounded: f64 = format!("{value:.3e}").parse().unwrap_or(value);
    let (_, exponent) = decade(rounded.abs());
    let text = if (-4..6).contains(&exponent) {
        let text = format!("{rounded:.*}", usize::try_from(3 - exponent).unwrap_or(0));
        if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
    } else {
        format!("{rounded:e}")
    };
    minus(&text)
}

/// Replaces hyphens by the typographic minus sign.
pub(super) fn minus(text: &str) -> String {
    text.replace('-', "\u{2212}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn coordinates_are_short() {
        for (value, text) in [(1.0, "1"), (-0.001, "0"), (12.345, "12.35"), (100.0, "100"), (f64::NAN, "0")] {
            assert_eq!(px(value), text);
        }
        assert_eq!(px(f64::INFINITY), "0");
    }

    #[test]
    fn values_have_four_digits() {
        let cases = [
            (0.0, "0"),
            (9.99996, "10"),
            (-0.012344, "−0.01234"),
            (1234567.0, "1.235e6"),
            (123456.0, "123500"),
            (2e-9, "2e−9"),
            (f64::NAN, "not finite"),
        ];
        for (value, text) in cases {
            assert_eq!(short(value), text);
        }
    }

    #[test]
    fn logarithms_of_the_extremes() {
        assert!((log10(5e-324) + 323.306_215_343_115_8).abs() < 1e-12);
        assert!((log10(f64::MAX) - 308.254_715_559_916_7).abs() < 1e-12);
        assert!(log10(0.0).is_nan() && log10(-1.0).is_nan() && log10(f64::INFINITY).is_nan());
    }

    proptest! {
        #[test]
        fn the_logarithm_agrees_with_the_platform(bits in 1u64..0x7ff0_0000_0000_0000) {
            let value = f64::from_bits(bits);
            prop_assert!((log10(value) - value.log10()).abs() <= 1e-13 * value.log10().abs().max(1.0));
        }

        #[test]
        fn a_decade_holds_its_number(bits in 0x0010_0000_0000_0000u64..0x7fe0_0000_0000_0000) {
            let value = f64::from_bits(bits);
            let (mantissa, exponent) = decade(value);
            prop_assert!((1.0..10.0).contains(&mantissa));
            prop_assert!((mantissa * pow10(exponent) / value - 1.0).abs() < 1e-15);
        }
    }
}
