//! A number as a text prints it: its value and its precision, and how other numbers are printed in the same form.

use labspec_expr::to_fixed;
use std::fmt;

/// A printed number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quoted {
    /// Its value; the middle of a range.
    pub value: f64,
    /// Half a unit of its last digit.
    pub half_unit: f64,
    /// Decimals of the mantissa.
    pub decimals: usize,
    /// The power of ten, 0 without an exponent.
    pub exponent: i32,
    /// How it is written.
    pub form: NumberForm,
}

/// How a number is written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NumberForm {
    /// Digits, optionally with a power of ten.
    Plain(Style),
    /// `½`, `1¾`: compared to two decimals.
    Fraction,
    /// `50 %` or `5 ‰`, read as the fraction 0.5 or 0.005.
    Share,
    /// `0.44 ± 0.01`: every value in the interval is right.
    PlusMinus(f64, f64),
    /// `0.4 to 0.5`: every value in the interval is right.
    Range(f64, f64),
    /// `about 200`, `over 0.4`: every value in the interval is right.
    Interval(f64, f64),
    /// `±3`: the magnitude of a value.
    Magnitude,
}

/// How digits and powers of ten are written, so that another number can be written in the same way.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Style {
    /// The separator between groups of three digits.
    pub group: Option<char>,
    /// `×10^3` rather than `e3`.
    pub times: bool,
}

impl Quoted {
    /// Whether this number equals `x` at its printed precision.
    pub fn is(&self, x: f64) -> bool {
        match self.form {
            // The ends are included, with a tolerance for their rounding errors.
            NumberForm::PlusMinus(low, high)
            | NumberForm::Range(low, high)
            | NumberForm::Interval(low, high) => {
                let slack = 1e-9 * self.value.abs();
                low - slack <= x && x <= high + slack
            }
            // A value halfway may be rounded either way, with a tolerance for its own rounding error.
            NumberForm::Magnitude => Quoted { form: NumberForm::Fraction, ..*self }.is(x.abs()),
            _ => (x - self.value).abs() <= self.half_unit * (1.0 + 1e-6) + 1e-12 * self.value.abs(),
        }
    }

    /// Another number, printed with the same precision.
    pub fn print(&self, x: f64) -> String {
        let style = match self.form {
            NumberForm::Plain(style) => style,
            NumberForm::Fraction | NumberForm::Share | NumberForm::Interval(..) | NumberForm::Magnitude => {
                Style::default()
            }
            NumberForm::PlusMinus(..) | NumberForm::Range(..) => return crate::verify::significant(x),
        };
        if !x.is_finite() || x.abs() >= 1e15 && self.exponent == 0 {
            return crate::verify::significant(x);
        }
        if self.exponent == 0 {
            return group(&without_minus_zero(to_fixed(x, self.decimals)), style.group);
        }
        let mantissa = self.value.abs() / ten(self.exponent);
        let mut exponent = self.exponent;
        // A mantissa from 1 to 10 keeps this form: 4.4e-2 and not 44000.0e-6.
        if (0.9999..10.0).contains(&mantissa) && x != 0.0 {
            let printed = format!("{x:.*e}", self.decimals);
            exponent = printed.split_once('e').and_then(|(_, e)| e.parse().ok()).unwrap_or(exponent);
        }
        let digits = without_minus_zero(to_fixed(x / ten(exponent), self.decimals));
        if style.times { format!("{digits}×10^{exponent}") } else { format!("{digits}e{exponent}") }
    }

    /// Whether the printed number distinguishes two computed numbers: it is right for only one of them, or, if it is right
    /// for neither, they are printed differently.
    pub fn differ(&self, a: f64, b: f64) -> bool {
        if self.is(a) || self.is(b) { self.is(a) != self.is(b) } else { self.print(a) != self.print(b) }
    }
}

/// `10^n`, rounded like a parsed literal.
pub(super) fn ten(n: i32) -> f64 {
    format!("1e{n}").parse().unwrap_or(f64::NAN)
}

fn without_minus_zero(text: String) -> String {
    let zero = text.bytes().all(|b| matches!(b, b'-' | b'0' | b'.'));
    if zero { text.trim_start_matches('-').to_string() } else { text }
}

/// Inserts separators between groups of three digits before the point.
fn group(text: &str, separator: Option<char>) -> String {
    let Some(separator) = separator else { return text.to_string() };
    let (sign, rest) = text.strip_prefix('-').map_or(("", text), |rest| ("-", rest));
    let (whole, decimals) = rest.find('.').map_or((rest, ""), |point| rest.split_at(point));
    let mut grouped = String::from(sign);
    for (i, c) in whole.chars().enumerate() {
        if i > 0 && (whole.len() - i).is_multiple_of(3) {
            grouped.push(separator);
        }
        grouped.push(c);
    }
    grouped + decimals
}

impl fmt::Display for Quoted {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let short = crate::verify::significant;
        match self.form {
            NumberForm::PlusMinus(low, high) => {
                write!(f, "{} ± {}", short((low + high) / 2.0), short((high - low) / 2.0))
            }
            NumberForm::Range(low, high) => write!(f, "{} to {}", short(low), short(high)),
            // The digits without separators.
            NumberForm::Plain(style) => {
                let plain = Quoted { form: NumberForm::Plain(Style { group: None, ..style }), ..*self };
                f.write_str(&plain.print(self.value))
            }
            NumberForm::Magnitude => write!(f, "±{}", self.print(self.value)),
            NumberForm::Fraction | NumberForm::Share | NumberForm::Interval(..) => {
                f.write_str(&self.print(self.value))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plain(value: f64, decimals: usize, exponent: i32) -> Quoted {
        let half_unit = 0.5 * ten(exponent - decimals as i32);
        Quoted { value, half_unit, decimals, exponent, form: NumberForm::Plain(Style::default()) }
    }

    #[test]
    fn precision_is_that_of_the_print() {
        let q = plain(0.442, 3, 0);
        assert!(q.is(0.4424) && q.is(0.4415) && !q.is(0.4426) && !q.is(f64::NAN));
        assert_eq!(q.print(0.46), "0.460");
        assert_eq!(q.print(-0.0001), "0.000");
        // A tie is rounded as in a readout: away from zero, not to the even digit.
        for (x, decimals, text) in
            [(248.5, 0, "249"), (-2.5, 0, "-3"), (0.125, 2, "0.13"), (1.005, 2, "1.00")]
        {
            assert_eq!(plain(1.0, decimals, 0).print(x), text);
            assert_eq!(plain(1.0, decimals, 0).print(x), to_fixed(x, decimals));
        }
        assert_eq!(plain(2e-3, 0, -3).print(2.5), "3e0");
        assert_eq!(plain(3e-7, 1, -7).print(4.44e-7), "4.4e-7");
        assert_eq!(plain(3e-7, 1, -7).print(0.0444), "4.4e-2");
        assert_eq!(plain(3e-7, 1, -7).print(9.97e-7), "1.0e-6");
        assert_eq!(plain(30e-7, 0, -7).print(0.0), "0e-7");
        // 12.2625 is halfway between two numbers with three decimals.
        assert!(plain(12.263, 3, 0).is(12.2625) && plain(12.262, 3, 0).is(12.2625));
        let thousands = Quoted {
            form: NumberForm::Plain(Style { group: Some(','), times: false }),
            ..plain(1500.0, 0, 0)
        };
        assert_eq!(thousands.print(-1234567.0), "-1,234,567");
        assert_eq!(thousands.print(123.0), "123");
        assert_eq!(thousands.to_string(), "1500");
        for x in [f64::NAN, f64::INFINITY, 1e300, -1e-300] {
            assert!(thousands.print(x).len() < 40);
        }
    }

    #[test]
    fn equal_printed_forms_do_not_differ() {
        let q = plain(0.442, 3, 0);
        assert!(!q.differ(0.4419, 0.44249) && q.differ(0.44249, 0.44251) && q.differ(0.442, f64::NAN));
        assert!(!q.differ(0.5001, 0.5002) && q.differ(0.5001, 0.5009));
        // A value halfway between is right for both.
        assert!(!q.differ(0.4425, 0.44249));
    }

    #[test]
    fn a_range_contains_its_interval() {
        let q = Quoted { form: NumberForm::Range(0.4, 0.5), ..plain(0.45, 1, 0) };
        assert!(q.is(0.4) && q.is(0.5) && !q.is(0.501) && !q.is(f64::NAN) && q.differ(0.45, 0.51));
        assert_eq!(q.to_string(), "0.4 to 0.5");
    }
}
