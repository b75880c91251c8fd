//! Units that differ by a power of ten: the text says 0.83 mm, the expression gives 0.00083.

use super::number::{NumberForm, Quoted, ten};
use labspec_bind::units::PREFIXES;

/// The difference between the number of a text and the value of an expression.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Shift {
    /// The number of the text is the value of the expression times this power of ten.
    pub(super) power: i32,
    /// The unit of the text, and the resulting unit of the expression, when both are known.
    pub(super) units: Option<(String, String)>,
}

/// Units that take prefixes.
const BASES: [&str; 17] =
    ["m", "s", "g", "N", "J", "W", "Pa", "Hz", "V", "A", "K", "C", "L", "l", "rad", "mol", "Nm"];

/// The parts of a unit: power of ten of the prefix, base, and exponent.
fn parts(unit: &str) -> Option<(i32, &str, i32)> {
    // In m/s, the part before the slash has the prefix.
    let head = unit.split(['/', '·']).next().unwrap_or(unit);
    let (word, raised) = match head.split_once('^') {
        Some((word, n)) => (word, n.parse().ok()?),
        None => (head, 1),
    };
    if BASES.contains(&word) {
        return Some((0, word, raised));
    }
    PREFIXES.iter().find_map(|(prefix, power)| {
        let base = word.strip_prefix(prefix).filter(|_| !prefix.is_empty())?;
        BASES.contains(&base).then_some((*power, base, raised))
    })
}

/// The power of ten between a quoted number that differs and the computed one, if units explain it or it is unlikely to be
/// a coincidence.
pub(super) fn shift(quoted: &Quoted, unit: &str, computed: f64) -> Option<Shift> {
    // A wide range contains many powers of ten.
    if matches!(quoted.form, NumberForm::Range(low, high) if high > 3.0 * low) {
        return None;
    }
    if quoted.value == 0.0 || computed == 0.0 || !computed.is_finite() {
        return None;
    }
    let power = (quoted.value / computed).abs().log10().round() as i32;
    if power == 0 || power.abs() > 15 || !quoted.is(computed * ten(power)) {
        return None;
    }
    let figures = (quoted.value / (2.0 * quoted.half_unit)).abs().log10().floor() + 1.0;
    let raised_parts = parts(unit).filter(|(_, _, raised)| *raised > 0);
    let units = raised_parts.and_then(|(prefix, base, raised)| {
        // The power of the prefix that the unit of the expression must have.
        let other = prefix * raised + power;
        let name = PREFIXES.iter().find(|(_, p)| other % raised == 0 && *p == other / raised)?.0;
        let rest = unit.get(unit.split(['/', '·']).next().map_or(0, str::len)..).unwrap_or("");
        let raised = if raised == 1 { String::new() } else { format!("^{raised}") };
        Some((unit.to_string(), format!("{name}{base}{raised}{rest}")))
    });
    let bare = units.as_ref().is_some_and(|(_, other)| parts(other).is_some_and(|(p, ..)| p == 0));
    let usual = matches!(power.abs(), 1..=3 | 6 | 9);
    (bare || usual && figures >= 2.0 || figures >= 3.0).then_some(Shift { power, units })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::verify::quote::read::quoted;

    #[test]
    fn prefixes_explain_powers_of_ten() {
        let s = |text: &str, unit: &str, x: f64| shift(&quoted(text).unwrap(), unit, x);
        let names = |text: &str, unit: &str, x: f64| s(text, unit, x).map(|s| (s.power, s.units.unwrap().1));
        assert_eq!(names("0.83 mm", "mm", 0.000831), Some((3, "m".into())));
        assert_eq!(names("1 mm", "mm", 0.00083), Some((3, "m".into())));
        assert_eq!(names("0.442 s", "s", 442.0), Some((-3, "ms".into())));
        assert_eq!(names("12 cm", "cm", 120.0), Some((-1, "mm".into())));
        assert_eq!(names("25 mm²", "mm^2", 25e-6), Some((6, "m^2".into())));
        assert_eq!(names("396 cm/s", "cm/s", 3.96), Some((2, "m/s".into())));
        assert_eq!(s("4.42", "", 0.442), Some(Shift { power: 1, units: None }));
        for (text, unit, x) in [
            ("0.442 s", "s", 0.45),
            ("0 s", "s", 0.1),
            ("3 N", "N", 31.0),
            ("3 N", "N", 3.1e7),
            ("0.442 s", "s", f64::NAN),
            ("0.442 s", "s", -442.0),
        ] {
            assert_eq!(s(text, unit, x), None, "{text} {x}");
        }
    }
}
