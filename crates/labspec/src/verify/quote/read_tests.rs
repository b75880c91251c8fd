//! Forms in which lessons print numbers: each is read correctly, or refused by name.

use super::*;
use proptest::prelude::*;

fn read(text: &str) -> QuoteReading {
    read_quote(text).unwrap_or_else(|e| panic!("{text}: {e:?}"))
}

/// The value, and half a unit of the last digit.
fn plain(text: &str) -> (f64, f64) {
    let q = read(text).read;
    (q.value, q.half_unit)
}

fn refused(text: &str) -> &'static str {
    match read_quote(text) {
        Err(Unread::Form(form)) => form,
        other => panic!("{text}: {other:?}"),
    }
}

#[test]
#[expect(clippy::too_many_lines, reason = "a table of numbers")]
fn numbers_are_read_as_printed() {
    for (text, value, half_unit) in [
        ("0.442 s", 0.442, 0.5e-3),
        ("about 29 mm", 29.0, 0.5),
        ("≈ 29 mm", 29.0, 0.5),
        ("~29 mm", 29.0, 0.5),
        ("-14.7150", -14.715, 0.5e-4),
        ("\u{2212}1.5", -1.5, 0.05),
        ("–1.5", -1.5, 0.05),
        ("x = - 1.5 m", -1.5, 0.05),
        ("5e4 rad", 5e4, 5e3),
        ("3.0e-7", 3e-7, 0.5e-8),
        (".5 m", 0.5, 0.05),
        ("2 e", 2.0, 0.5),
        ("1,500", 1500.0, 0.5),
        ("1,500.25 N", 1500.25, 0.005),
        ("-1,234,567", -1234567.0, 0.5),
        ("1{,}500", 1500.0, 0.5),
        ("1 500 steps", 1500.0, 0.5),
        ("1\u{a0}500", 1500.0, 0.5),
        ("1\u{2009}500", 1500.0, 0.5),
        ("1&thinsp;500", 1500.0, 0.5),
        ("$1\\,500$", 1500.0, 0.5),
        ("1'500", 1500.0, 0.5),
        ("0.000 833 m", 0.000833, 0.5e-6),
        ("1.5×10³", 1500.0, 50.0),
        ("1.5 million", 1.5e6, 5e4),
        ("0.5 thousand s", 500.0, 50.0),
        ("0.5 e3 s", 500.0, 50.0),
        ("3万", 3e4, 5e3),
        ("０．５秒", 0.5, 0.05),
        ("下落需要0.5秒", 0.5, 0.05),
        ("$\\SI{0.5}{\\second}$", 0.5, 0.05),
        ("$\\num{1.5e-3}$", 1.5e-3, 5e-5),
        ("1.5 x 10^3", 1500.0, 50.0),
        ("1.5*10**3", 1500.0, 50.0),
        ("$3.0\\times10^{-3}$", 3e-3, 0.5e-4),
        ("$2.4 \\times 10^{-4}$", 2.4e-4, 0.5e-5),
        ("$2.4 \\cdot 10^{-4}$ s", 2.4e-4, 0.5e-5),
        ("2.4 · 10⁻⁴", 2.4e-4, 0.5e-5),
        ("2.4&times;10<sup>&minus;4</sup>", 2.4e-4, 0.5e-5),
        ("10^{-3} m", 1e-3, 0.5e-3),
        ("½", 0.5, 0.005),
        ("1½ turns", 1.5, 0.005),
        ("-¼", -0.25, 0.005),
        ("0,442 s", 0.442, 0.5e-3),
        ("I = mL^2 + I_c = 0.2501", 0.2501, 0.5e-4),
        ("$I = mL^2 + I_c = 0.2501$", 0.2501, 0.5e-4),
        ("x_1 after t2 of H2O in 3D, the 2nd: 0.7", 0.7, 0.05),
        ("x<sub>12</sub> m² 0.7", 0.7, 0.05),
        ("$2\\pi\\sqrt{l/g} \\approx 1.42$ s", 1.42, 0.005),
        ("3.96 m/s", 3.96, 0.005),
        ("30° ", 30.0, 0.5),
        ("$30^\\circ$", 30.0, 0.5),
        ("<b>0.442</b>&nbsp;s", 0.442, 0.5e-3),
        ("0.44.", 0.44, 0.005),
        ("(0.44)", 0.44, 0.005),
    ] {
        let (x, half) = plain(text);
        assert!(
            (x - value).abs() <= 1e-15 * value.abs() && (half - half_unit).abs() <= 1e-12 * half_unit,
            "{text}: {x} ± {half}"
        );
    }
    for none in ["none", "", "half a second", "H2O", "x_1 and t2", "$L^2$", "in 3D", "#3", "=", "-", "."] {
        assert_eq!(read_quote(none), Err(Unread::NoNumber), "{none}");
    }
}

#[test]
fn a_plus_minus_and_a_range_contain_their_interval() {
    for (text, low, high) in [
        ("0.44 ± 0.01 s", 0.43, 0.45),
        ("0.44 +/- 0.01 s", 0.43, 0.45),
        ("0.44+/-0.01", 0.43, 0.45),
        ("$0.44 \\pm 0.01$ s", 0.43, 0.45),
        ("0.44 s ± 0.01 s", 0.43, 0.45),
        ("200 N ± 2 %", 196.0, 204.0),
        ("4.4e-3 ± 1e-4", 4.3e-3, 4.5e-3),
        ("0.4 to 0.5 s", 0.4, 0.5),
        ("0.4 s to 0.5 s", 0.4, 0.5),
        ("0.4–0.5 s", 0.4, 0.5),
        ("0.4 – 0.5 s", 0.4, 0.5),
        ("0.4-0.5 s", 0.4, 0.5),
        ("between 0.4 and 0.5", 0.4, 0.5),
        ("Between 0.4 s and 0.5 s", 0.4, 0.5),
        ("0.4...0.5", 0.4, 0.5),
        ("-5 to -3", -5.0, -3.0),
    ] {
        let q = read(text).read;
        let (NumberForm::PlusMinus(a, b) | NumberForm::Range(a, b)) = q.form else { panic!("{text}: {q:?}") };
        assert!((a - low).abs() < 1e-12 && (b - high).abs() < 1e-12, "{text}: {a} {b}");
        assert!(
            q.is(low) && q.is(high) && q.is((low + high) / 2.0) && !q.is(high + 0.1 * (high - low)),
            "{text}"
        );
    }
}

#[test]
fn a_percentage_is_a_number_or_a_fraction_of_one() {
    for text in ["50 %", "50%", "$50\\%$", "50 percent", "50 per cent"] {
        let r = read(text);
        let share = r.share.unwrap();
        assert!(r.read.is(50.4) && !r.read.is(0.5) && share.is(0.504) && !share.is(0.52), "{text}");
        assert_eq!((share.to_string(), share.print(0.6)), ("0.50".into(), "0.60".into()), "{text}");
    }
    assert!(read("12.5 ‰").share.unwrap().is(0.0125));
    let range = read("10–20 %");
    assert!(range.read.is(15.0) && range.share.unwrap().is(0.15));
    assert!(read("48 % ± 2 %").share.unwrap().is(0.49));
}

#[test]
fn ambiguous_numbers_are_not_called_wrong() {
    let ambiguities = |text| read(text).ambiguities.iter().map(|(q, _)| q.value).collect::<Vec<_>>();
    assert_eq!(ambiguities("1,500"), [1.5]);
    assert_eq!(ambiguities("2 500 N"), [2.0, 500.0]);
    assert_eq!(ambiguities("0.442 s with 2 ms"), [2.0]);
    assert_eq!(ambiguities("1,500,000"), Vec::<f64>::new());
    assert_eq!(ambiguities("a = 3 m + 2 m = 5 m"), Vec::<f64>::new());
    for text in ["3,5 m", "1,44", "0.442 s with 2 ms"] {
        assert!(read(text).is_ambiguous.is_some(), "{text}");
    }
    assert_eq!(read("0,442 s").is_ambiguous, None);
}

#[test]
fn a_plus_minus_sign_without_a_number_before_it_states_a_magnitude() {
    for text in ["± 0.01", "a torque of ±3 N m"] {
        assert_eq!(read(text).read.form, NumberForm::Magnitude, "{text}");
    }
}

#[test]
fn other_forms_are_refused_by_name() {
    for (text, form) in [
        ("3.14.0", "digits with several points"),
        ("1.500,5", "digits with a comma after a point"),
        ("1,2,3", "digits with several commas"),
        ("2^10", "a power"),
        ("0.442(3) s", "an uncertainty in brackets"),
        ("1/2", "a fraction with a slash"),
        ("3:2", "a ratio or a time of day"),
        ("0.5 × 9.81", "a product"),
        ("3 x 4", "a product"),
        ("2π", "a formula"),
        ("\\tfrac12", "a formula"),
        ("$\\tfrac12 \\cdot 3$", "a formula"),
        ("g + 0.5", "a formula"),
        ("0.5 + 0.1", "a sum"),
        ("0.5 - 0.1", "a difference or a range"),
        ("0.5-0.1", "a difference or a range"),
        ("never more than 3 N", "a bound, not a number"),
        ("∓ 0.01", "a plus-minus sign without its number"),
        ("0.44 ± 2 %", "a plus-minus value with an unclear unit"),
        ("(0.44 ± 0.01)×10^3", "a formula"),
        ("from 0.3 to 1.8 m", "a change from one number to another, or a range"),
        ("1 mm to 2 cm", "a range whose ends have different units or powers of ten"),
        ("0.1234567890123456789012345678901", "a number with more digits than a computation has"),
        ("1e99999", "a number with more digits than a computation has"),
    ] {
        assert_eq!(refused(text), form, "{text}");
    }
}

#[test]
fn units_are_read() {
    for (text, unit) in [
        ("0.83 mm", "mm"),
        ("0.83mm", "mm"),
        ("3.96 m/s", "m/s"),
        ("0.4 to 0.5 s", "s"),
        ("9.81 m/s²", "m/s^2"),
        ("$3\\,\\mathrm{kg}$", "kg"),
        ("5 m^{-1} here", "m^-1"),
        ("50 %", "%"),
        ("7", ""),
        ("7, that is", ""),
    ] {
        assert_eq!(read(text).unit.map_or(String::new(), |u| u.text), unit, "{text}");
    }
}

/// A number printed in one of the supported forms, with the expected value and half unit.
fn printed() -> impl Strategy<Value = (String, f64, f64)> {
    let digits = (any::<bool>(), 0u64..10_000_000, 0usize..6, 0usize..9, -30i32..30);
    let around =
        prop::sample::select(vec!["", "about ", "≈ ", "~", "x_1 = ", "$I = mL^2 + I_c =$ ", "it takes "]);
    let unit = prop::sample::select(vec!["", " s", " mm", "\u{a0}m/s", " kg m²", ".", ", then", "&nbsp;N"]);
    (digits, around, unit).prop_map(|((negative, n, decimals, style, power), around, unit)| {
        // Trailing zeros of an approximate number are not digits of it.
        let is_approximate = ["about ", "≈ ", "~"].contains(&around);
        let n = if is_approximate && n % 10 == 0 { n + 1 } else { n };
        let scale = 10u64.pow(decimals as u32);
        let (whole, part) = (n / scale, n % scale);
        let point = if decimals > 0 { format!(".{part:0decimals$}") } else { String::new() };
        let groups = |separator: &str| {
            let text = whole.to_string();
            let mut out = String::new();
            for (i, c) in text.chars().enumerate() {
                if i > 0 && (text.len() - i).is_multiple_of(3) {
                    out += separator;
                }
                out.push(c);
            }
            out
        };
        let minus = if !negative {
            ""
        } else if style % 2 == 0 {
            "-"
        } else {
            "\u{2212}"
        };
        let raised = power.to_string().replace('-', "\u{2212}");
        let (text, exponent) = match style {
            0 => (format!("{whole}{point}"), 0),
            1 => (format!("{}{point}", groups(",")), 0),
            2 => (format!("{}{point}", groups("\u{202f}")), 0),
            3 => (format!("{}{point}", groups("{,}")), 0),
            4 => (format!("{whole}{point}e{power}"), power),
            5 => (format!("{whole}{point} × 10^{power}"), power),
            6 => (format!("${whole}{point}\\times10^{{{power}}}$"), power),
            7 => (format!("{whole}{point}&middot;10<sup>{raised}</sup>"), power),
            _ => (format!("{whole}{point} x 10^{{{power}}}"), power),
        };
        let sign = if negative { -1.0 } else { 1.0 };
        let value = sign * format!("{n}e{}", exponent - decimals as i32).parse::<f64>().unwrap();
        let half = format!("0.5e{}", exponent - decimals as i32).parse::<f64>().unwrap();
        (format!("{around}{minus}{text}{unit}"), value, half)
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(3000))]
    #[test]
    fn printed_numbers_are_read_back((text, value, half) in printed()) {
        let q = match read_quote(&text) {
            Ok(r) => r.read,
            Err(e) => return Err(TestCaseError::fail(format!("{text}: {e:?}"))),
        };
        prop_assert!((q.value - value).abs() <= 1e-14 * value.abs(), "{}: {} and not {}", text, q.value, value);
        prop_assert!((q.half_unit - half).abs() <= 1e-12 * half, "{}: half a unit {} and not {}", text, q.half_unit, half);
        prop_assert!(q.is(value) && q.is(value + 0.99 * half) && !q.is(value + 1.01 * half), "{}", text);
        // The printed value is read as the same number.
        let again = read_quote(&q.print(value)).unwrap().read;
        prop_assert!((again.value - value).abs() <= 2.0 * half, "{}: {}", text, q.print(value));
    }

    #[test]
    fn nothing_written_is_a_panic(text in "[-–0-9.,' eE×x^±+/:()=%½{}$\\\\<>&;a-cs\u{a0}²₁]{0,40}", x in any::<f64>(), any in "\\PC{0,60}") {
        for text in [text, any] {
            if let Ok(r) = read_quote(&text) {
                r.read.print(x);
                r.read.is(x);
                r.read.differ(x, 1.0);
                let _ = r.read.to_string();
            }
        }
    }
}
