//! Units: what their names mean, and how a dimension is written.

use labspec_expr::dimension::{ANGLE, BASES, Dimension};
use std::f64::consts::PI;

const KG: usize = 1;
const M: usize = 2;
const S: usize = 3;
const K: usize = 4;
const A: usize = 5;

/// The base units, by their places in a [`Dimension`]; the order in which they are written is another.
const NAMES: [&str; BASES] = ["rad", "kg", "m", "s", "K", "A"];
const WRITTEN: [usize; BASES] = [KG, M, S, K, A, ANGLE];

/// Prefixes of units, as powers of ten.
pub const PREFIXES: [(&str, i32); 13] = [
    ("", 0),
    ("p", -12),
    ("n", -9),
    ("μ", -6),
    ("u", -6),
    ("m", -3),
    ("c", -2),
    ("d", -1),
    ("h", 2),
    ("k", 3),
    ("M", 6),
    ("G", 9),
    ("T", 12),
];

/// A unit: how large it is, the powers of base units that it is made of, and whether it takes prefixes.
struct Row(&'static str, f64, &'static [(usize, i32)], bool);

const UNITS: [Row; 33] = [
    Row("rad", 1.0, &[(ANGLE, 1)], true),
    Row("radian", 1.0, &[(ANGLE, 1)], false),
    Row("radians", 1.0, &[(ANGLE, 1)], false),
    Row("deg", PI / 180.0, &[(ANGLE, 1)], false),
    Row("degree", PI / 180.0, &[(ANGLE, 1)], false),
    Row("degrees", PI / 180.0, &[(ANGLE, 1)], false),
    Row("°", PI / 180.0, &[(ANGLE, 1)], false),
    Row("m", 1.0, &[(M, 1)], true),
    Row("metre", 1.0, &[(M, 1)], false),
    Row("metres", 1.0, &[(M, 1)], false),
    Row("meter", 1.0, &[(M, 1)], false),
    Row("meters", 1.0, &[(M, 1)], false),
    Row("s", 1.0, &[(S, 1)], true),
    Row("second", 1.0, &[(S, 1)], false),
    Row("seconds", 1.0, &[(S, 1)], false),
    Row("min", 60.0, &[(S, 1)], false),
    Row("h", 3600.0, &[(S, 1)], false),
    Row("g", 1e-3, &[(KG, 1)], true),
    Row("K", 1.0, &[(K, 1)], true),
    Row("A", 1.0, &[(A, 1)], true),
    Row("N", 1.0, &[(KG, 1), (M, 1), (S, -2)], true),
    Row("newton", 1.0, &[(KG, 1), (M, 1), (S, -2)], false),
    Row("newtons", 1.0, &[(KG, 1), (M, 1), (S, -2)], false),
    Row("Nm", 1.0, &[(KG, 1), (M, 2), (S, -2)], true),
    Row("Ns", 1.0, &[(KG, 1), (M, 1), (S, -1)], true),
    Row("J", 1.0, &[(KG, 1), (M, 2), (S, -2)], true),
    Row("joule", 1.0, &[(KG, 1), (M, 2), (S, -2)], false),
    Row("joules", 1.0, &[(KG, 1), (M, 2), (S, -2)], false),
    Row("W", 1.0, &[(KG, 1), (M, 2), (S, -3)], true),
    Row("Pa", 1.0, &[(KG, 1), (M, -1), (S, -2)], true),
    Row("Hz", 1.0, &[(S, -1)], true),
    Row("V", 1.0, &[(KG, 1), (M, 2), (S, -3), (A, -1)], true),
    Row("T", 1.0, &[(KG, 1), (S, -2), (A, -1)], true),
];

/// How a unit without its powers is written: its size and its dimension.
fn symbol(word: &str) -> Option<Dimension> {
    let row = |name: &str| UNITS.iter().find(|row| row.0 == name);
    let (row, size) = match row(word) {
        Some(row) => (row, 1.0),
        None => PREFIXES.iter().filter(|(prefix, _)| !prefix.is_empty()).find_map(|(prefix, power)| {
            let found = row(word.strip_prefix(prefix)?).filter(|row| row.3)?;
            Some((found, 10f64.powi(*power)))
        })?,
    };
    let powers = row.2.iter().map(|(base, n)| Dimension::base(*base).power(f64::from(*n)));
    let dimension = powers.into_iter().try_fold(Dimension::NUMBER, |all, one| all.product(one?))?;
    // A larger unit has smaller numbers.
    Some(dimension.times(1.0 / (row.1 * size)))
}

/// What a unit means: `m/s^2`, `N m s/rad`, `kg·m²`, `1/(kg m^2)`, `m s⁻¹`; `None` for what is no unit.
pub fn parse(text: &str) -> Option<Dimension> {
    let text = plain(text);
    let (above, below) = match text.split_once('/') {
        Some((above, below)) => (above, Some(below)),
        None => (text.as_str(), None),
    };
    let mut all = product(above)?;
    // What stands behind a stroke is one unit, or in brackets, or every one has a stroke of its own.
    for part in below.into_iter().flat_map(|b| b.split('/')) {
        let part = part.trim();
        let inner = part.strip_prefix('(').and_then(|p| p.strip_suffix(')'));
        let divisor = match inner {
            Some(inner) => product(inner)?,
            None if part.split_whitespace().count() == 1 => product(part)?,
            None => return None,
        };
        all = all.product(divisor.power(-1.0)?)?;
    }
    Some(all)
}

/// Units beside each other.
fn product(text: &str) -> Option<Dimension> {
    let mut words = text.split_whitespace().peekable();
    words.peek()?;
    words.try_fold(Dimension::NUMBER, |all, word| {
        let (name, power) = match word.split_once('^') {
            Some((name, power)) => (name, power.parse::<i8>().ok()?),
            None => (word, 1),
        };
        let one = match name {
            "1" => Dimension::NUMBER,
            "%" => Dimension::NUMBER.times(100.0),
            _ => symbol(name)?,
        };
        all.product(one.power(f64::from(power))?)
    })
}

/// The same with raised digits behind `^`, and spaces for points.
fn plain(text: &str) -> String {
    const RAISED: &str = "⁰¹²³⁴⁵⁶⁷⁸⁹";
    let mut out = String::new();
    let mut raised = false;
    for c in text.trim().chars() {
        let digit = RAISED.chars().position(|r| r == c);
        let exponent = digit.is_some() || c == '⁻';
        if exponent && !raised {
            out.push('^');
        }
        raised = exponent;
        match (digit, c) {
            (Some(n), _) => out.push_str(&n.to_string()),
            (None, '⁻') => out.push('-'),
            (None, '·' | '⋅' | '*' | '×') => out.push(' '),
            (None, 'µ') => out.push('μ'),
            (None, c) => out.push(c),
        }
    }
    out
}

/// Units that are written for the powers that they stand for.
const USUAL: [&str; 9] = ["N", "N m", "N/m", "N s/m", "W", "Pa", "N s", "1/s", "m"];

/// How a dimension is written: `mm/s`, `N m`, `deg`; a plain number is `1`. What a factor does that is no power of ten is said in
/// words.
pub fn written(dimension: &Dimension) -> String {
    let usual = USUAL
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

/// A factor in few digits.
fn shortest(x: f64) -> String {
    let text = format!("{x:.3}");
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    if text == "0" || text == "-0" { format!("{x:e}") } else { text.to_string() }
}

fn from_bases(dimension: &Dimension) -> String {
    let (mut above, mut below) = (Vec::new(), Vec::new());
    for base in WRITTEN {
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
        for (text, shown) in [
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
        ] {
            let d = parse(text).unwrap_or_else(|| panic!("{text}"));
            assert_eq!(written(&d), shown, "{text}");
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
        ] {
            assert_eq!(parse(text), None, "{text}");
        }
    }
}
