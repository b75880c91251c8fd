//! Units: parsing of unit texts, and formatting of dimensions.

use crate::unit_grammar::unit;
use crate::unit_table::{A, K, KG, M, S};
pub use crate::unit_table::{PREFIXES, is_wide};
use labspec_expr::dimension::{ANGLE, BASES, Dimension};
use std::f64::consts::PI;

/// The base units in the order of a [`Dimension`]; `BASE_UNIT_ORDER` is the order in which they are formatted.
const NAMES: [&str; BASES] = ["rad", "kg", "m", "s", "K", "A"];
const BASE_UNIT_ORDER: [usize; BASES] = [KG, M, S, K, A, ANGLE];

/// A unit expression at the beginning of a text.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnitText {
    /// Its length in bytes.
    pub length: usize,
    /// Its dimension, or `None` if it is a known unit that is not supported (`dB`) or is ambiguous (`N m/rad s`).
    pub dimension: Option<Dimension>,
}

/// The dimension of a unit: `m/s^2`, `N m s/rad`, `kg·m²`, `1/(kg m^2)`, `m s⁻¹`; `None` if the text is not a supported unit.
pub fn parse(text: &str) -> Option<Dimension> {
    let text = text.trim();
    let found = read(text)?;
    found.dimension.filter(|_| found.length == text.len())
}

/// Whether the whole text is a unit, supported or not.
pub fn is_unit(text: &str) -> bool {
    read(text).is_some_and(|found| found.length == text.len())
}

/// Parses the longest unit expression at the beginning of a text.
pub fn read(text: &str) -> Option<UnitText> {
    let (rest, dimension) = unit(text).ok()?;
    // A `1` alone is a number; before `/` it is a part of a unit.
    let is_number = !rest.is_empty() && text.strip_suffix(rest) == Some("1");
    (!is_number).then_some(UnitText { length: text.len() - rest.len(), dimension })
}

/// Units that are preferred to powers of base units.
const PREFERRED_UNITS: [&str; 9] = ["N", "N m", "N/m", "N s/m", "W", "Pa", "N s", "1/s", "m"];

/// Formats a dimension: `mm/s`, `N m`, `deg`; a dimensionless number is `1`. A factor that is not a power of
/// ten is described in words.
pub fn written(dimension: &Dimension) -> String {
    let usual = PREFERRED_UNITS
        .iter()
        .find(|u| parse(u).is_some_and(|d| d.agrees(dimension) && d.has_angle() == dimension.has_angle()));
    let base = usual.map_or_else(|| from_bases(dimension), |u| u.to_string());
    let factor = dimension.factor.abs();
    let near = |x: f64| (factor / x - 1.0).abs() < 1e-3;
    if factor.is_nan() {
        return format!("{base}, times a number");
    }
    if near(1.0) {
        return base;
    }
    if near(180.0 / PI) && base.contains("rad") {
        return base.replacen("rad", "deg", 1);
    }
    let prefix = PREFIXES.iter().find(|(p, n)| near(10f64.powi(-n)) && *p != "u");
    let plain = !base.starts_with("1") && !base.starts_with("kg") && !base.contains('^');
    match prefix.filter(|_| plain || base.starts_with("m/s") || base.starts_with("rad/s")) {
        Some((prefix, _)) => format!("{prefix}{base}"),
        None => format!("{base}, times {}", shortest(dimension.factor)),
    }
}

/// Formats a factor with few digits.
fn shortest(x: f64) -> String {
    let text = format!("{x:.3}");
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    if text == "0" || text == "-0" { format!("{x:e}") } else { text.to_string() }
}

fn from_bases(dimension: &Dimension) -> String {
    let (mut above, mut below) = (Vec::new(), Vec::new());
    for base in BASE_UNIT_ORDER {
        let name = NAMES[base];
        match dimension.whole_power(base) {
            Some(0) => {}
            Some(1) => above.push(name.to_string()),
            Some(-1) => below.push(name.to_string()),
            Some(n) if n > 0 => above.push(format!("{name}^{n}")),
            Some(n) => below.push(format!("{name}^{}", -n)),
            None => above.push(format!("a root of {name}")),
        }
    }
    let above = if above.is_empty() { "1".to_string() } else { above.join(" ") };
    match below.as_slice() {
        [] => above,
        [one] => format!("{above}/{one}"),
        _ => format!("{above}/({})", below.join(" ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_read_and_written() {
        for (text, expected) in [
            ("m", "m"),
            ("mm", "mm"),
            ("mm/s", "mm/s"),
            ("m/s^2", "m/s^2"),
            ("m/s²", "m/s^2"),
            ("m s⁻¹", "m/s"),
            ("kg m/s", "N s"),
            ("kg m²/s²", "N m"),
            ("J", "N m"),
            ("mN", "mN"),
            ("N·m", "N m"),
            ("N m s/rad", "kg m^2/(s rad)"),
            ("rad/s", "rad/s"),
            ("deg", "deg"),
            ("°/s", "deg/s"),
            ("mrad", "mrad"),
            ("1/(kg m^2)", "1/(kg m^2)"),
            ("1/kg", "1/kg"),
            ("Hz", "1/s"),
            ("%", "1, times 100"),
            ("g", "kg, times 1000"),
            ("cm^2", "m^2, times 10000"),
            ("kN", "kN"),
            ("s-1", "1/s"),
            ("m per second squared", "m/s^2"),
            ("metres per second", "m/s"),
            ("Kilometer", "km"),
            ("millim", "mm"),
            ("KiloN", "kN"),
            ("毫秒", "ms"),
            ("米/秒", "m/s"),
            ("キログラム", "kg"),
            ("ミリメートル", "mm"),
            ("千克", "kg"),
            ("rpm", "rad/s, times 9.549"),
            ("bpm", "1/s, times 60"),
        ] {
            let d = parse(text).unwrap_or_else(|| panic!("{text}"));
            assert_eq!(written(&d), expected, "{text}");
        }
        for text in [
            "",
            "ramp and block",
            "qvel[3]",
            "N m/rad s",
            "m//s",
            "x",
            "m^",
            "m^x",
            "1/",
            "mmin",
            "degree or m",
            "dB",
            "s-12",
            "m.",
        ] {
            assert_eq!(parse(text), None, "{text}");
        }
    }

    #[test]
    fn quotients_are_written_in_words() {
        for (text, expected) in [
            ("metre per second per second", "m/s^2"),
            ("metres a second", "m/s"),
            ("metres a second a second", "m/s^2"),
            ("kilometres an hour", "m/s, times 3.6"),
            ("metres every second", "m/s"),
            ("Meter in der Sekunde", "m/s"),
            ("Meter je Sekunde", "m/s"),
            ("mètres à la seconde", "m/s"),
            ("metri al secondo", "m/s"),
            ("chilometri all'ora", "m/s, times 3.6"),
            ("kilómetros por hora", "m/s, times 3.6"),
        ] {
            let d = parse(text).unwrap_or_else(|| panic!("{text}"));
            assert_eq!(written(&d), expected, "{text}");
        }
    }

    #[test]
    fn the_longest_unit_is_read() {
        let parsed = |text: &str| read(text).map(|u| (u.length, u.dimension.map(|d| written(&d))));
        let symbol = |length, unit: &str| Some((length, Some(unit.to_string())));
        assert_eq!(parsed("s, and"), symbol(1, "s"));
        assert_eq!(parsed("N m at"), symbol(3, "N m"));
        assert_eq!(parsed("s / m high"), symbol(5, "s/m"));
        assert_eq!(parsed("s per m"), symbol(7, "s/m"));
        assert_eq!(parsed("s m"), symbol(3, "m s"));
        assert_eq!(parsed("s-1."), symbol(3, "1/s"));
        assert_eq!(parsed("s-0.5 s"), symbol(1, "s"));
        assert_eq!(parsed("s 2 m"), symbol(1, "s"));
        assert_eq!(parsed("秒的时间"), symbol(3, "s"));
        assert_eq!(parsed("千克"), symbol(6, "kg"));
        assert_eq!(parsed("°C"), Some((3, None)));
        assert_eq!(parsed("N m/rad s"), Some((9, None)));
        assert_eq!(parsed("balls"), None);
        assert_eq!(parsed("metres a second on the moon"), symbol(15, "m/s"));
        for text in
            ["metres a second later", "metres a second time", "metres a second-hand", "metres a day later"]
        {
            assert_eq!(parsed(text), symbol(6, "m"), "{text}");
        }
    }

    /// A text of 100 kB of characters with which a unit may begin is parsed fast, without deep recursion.
    #[test]
    fn hostile_units_are_read_in_linear_time() {
        for piece in [
            "(", "m(", "1", "1/", "s1 ", "(s1 ", "m.", "^", "m^", "m^(", "m^-", "²", "秒", "m ", "square ",
            "9", "a", "·", "\\",
        ] {
            for head in ["", "m", "m^", "m^("] {
                let text = format!("{head}{}", piece.repeat(100_000 / piece.len()));
                assert!(read(&text).is_none_or(|found| found.length <= text.len()), "{head}{piece}");
            }
        }
    }
}
