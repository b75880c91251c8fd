//! Conversion of numbers in a text to SI units.

use labspec::verify::Stated;
use labspec_expr::dimension::Dimension;

/// The longest plausible timestep, s.
pub(super) const LONGEST_TIMESTEP: f64 = 0.05;

/// A number in SI units.
pub(crate) fn si(s: &Stated) -> f64 {
    round(s.read.value / s.dimension.factor)
}

/// The dimension of a second.
pub(super) fn second() -> Dimension {
    labspec_bind::units::parse("s").unwrap_or(Dimension::NUMBER)
}

/// A number rounded to 13 significant digits, which removes the rounding error of a conversion.
pub(super) fn round(x: f64) -> f64 {
    format!("{x:.12e}").parse().unwrap_or(x)
}
