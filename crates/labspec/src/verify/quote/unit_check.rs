//! Whether the unit of a text, or of a numeric question, is that of the numbers that an expression gives, and how these become numbers
//! in that unit.

use super::unit_text::{Link, Unit};
use crate::bind::contradicts;
use labspec_bind::units::{self, written};
use labspec_expr::dimension::Dimension;

/// What a unit is to what an expression measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::verify) enum Held {
    /// It is the unit of these numbers, or they can be converted to it.
    Fits,
    /// It is another one for sure.
    Wrong,
    /// It may be a symbol of a formula: `2 h` are two hours, or two timesteps.
    Unsure,
    /// What the expression measures, or what the unit is, is not known.
    Unknown,
}

/// Holds a unit to what an expression measures.
pub(in crate::verify) fn hold(unit: &Unit, found: Option<&Dimension>) -> Held {
    let Some(found) = found else { return Held::Unknown };
    let wrong = if unit.link == Link::Clause { Held::Unsure } else { Held::Wrong };
    let Some(wanted) = &unit.dimension else {
        let other = units::is_unit(&unit.text);
        let certain = found.is_exact() && !found.is_number();
        return if other && certain { wrong } else { Held::Unknown };
    };
    // A radian may be left out, and is no other power of a radian.
    let angle = wanted.angle();
    if found.is_exact() && found.has_angle() && angle != found.angle() && !(0.0..=1.0).contains(&angle) {
        return wrong;
    }
    // A radian may be left out, and is nothing that is counted.
    if unit.is_counted() && found.is_exact() && found.has_angle() {
        return wrong;
    }
    // A turn is not a radian.
    let turns = unit.text.contains("Hz") && found.is_exact() && found.has_angle() && found.agrees(wanted);
    if !contradicts(found, wanted) && !turns {
        return Held::Fits;
    }
    match unit.link == Link::Clause
        || unit.is_doubtful() && unit.link == Link::Direct && !found.agrees(wanted)
    {
        true => Held::Unsure,
        false => Held::Wrong,
    }
}

/// What numbers of an expression are multiplied with to be numbers in a unit, where that is certain.
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

/// What the unit of a question is to the numbers of its `value`.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::verify) enum AnswerUnit {
    /// It is theirs, once they are multiplied with this: 1, or 1000 where the question asks for millimetres and the value is in metres.
    Equal(f64),
    /// It is another one: the unit of the question, and what the value is in.
    Wrong(String, String),
    /// It is none that is known, and the value has one: what stands there, and what the value is in.
    Unread(String, String),
    /// What the value measures is not certain, or there is no unit: the numbers are compared as they are.
    Unknown,
}

impl AnswerUnit {
    /// What the numbers of the value are multiplied with.
    pub(in crate::verify) fn factor(&self) -> f64 {
        match self {
            AnswerUnit::Equal(factor) => *factor,
            AnswerUnit::Wrong(..) | AnswerUnit::Unread(..) | AnswerUnit::Unknown => 1.0,
        }
    }
}

/// Whether a text is a unit that is known.
pub(in crate::verify) fn is_unit(text: &str) -> bool {
    let plain = super::table::rendered(text);
    !plain.is_empty() && units::read(&plain).is_some_and(|u| u.length == plain.len())
}

/// Holds the unit of a question to what its value measures.
pub(in crate::verify) fn answer_unit(text: Option<&str>, found: Option<Dimension>) -> AnswerUnit {
    let plain = text.map(super::table::rendered).unwrap_or_default();
    let Some(found) = found else { return AnswerUnit::Unknown };
    let Some(read) = units::read(&plain).filter(|u| u.length == plain.len()) else {
        // What is counted has names of any kind: "bounces".
        let counted = plain.trim().is_empty() || found.is_number() || !found.is_exact();
        return if counted { AnswerUnit::Unknown } else { AnswerUnit::Unread(plain, written(&found)) };
    };
    // The g of an acceleration is none of a mass.
    if plain == "g" && !found.agrees(&Dimension::base(1)) {
        return AnswerUnit::Unknown;
    }
    if let Some(factor) = read.dimension.and_then(|wanted| conversion(&wanted, &found)) {
        return AnswerUnit::Equal(factor);
    }
    let unit = Unit { text: plain, dimension: read.dimension, link: Link::Shared };
    match hold(&unit, Some(&found)) {
        Held::Fits => AnswerUnit::Equal(1.0),
        Held::Wrong | Held::Unsure => AnswerUnit::Wrong(unit.text, written(&found)),
        Held::Unknown => AnswerUnit::Unknown,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_of_answers_are_converted_or_wrong() {
        let d = |text: &str| units::parse(text);
        let of = |unit: &str, found: &str| answer_unit(Some(unit), d(found));
        for (unit, found, factor) in [
            ("s", "s", 1.0),
            ("ms", "s", 1000.0),
            ("min", "s", 1.0 / 60.0),
            ("h", "s", 1.0 / 3600.0),
            ("mm", "m", 1000.0),
            ("%", "1", 100.0),
        ] {
            let AnswerUnit::Equal(found) = of(unit, found) else { panic!("{unit} {found}") };
            assert!((found / factor - 1.0).abs() < 1e-12, "{unit}: {found}");
        }
        for (unit, found) in
            [("kg", "s"), ("ms", "m"), ("m/s", "m"), ("dB", "s"), ("A", "s"), ("h", "m"), ("°C", "s")]
        {
            assert!(matches!(of(unit, found), AnswerUnit::Wrong(..)), "{unit} {found}");
        }
        assert_eq!(answer_unit(Some("ms"), None), AnswerUnit::Unknown);
        assert_eq!(answer_unit(None, d("s")), AnswerUnit::Unknown);
        assert_eq!(of("bounces", "1"), AnswerUnit::Unknown);
        for unit in ["bounces", "S", "blinks of an eye"] {
            assert!(matches!(of(unit, "s"), AnswerUnit::Unread(..)), "{unit}");
        }
        assert!(matches!(of("furlongs", "s"), AnswerUnit::Wrong(..)));
        // A number of the text that is a factor may have a unit of its own.
        assert_eq!(answer_unit(Some("m/s"), d("s").map(|s| s.times(9.81))), AnswerUnit::Equal(1.0));
        // In milliseconds already.
        assert_eq!(answer_unit(Some("ms"), d("ms")), AnswerUnit::Equal(1.0));
        assert!(matches!(answer_unit(Some("s"), d("ms")), AnswerUnit::Wrong(..)));
    }
}
