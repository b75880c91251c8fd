//! Numbers in a snapshot: with as many digits as the simulation determines, at most five of the largest value of a row.
//!
//! A unit is the power of ten of the last digit: `0.215` is in units of 10⁻³, `2.15e4` in units of 10².

/// Number of digits of the largest value of a row.
const MAX_DIGITS: i32 = 5;
/// The unit of a row of zeros.
const ZERO_ROW_UNIT: i32 = -9;
/// Maximum number of decimals; a number with more is written with an exponent.
const DECIMALS: i32 = 8;
/// Tolerance of a written number, in units: half a unit and rounding.
const HALF_UNIT: f64 = 0.5 + 1e-9;

/// The units of a row: the finest, which is preferred, and the coarsest that is still informative.
pub(super) fn units(values: &[f64]) -> (i32, i32) {
    let finite = || values.iter().copied().filter(|x| x.is_finite());
    let scale = finite().fold(0.0, |most: f64, x| most.max(x.abs()));
    if scale == 0.0 {
        return (ZERO_ROW_UNIT, ZERO_ROW_UNIT);
    }
    let whole = finite().all(|x| x.fract() == 0.0) && scale < 1e5;
    let finest = if whole { 0 } else { exponent(scale) + 1 - MAX_DIGITS };
    (finest, finest.max(exponent(0.2 * scale)))
}

/// The power of ten of the first digit.
fn exponent(x: f64) -> i32 {
    let text = format!("{:e}", x.abs());
    text.split_once('e').and_then(|(_, power)| power.parse().ok()).unwrap_or(0)
}

/// A power of ten, the same on every machine.
pub(super) fn ten(power: i32) -> f64 {
    format!("1e{power}").parse().unwrap_or(0.0)
}

/// A number rounded to a unit.
pub(super) fn written(x: f64, unit: i32) -> String {
    let text = if (-DECIMALS..=0).contains(&unit) && x.abs() < 1e9 {
        format!("{x:.*}", unit.unsigned_abs() as usize)
    } else {
        let digits = exponent(x) - unit;
        match usize::try_from(digits) {
            Ok(digits) if x != 0.0 => format!("{x:.digits$e}"),
            // Less than a unit: rounded to one unit or to zero.
            _ if (x / ten(unit)).abs() > 0.5 => format!("{:.0e}", ten(unit).copysign(x)),
            _ => format!("0e{unit}"),
        }
    };
    // Zero has no sign.
    match text.strip_prefix('-') {
        Some(rest)
            if !rest.split('e').next().unwrap_or("").contains(|c: char| c.is_ascii_digit() && c != '0') =>
        {
            rest.into()
        }
        _ => text,
    }
}

/// The number in a text, and its unit.
pub(super) fn read(text: &str) -> Option<(f64, i32)> {
    let (mantissa, power) = match text.split_once('e') {
        Some((mantissa, power)) => (mantissa, power.parse::<i32>().ok()?),
        None => (text, 0),
    };
    let digits = mantissa.strip_prefix('-').unwrap_or(mantissa);
    let plain = digits.chars().all(|c| c.is_ascii_digit() || c == '.');
    if !plain || !digits.starts_with(|c: char| c.is_ascii_digit()) || digits.ends_with('.') || text.len() > 40
    {
        return None;
    }
    let decimals = mantissa.split_once('.').map_or(0, |(_, behind)| behind.len() as i32);
    let x: f64 = text.parse().ok()?;
    let unit = power.checked_sub(decimals)?;
    (x.is_finite() && (-400..=400).contains(&unit)).then_some((x, unit))
}

/// The tolerance of a number with this unit.
pub(super) fn tolerance(unit: i32) -> f64 {
    HALF_UNIT * ten(unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn written_numbers_are_read_with_their_unit() {
        for (x, unit, text) in [
            (0.21523, -3, "0.215"),
            (-0.21523, -1, "-0.2"),
            (-0.0004, -3, "0.000"),
            (3.0, 0, "3"),
            (1234.5678, -1, "1234.6"),
            (123456.0, 1, "1.2346e5"),
            (3.14159e-14, -16, "3.14e-14"),
            (0.7e-14, -14, "1e-14"),
            (-0.2e-14, -14, "0e-14"),
            (0.0, -14, "0e-14"),
            (6.0, 1, "1e1"),
        ] {
            assert_eq!(written(x, unit), text);
            let (y, u) = read(text).unwrap();
            assert_eq!(u, unit, "{text}");
            assert!((x - y).abs() <= tolerance(unit), "{text}");
        }
        for none in [
            "",
            "-",
            "~",
            "x",
            "1e",
            "1e400",
            "1e99999999999",
            "--1",
            "1.",
            ".5",
            "1.2.3",
            "0x1",
            "inf",
            "nan",
            "+1",
            "1e-500",
        ] {
            assert_eq!(read(none), None, "{none}");
        }
    }

    #[test]
    fn the_largest_value_of_a_row_has_five_digits() {
        assert_eq!(units(&[1.0, 0.215]), (-4, -1));
        assert_eq!(units(&[3.0, 0.0, 2.0]), (0, 0));
        assert_eq!(units(&[0.0, 0.0]), (ZERO_ROW_UNIT, ZERO_ROW_UNIT));
        assert_eq!(units(&[f64::NAN, 2e-7]), (-11, -8));
        assert_eq!(units(&[250000.5]), (1, 4));
    }
}
