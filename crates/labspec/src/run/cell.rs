//! One sampled value, and its format on the page.

use labspec_expr::Value;
use labspec_finding::scientific;

/// One sampled value.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// A number, possibly not finite.
    Number(f64),
    /// A text.
    Text(String),
    /// A boolean.
    Bool(bool),
    /// `undefined`, `null`, or an expression that threw.
    Nothing,
}

impl From<Value> for Cell {
    fn from(value: Value) -> Cell {
        match value {
            Value::Number(x) => Cell::Number(x),
            Value::Boolean(b) => Cell::Bool(b),
            Value::String(s) => Cell::Text(s.to_string()),
            // Readouts of lists and records are compile errors.
            _ => Cell::Nothing,
        }
    }
}

impl Cell {
    /// The number to draw; NaN for other values.
    pub fn number(&self) -> f64 {
        match self {
            Cell::Number(x) => *x,
            Cell::Bool(b) => f64::from(u8::from(*b)),
            _ => f64::NAN,
        }
    }

    /// The value as the page prints it with this number of decimals.
    pub fn rounded(&self, digits: u32) -> String {
        match self {
            Cell::Number(x) => rounded(*x, digits),
            Cell::Text(t) => t.clone(),
            Cell::Bool(b) => b.to_string(),
            Cell::Nothing => "nan".into(),
        }
    }
}

/// A number as the page prints it: with fixed decimals, or exponential when it is small or large.
pub fn rounded(x: f64, digits: u32) -> String {
    scientific(x, 1e-3..1e5).unwrap_or_else(|| labspec_expr::to_fixed(x, digits as usize))
}

/// The number that [`rounded`] prints.
pub fn printed(x: f64, digits: u32) -> f64 {
    /// Up to this number of decimals, the power of ten and every scaled integer are exact doubles.
    const DIGITS: u32 = 9;
    let slow = || rounded(x, digits).parse().unwrap_or(x);
    if digits > DIGITS || !(1e-3..1e5).contains(&x.abs()) {
        return slow();
    }
    let power = 10f64.powi(digits as i32);
    let scaled = x.abs() * power;
    // The product has an error of at most half a unit in the last place, which matters only near a tie.
    if (scaled.fract() - 0.5).abs() <= scaled * f64::EPSILON {
        return slow();
    }
    (scaled.round() / power).copysign(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_print_as_the_page_prints_them() {
        let cases = [
            (0.0, 3, "0.000"),
            (0.36718, 2, "0.37"),
            (0.0005, 3, "5.00e-4"),
            (123456.0, 1, "1.23e+5"),
            (99999.0, 0, "99999"),
            (-0.001, 3, "-0.001"),
            (f64::NAN, 3, "nan"),
            (f64::NEG_INFINITY, 3, "-inf"),
        ];
        for (x, digits, text) in cases {
            assert_eq!(rounded(x, digits), text);
        }
    }

    proptest::proptest! {
        #[test]
        fn a_printed_number_is_that_of_the_text(
            mantissa in -1.0..1.0f64, exponent in -5..7, ties in -200_000..200_000i32, digits in 0..12u32,
        ) {
            let tie = f64::from(ties) * 0.5 / 10f64.powi(digits as i32);
            for x in [mantissa * 10f64.powi(exponent), tie, tie.next_up(), tie.next_down(), f64::from(ties) / 64.0, 0.0, -0.0] {
                let text: f64 = rounded(x, digits).parse().unwrap();
                assert_eq!(printed(x, digits).to_bits(), text.to_bits(), "{x:e} with {digits}");
            }
        }
    }
}
