//! Conversions between numbers and strings as in ECMAScript: `Number::toString`, `StringToNumber`, `ToInt32`.

/// JavaScript's `String(x)`: the shortest digits that parse to the same double, in JavaScript's format.
pub fn to_text(x: f64) -> String {
    if x.is_nan() {
        return "NaN".into();
    }
    if x.is_infinite() {
        return if x > 0.0 { "Infinity" } else { "-Infinity" }.into();
    }
    if x == 0.0 {
        return "0".into(); // of either sign
    }
    // Rust's exponent form has the same number of digits: `d.ddde±n`.
    let scientific = format!("{:e}", x.abs());
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let digits: String = mantissa.chars().filter(|c| *c != '.').collect();
    let digits = even_of_two(digits, exponent, x.abs());
    // The value is 0.digits × 10^point.
    let point = exponent.parse::<i32>().unwrap_or(0) + 1;
    let sign = if x < 0.0 { "-" } else { "" };
    format!("{sign}{}", layout(&digits, point))
}

/// The shortest digits. If the number lies exactly between two candidates, JavaScript uses the even digits,
/// and Rust may use either.
fn even_of_two(digits: String, exponent: &str, x: f64) -> String {
    let n: u64 = digits.parse().unwrap_or(0);
    // With fewer digits, the candidates are less dense than doubles, so there is no tie.
    if digits.len() < 15 || n.is_multiple_of(2) {
        return digits;
    }
    // The lower candidate, if the number lies exactly in the middle between two.
    let below = |decimals: usize| {
        let exact = format!("{x:.decimals$e}");
        let exact = exact.split('e').next().unwrap_or("").replace('.', "");
        let (below, rest) = exact.split_at_checked(digits.len())?;
        let zeros = rest.strip_prefix('5')?;
        zeros.bytes().all(|b| b == b'0').then(|| below.to_owned())
    };
    // 800 digits represent every double exactly.
    let Some(below) = below(40).and_then(|_| below(800)) else { return digits };
    let even = if below == digits { n + 1 } else { n - 1 }.to_string();
    let (first, rest) = even.split_at(1);
    let same = format!("{first}.{rest}e{exponent}").parse() == Ok(x);
    if same { even } else { digits }
}

/// Formats 0.`digits` × 10^`point` as the standard's `Number::toString` does.
fn layout(digits: &str, point: i32) -> String {
    let k = digits.len() as i32;
    if (k..=21).contains(&point) {
        let zeros = "0".repeat((point - k) as usize);
        return format!("{digits}{zeros}");
    }
    if (1..=21).contains(&point) {
        let (whole, fraction) = digits.split_at(point as usize);
        return format!("{whole}.{fraction}");
    }
    if (-5..=0).contains(&point) {
        let zeros = "0".repeat((-point) as usize);
        return format!("0.{zeros}{digits}");
    }
    let e = point - 1;
    let sign = if e < 0 { '-' } else { '+' };
    let (first, rest) = digits.split_at(1.min(digits.len()));
    let fraction = if rest.is_empty() { String::new() } else { format!(".{rest}") };
    format!("{first}{fraction}e{sign}{}", e.abs())
}

/// White space of JavaScript, including line ends.
pub fn is_space(c: char) -> bool {
    c.is_whitespace() && c != '\u{85}' || c == '\u{feff}'
}

/// JavaScript's `Number(text)`.
pub(crate) fn from_text(text: &str) -> f64 {
    let text = text.trim_matches(is_space);
    if text.is_empty() {
        return 0.0;
    }
    for (prefix, radix) in [("0x", 16), ("0X", 16), ("0o", 8), ("0O", 8), ("0b", 2), ("0B", 2)] {
        if let Some(digits) = text.strip_prefix(prefix) {
            return from_digits(digits, radix).unwrap_or(f64::NAN);
        }
    }
    let (sign, magnitude) = match text.strip_prefix('-') {
        Some(rest) => (-1.0, rest),
        None => (1.0, text.strip_prefix('+').unwrap_or(text)),
    };
    if magnitude == "Infinity" {
        return sign * f64::INFINITY;
    }
    // Rust also accepts `inf`, `nan` and a second sign; JavaScript accepts only digits, a point and an exponent.
    let starts = magnitude.starts_with(|c: char| c.is_ascii_digit() || c == '.');
    let plain = magnitude.chars().all(|c| c.is_ascii_digit() || matches!(c, '.' | 'e' | 'E' | '+' | '-'));
    if starts && plain { sign * magnitude.parse().unwrap_or(f64::NAN) } else { f64::NAN }
}

/// The value of digits in a radix that is a power of two, correctly rounded, or `None` if a character is not a digit.
pub fn from_digits(digits: &str, radix: u32) -> Option<f64> {
    let bits = radix.trailing_zeros();
    let mut mantissa: u128 = 0;
    let mut dropped: i32 = 0; // the number of binary places that were dropped
    let mut lost = false; // whether any of them was not zero
    for c in digits.chars() {
        let digit = c.to_digit(radix)?;
        if mantissa >> 120 == 0 {
            mantissa = mantissa << bits | u128::from(digit);
        } else {
            dropped = dropped.saturating_add(bits as i32);
            lost |= digit != 0;
        }
    }
    // A dropped nonzero bit breaks a tie upwards; it is far below the 53 bits of the result.
    let value = (mantissa | u128::from(lost)) as f64;
    (!digits.is_empty()).then(|| libm::ldexp(value, dropped.min(5000)))
}

/// ToInt32: truncate, then wrap modulo 2^32.
pub(crate) fn to_int32(x: f64) -> i32 {
    if !x.is_finite() {
        return 0;
    }
    x.trunc().rem_euclid(4_294_967_296.0) as u32 as i32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_print_as_in_javascript() {
        for (x, text) in [
            (0.1 + 0.2, "0.30000000000000004"),
            (-0.0, "0"),
            (100.0, "100"),
            (1e21, "1e+21"),
            (123456789012345680000.0, "123456789012345680000"),
            (1e-6, "0.000001"),
            (1.5e-7, "1.5e-7"),
            (-1e-7, "-1e-7"),
            (5e-324, "5e-324"),
            (f64::MAX, "1.7976931348623157e+308"),
            (123.456, "123.456"),
            // Exactly between two candidates: the even one.
            (1.204_811_096_191_406_2, "1.2048110961914062"),
            (-1.204_811_096_191_406_2, "-1.2048110961914062"),
            (f64::NAN, "NaN"),
            (f64::NEG_INFINITY, "-Infinity"),
        ] {
            assert_eq!(to_text(x), text);
        }
    }

    #[test]
    fn text_reads_as_in_javascript() {
        for (text, x) in [
            ("", 0.0),
            (" 12 \n", 12.0),
            ("0x1F", 31.0),
            ("0b101", 5.0),
            ("-Infinity", f64::NEG_INFINITY),
            (".5", 0.5),
            ("5.", 5.0),
            ("1e3", 1000.0),
            ("0x20000000000001", 9007199254740992.0),
            ("0x20000000000003", 9007199254740996.0),
        ] {
            assert_eq!(from_text(text), x, "{text:?}");
        }
        for text in ["inf", "nan", "1,5", "--1", "-0x10", "1_000", "12px", ".", "e5", "0x", "+-3", "infinity"]
        {
            assert!(from_text(text).is_nan(), "{text:?}");
        }
    }

    #[test]
    fn integers_wrap_modulo_two_to_the_32() {
        for (x, n) in [(4294967296.0, 0), (2147483648.0, i32::MIN), (-1.5, -1), (f64::NAN, 0), (1e300, 0)] {
            assert_eq!(to_int32(x), n);
        }
    }
}
