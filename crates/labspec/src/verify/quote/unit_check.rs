//! Compares the unit of a text, or of a numeric question, with the dimension of an expression, and determines the
//! conversion between them.

use super::unit_text::{Link, Unit, share};
use crate::bind::contradicts;
use labspec_bind::units::{self, written};
use labspec_expr::dimension::Dimension;

/// How a unit relates to the dimension of an expression.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::verify) enum UnitMatch {
    /// The unit agrees, or the values can be converted to it.
    Fits,
    /// The unit certainly differs.
    Wrong,
    /// It may be a symbol of a formula: `2 h` means two hours or two timesteps.
    Unsure,
    /// The dimension of the expression or of the unit is unknown.
    Unknown,
}

/// Compares a unit with the dimension of an expression.
pub(in crate::verify) fn hold(unit: &Unit, found: Option<&Dimension>) -> UnitMatch {
    let Some(found) = found else { return UnitMatch::Unknown };
    let wrong = if unit.link == Link::Clause { UnitMatch::Unsure } else { UnitMatch::Wrong };
    let Some(expected) = &unit.dimension else {
        let other = units::is_unit(&unit.text);
        let certain = found.is_exact() && !found.is_number();
        return if other && certain { wrong } else { UnitMatch::Unknown };
    };
    // The unit radian may be omitted, but another power of it is wrong.
    let angle = expected.angle();
    if found.is_exact() && found.has_angle() && angle != found.angle() && !(0.0..=1.0).contains(&angle) {
        return wrong;
    }
    // The unit radian may be omitted, but names of counted things are wrong for an angle.
    if unit.is_counted() && found.is_exact() && found.has_angle() {
        return wrong;
    }
    // Hertz counts turns, which are not radians.
    let turns = unit.text.contains("Hz") && found.is_exact() && found.has_angle() && found.agrees(expected);
    let fits = !contradicts(found, expected) && !turns;
    if fits && is_other_turn(found, expected) {
        return wrong;
    }
    if fits {
        return UnitMatch::Fits;
    }
    match unit.link == Link::Clause
        || unit.is_doubtful() && unit.link == Link::Direct && !found.agrees(expected)
    {
        true => UnitMatch::Unsure,
        false => UnitMatch::Wrong,
    }
}

/// Whether a value per second without an angle is compared with turns per minute or degrees per second, which are other
/// numbers both for turns and for radians.
fn is_other_turn(found: &Dimension, expected: &Dimension) -> bool {
    let turns = (expected.factor.abs() * std::f64::consts::TAU - 1.0).abs() < 1e-9;
    is_rate(found) && found.is_exact() && is_angular_rate(expected) && !expected.is_exact() && !turns
}

/// Whether a dimension is that of a frequency.
fn is_rate(d: &Dimension) -> bool {
    units::parse("1/s").is_some_and(|rate| d.agrees(&rate)) && !d.has_angle()
}

/// Whether a dimension is that of an angular velocity.
pub(super) fn is_angular_rate(d: &Dimension) -> bool {
    units::parse("1/s").is_some_and(|rate| d.agrees(&rate)) && d.angle() == 1.0
}

/// The dimension without a literal factor that is certainly a pure number: a half, or a multiple of π. A frequency times 2π is
/// an angular velocity.
pub(in crate::verify) fn without_pure_factor(d: Dimension) -> Dimension {
    use std::f64::consts::{PI, TAU};
    const PURE: [f64; 9] =
        [0.5, PI, TAU, 2.0 * TAU, PI / 2.0, PI / 4.0, 2.0 * TAU / 3.0, 1.0 / PI, 1.0 / TAU];
    let is = |x: &f64| (d.factor.abs() / x - 1.0).abs() < 1e-9;
    if d.is_number() || !PURE.iter().any(is) {
        return d;
    }
    let exact = d.times(1.0 / d.factor.abs());
    let angle = match () {
        () if is(&TAU) && is_rate(&d) => 1.0,
        () if is(&(1.0 / TAU)) && is_angular_rate(&d) => -1.0,
        () => return exact,
    };
    Dimension::RADIAN.power(angle).and_then(|angle| exact.product(angle)).unwrap_or(exact)
}

/// Factor that converts the values of an expression to a unit, where that is certain.
pub(in crate::verify) fn conversion(unit: &Dimension, found: &Dimension) -> Option<f64> {
    let factor = (unit.factor / found.factor).abs();
    (found.is_exact() && found.agrees(unit) && found.has_angle() == unit.has_angle() && factor.is_finite())
        .then_some(factor)
}

/// Whether a factor is a power of ten.
pub(super) fn is_power_of_ten(factor: f64) -> bool {
    let power = factor.abs().log10();
    (power - power.round()).abs() < 1e-9
}

/// How the unit of a question relates to the values of its `value`.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::verify) enum AnswerUnit {
    /// The values are in this unit after multiplication by the factor: 1, or 1000 where the question asks for millimetres
    /// and the value is in metres.
    Equal(f64),
    /// The unit differs: the unit of the question, and that of the value.
    Wrong(String, String),
    /// The unit is unknown, but the value has one: the text, and the unit of the value.
    Unread(String, String),
    /// The dimension of the value is uncertain, or there is no unit: the numbers are compared without conversion.
    Unknown,
}

impl AnswerUnit {
    /// Factor that converts the value to the unit of the question.
    pub(in crate::verify) fn factor(&self) -> f64 {
        match self {
            AnswerUnit::Equal(factor) => *factor,
            AnswerUnit::Wrong(..) | AnswerUnit::Unread(..) | AnswerUnit::Unknown => 1.0,
        }
    }
}

/// Factor that converts a fraction of one to the unit of a question; `None` unless this is a percentage.
pub(in crate::verify) fn percentage(unit: &str) -> Option<f64> {
    share(&super::table::rendered(unit)).map(|power| 10f64.powi(-power))
}

/// Whether a text is a known unit.
pub(in crate::verify) fn is_unit(text: &str) -> bool {
    let plain = super::table::rendered(text);
    !plain.is_empty() && units::read(&plain).is_some_and(|u| u.length == plain.len())
}

/// Compares the unit of a question with the dimension of its value.
pub(in crate::verify) fn answer_unit(text: Option<&str>, found: Option<Dimension>) -> AnswerUnit {
    let plain = text.map(super::table::rendered).unwrap_or_default();
    let Some(found) = found else { return AnswerUnit::Unknown };
    let Some(read) = units::read(&plain).filter(|u| u.length == plain.len()) else {
        // Names of counted things are arbitrary words: "bounces".
        let counted = plain.trim().is_empty() || found.is_number() || !found.is_exact();
        return if counted { AnswerUnit::Unknown } else { AnswerUnit::Unread(plain, written(&found)) };
    };
    // The symbol g of an acceleration is not the gram.
    if plain == "g" && !found.agrees(&Dimension::base(1)) {
        return AnswerUnit::Unknown;
    }
    if let Some(factor) = read.dimension.and_then(|expected| conversion(&expected, &found)) {
        return AnswerUnit::Equal(factor);
    }
    let unit = Unit { text: plain, dimension: read.dimension, link: Link::Shared };
    match hold(&unit, Some(&found)) {
        // A number literal that is a factor may have a dimension, so another dimension is possible, but not certain.
        UnitMatch::Fits if !read.dimension.is_some_and(|expected| found.agrees(&expected)) => {
            AnswerUnit::Unknown
        }
        UnitMatch::Fits => AnswerUnit::Equal(1.0),
        UnitMatch::Wrong | UnitMatch::Unsure => AnswerUnit::Wrong(unit.text, written(&found)),
        UnitMatch::Unknown => AnswerUnit::Unknown,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frequencies_and_angular_velocities_differ() {
        let unit =
            |text: &str| Unit { text: text.to_string(), dimension: units::parse(text), link: Link::Direct };
        let frequency = Dimension::base(3).power(-1.0).unwrap_or(Dimension::NUMBER);
        let angular = without_pure_factor(frequency.times(std::f64::consts::TAU));
        assert!(is_angular_rate(&angular) && angular.is_exact());
        for (text, found, fits) in [
            ("Hz", frequency, true),
            ("1/s", frequency, true),
            ("rpm", frequency, false),
            ("°/s", frequency, false),
            ("bpm", frequency, false),
            ("%", frequency, false),
            ("kg", frequency, false),
            ("rad/s", angular, true),
            ("1/s", angular, true),
            ("Hz", angular, false),
            ("kg", angular, false),
            ("rpm", angular, false),
        ] {
            assert_eq!(hold(&unit(text), Some(&found)) == UnitMatch::Fits, fits, "{text}");
        }
        // Half a mass is a mass, but three times a number of seconds may be a distance.
        let mass = Dimension::base(1);
        assert_eq!(hold(&unit("s"), Some(&without_pure_factor(mass.times(0.5)))), UnitMatch::Wrong);
        assert_eq!(hold(&unit("s"), Some(&without_pure_factor(mass.times(3.0)))), UnitMatch::Fits);
    }

    #[test]
    fn units_of_answers_are_converted_or_wrong() {
        let d = |text: &str| units::parse(text);
        let checked = |unit: &str, found: &str| answer_unit(Some(unit), d(found));
        for (unit, found, factor) in [
            ("s", "s", 1.0),
            ("ms", "s", 1000.0),
            ("min", "s", 1.0 / 60.0),
            ("h", "s", 1.0 / 3600.0),
            ("mm", "m", 1000.0),
            ("%", "1", 100.0),
        ] {
            let AnswerUnit::Equal(found) = checked(unit, found) else { panic!("{unit} {found}") };
            assert!((found / factor - 1.0).abs() < 1e-12, "{unit}: {found}");
        }
        for (unit, found) in
            [("kg", "s"), ("ms", "m"), ("m/s", "m"), ("dB", "s"), ("A", "s"), ("h", "m"), ("°C", "s")]
        {
            assert!(matches!(checked(unit, found), AnswerUnit::Wrong(..)), "{unit} {found}");
        }
        assert_eq!(answer_unit(Some("ms"), None), AnswerUnit::Unknown);
        assert_eq!(answer_unit(None, d("s")), AnswerUnit::Unknown);
        assert_eq!(checked("bounces", "1"), AnswerUnit::Unknown);
        for unit in ["bounces", "S", "blinks of an eye"] {
            assert!(matches!(checked(unit, "s"), AnswerUnit::Unread(..)), "{unit}");
        }
        assert!(matches!(checked("furlongs", "s"), AnswerUnit::Wrong(..)));
        // A number literal that is a factor may have a dimension, so the unit is not certain.
        for unit in ["m/s", "kg", "m", "N"] {
            assert_eq!(answer_unit(Some(unit), d("s").map(|s| s.times(9.81))), AnswerUnit::Unknown, "{unit}");
        }
        assert_eq!(answer_unit(Some("kg"), d("s").map(|s| s.times(1000.0))), AnswerUnit::Unknown);
        assert_eq!(answer_unit(Some("ms"), d("s").map(|s| s.times(1000.0))), AnswerUnit::Equal(1.0));
        // 180/π may be a speed in deg/s.
        let degrees = d("s").map(|s| s.times(1f64.to_degrees()));
        assert_eq!(answer_unit(Some("°"), degrees), AnswerUnit::Unknown);
        // The value is already in milliseconds.
        assert_eq!(answer_unit(Some("ms"), d("ms")), AnswerUnit::Equal(1.0));
        assert!(matches!(answer_unit(Some("s"), d("ms")), AnswerUnit::Wrong(..)));
    }
}
