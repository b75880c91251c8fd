//! Numbers of a text in SI units.

use labspec::verify::Stated;
use labspec_expr::dimension::Dimension;

/// The longest timestep that anybody means, s.
pub(super) const LONGEST_TIMESTEP: f64 = 0.05;

/// A number in SI units.
pub(crate) fn si(s: &Stated) -> f64 {
    round(s.read.value / s.dimension.factor)
}

/// A second.
pub(super) fn second() -> Dimension {
    labspec_bind::units::parse("s").unwrap_or(Dimension::NUMBER)
}

/// A number without the last bits, which a conversion may change.
pub(super) fn round(x: f64) -> f64 {
    format!("{x:.12e}").parse().unwrap_or(x)
}
