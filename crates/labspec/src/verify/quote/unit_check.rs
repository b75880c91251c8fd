//! Whether the unit of a text is that of the numbers that an expression gives, and how these become numbers in that unit.

use super::unit_text::{Link, Unit};
use crate::bind::contradicts;
use labspec_bind::units;
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
    match unit.link == Link::Clause || unit.is_doubtful() && unit.link == Link::Own && !found.agrees(wanted) {
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
