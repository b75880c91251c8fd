//! Units in the labels of a lab, and when a unit contradicts the dimension of an expression.

use labspec_bind::units::parse;
use labspec_expr::dimension::Dimension;

/// Texts that may also be symbols or words when they are alone: an area, a mass, a temperature, a length.
const AMBIGUOUS_UNITS: [&str; 14] =
    ["A", "C", "K", "L", "V", "T", "g", "h", "l", "1", "ft", "lb", "bar", "rev"];

/// Words for quantities, with the unit that an ambiguous symbol then is: `mass (g)` is in grams.
const QUANTITY_WORDS: [(&str, &[&str]); 12] = [
    ("mass", &["g"]),
    ("masse", &["g"]),
    ("masa", &["g"]),
    ("massa", &["g"]),
    ("weight", &["g"]),
    ("time", &["h"]),
    ("duration", &["h"]),
    ("zeit", &["h"]),
    ("temperature", &["K", "C"]),
    ("volume", &["L", "l"]),
    ("length", &["ft"]),
    ("height", &["ft"]),
];

/// The dimension of a unit beside a label. Words of the label decide what an ambiguous symbol means.
pub(crate) fn unit_beside(text: &str, label: &str) -> Option<Dimension> {
    let text = text.trim();
    let words = || label.split(|c: char| !c.is_alphabetic()).map(str::to_lowercase);
    let meant = |(word, units): &(&str, &[&str])| units.contains(&text) && words().any(|w| w == *word);
    if QUANTITY_WORDS.iter().any(meant) { parse(text) } else { unit(text) }
}

/// The dimension of a unit without a label.
fn unit(text: &str) -> Option<Dimension> {
    let text = text.trim();
    if AMBIGUOUS_UNITS.contains(&text) { None } else { parse(text) }
}

/// The unit in brackets at the end of a label, as in `speed (mm/s)` and `E [J]`, with its dimension. `ball(s)` has none.
pub fn of_label(label: &str) -> Option<(&str, Dimension)> {
    let label = label.trim_end();
    let (open, close) = if label.ends_with(']') { ('[', ']') } else { ('(', ')') };
    let inner = label.strip_suffix(close)?;
    // The unit may contain brackets: `(J/(kg K))`.
    let mut depth = 1;
    let start = inner.char_indices().rev().find(|(_, c)| {
        depth += i32::from(*c == close) - i32::from(*c == open);
        depth == 0
    });
    let (before, text) = inner.split_at_checked(start?.0)?;
    let text = text.strip_prefix(open)?;
    if !(before.is_empty() || before.ends_with(char::is_whitespace)) {
        return None;
    }
    Some((text, unit_beside(text, before)?))
}

/// The unit of the heading of a column, with its dimension: `error (mm)`, `t [ms]`, `x / mm`, `time in ms`, `depth, mm`,
/// `ms`.
pub(crate) fn of_heading(head: &str) -> Option<(&str, Dimension)> {
    let head = head.trim();
    let whole = |text: &str| parse(text).filter(|_| !text.is_empty() && text != "1");
    if let Some((text, found)) = in_brackets(head).and_then(|text| Some((text, whole(text)?))) {
        return Some((text, found));
    }
    for sign in [" in ", ", ", " - ", " – ", ": "] {
        if let Some((_, text)) = head.rsplit_once(sign)
            && let Some(found) = whole(text.trim())
        {
            return Some((text.trim(), found));
        }
    }
    // `x / mm` is a quantity divided by its unit; `m/s` and the ratio `M / m` are not.
    for (slash, _) in head.match_indices('/') {
        let (left, text) = (head.get(..slash)?.trim(), head.get(slash + 1..)?.trim());
        let ratio =
            left.to_lowercase() == text.to_lowercase() || !left.contains(' ') && whole(head).is_some();
        if let Some(found) = whole(text).filter(|_| !ratio && !left.is_empty()) {
            return Some((text, found));
        }
    }
    let plain = head.chars().count() > 1 && !["min", "mil", "bar", "day", "year"].contains(&head);
    whole(head).filter(|_| plain).map(|found| (head, found))
}

/// The text in the last brackets of a heading: `10^-3 s` in `t (10^-3 s)`.
fn in_brackets(head: &str) -> Option<&str> {
    let close = head.chars().next_back()?;
    let open = [(')', '('), (']', '['), ('）', '（')].iter().find(|(c, _)| *c == close).map(|(_, o)| *o)?;
    let inner = head.strip_suffix(close)?;
    let mut depth = 1;
    let start = inner.char_indices().rev().find(|(_, c)| {
        depth += i32::from(*c == close) - i32::from(*c == open);
        depth == 0
    });
    Some(inner.get(start?.0..)?.strip_prefix(open)?.trim())
}

/// The text in the last brackets of a heading, or after its last ` / ` or ` in `.
pub(crate) fn behind_heading(head: &str) -> Option<&str> {
    let head = head.trim();
    let behind = || [" / ", " in "].iter().find_map(|sign| Some(head.rsplit_once(sign)?.1.trim()));
    in_brackets(head).or_else(behind)
}

/// Whether numbers of a dimension certainly do not have a unit. A number literal that is a factor may have a dimension, so
/// it can explain a different dimension. With an equal dimension it is a pure number, and a wrong power of ten is certain.
pub(crate) fn contradicts(found: &Dimension, unit: &Dimension) -> bool {
    let factor = found.factor.abs();
    if !factor.is_finite() || factor == 0.0 {
        return false;
    }
    if !found.agrees(unit) {
        // The factor 1000 for millimetres is a conversion, not a quantity, and so is that of degrees.
        let difference = (factor / unit.factor.abs() - 1.0).abs();
        let of_length = unit.factor != 1.0 && is_power_of_ten(unit.factor) && difference < 1e-9;
        let of_angle = found.has_angle() && is_degrees(unit.factor.abs()) && difference < 1e-3;
        return found.is_exact() || of_length || of_angle;
    }
    let ratio = factor / unit.factor.abs();
    if (ratio - 1.0).abs() < 1e-3 {
        return false;
    }
    // Numbers in base units are not in another unit. Degrees apply only to angles: a number without a unit may be
    // something else.
    if found.is_exact() {
        return found.has_angle() || !unit.has_angle() || is_power_of_ten(unit.factor);
    }
    let converted = is_power_of_ten(factor) || found.has_angle() && is_degrees(factor);
    let is_common_unit = is_power_of_ten(unit.factor) || is_degrees(unit.factor.abs());
    let pure = (0.1..=10.0).contains(&factor) && !(0.01..=100.0).contains(&ratio);
    converted && is_common_unit || pure
}

/// Whether a number is a power of ten such as 0.001, 100, 1000 or 1, but not 0.1 or 10.
fn is_power_of_ten(x: f64) -> bool {
    let power = x.abs().log10();
    (power - power.round()).abs() < 1e-9 && power.round().abs() != 1.0
}

/// Whether a factor converts radians to degrees, or back.
fn is_degrees(factor: f64) -> bool {
    let degrees = 1f64.to_degrees();
    (factor / degrees - 1.0).abs() < 1e-3 || (factor * degrees - 1.0).abs() < 1e-3
}

/// Whether numbers of a dimension are an angle in degrees.
pub(crate) fn in_degrees(d: &Dimension) -> bool {
    let near = (d.factor.abs() / 1f64.to_degrees() - 1.0).abs() < 1e-3;
    d.has_angle() && d.agrees(&Dimension::RADIAN) && near
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_read_from_brackets_at_the_end() {
        for (label, unit) in [
            ("height (m)", Some("m")),
            ("E [J]", Some("J")),
            ("c (J/(kg K))", Some("J/(kg K)")),
            ("friction capacity 2μN/g (kg)", Some("kg")),
            ("ball(s)", None),
            ("friction coefficient (ramp and block)", None),
            ("car (A)", None),
            ("free quat w", None),
            ("(m)", Some("m")),
            (")", None),
            ("", None),
        ] {
            assert_eq!(of_label(label).map(|(text, _)| text), unit, "{label}");
        }
    }

    #[test]
    fn headings_have_units_in_many_forms() {
        for (head, unit) in [
            ("error (mm)", Some("mm")),
            ("error(mm)", Some("mm")),
            ("t [ms]", Some("ms")),
            ("x / mm", Some("mm")),
            ("v / (m/s)", Some("m/s")),
            ("v / m/s", Some("m/s")),
            ("t/ms", Some("ms")),
            ("time in ms", Some("ms")),
            ("depth, mm", Some("mm")),
            ("v, m/s", Some("m/s")),
            ("ms", Some("ms")),
            ("m/s", Some("m/s")),
            ("時間（秒）", Some("秒")),
            ("M / m", None),
            ("height", None),
            ("x", None),
            ("run in all", None),
            ("", None),
        ] {
            assert_eq!(of_heading(head).map(|(text, _)| text), unit, "{head}");
        }
    }

    #[test]
    fn only_certain_units_contradict() {
        let d = |text: &str, factor: f64| parse(text).unwrap().times(factor);
        for (found, unit, certain) in [
            (d("m", 1.0), "mm", true),
            (d("s", 1.0), "min", true),
            (d("s", 1.0 / 60.0), "min", false),
            (d("m", 1000.0), "mm", false),
            (d("m", 1000.0), "m", true),
            (d("1", 1000.0), "mm", true),
            (d("deg/s", 1.0), "deg", true),
            (d("deg", 1.0), "deg/s", true),
            // The factor may be a speed in deg/s.
            (d("s", 1f64.to_degrees()), "deg", false),
            (d("deg/s", 2.0), "deg", false),
            (d("s", 50.0), "mm", false),
            (d("m", 2.0), "m", false),
            (d("m", 2.0), "mm", true),
            (d("m", 1.0), "m/s", true),
            // The factor 1000 may be a stiffness in N/m, and 9.81 an acceleration.
            (d("m", 1000.0), "N", false),
            (d("s", 9.81), "m/s", false),
            (d("rad", 1.0), "deg", true),
            (d("deg", 1.0), "deg", false),
            (d("deg", 1.0), "rad", true),
            (d("rad", 1.0), "m", true),
            (d("rad m", 1.0), "m", false),
            (d("N m", 1.0), "J", false),
            (d("N m", f64::NAN), "s", false),
            (d("1", 1.0), "deg", false),
        ] {
            let unit = parse(unit).unwrap();
            assert_eq!(contradicts(&found, &unit), certain, "{found:?} {unit:?}");
        }
    }
}
