//! The unit in the heading of a column.

use super::read::reading;
use super::unit_text::{Link, Unit};
use crate::bind::{behind_heading, of_heading};

/// The unit of a heading: of `error (mm)`, `t [ms]`, `x / mm`, `time in ms`, `depth, mm`, `t (10^-3 s)`.
pub(in crate::verify) fn unit_of_head(head: &str) -> Option<Unit> {
    let unit = |text: &str, dimension| {
        Some(Unit { text: text.to_string(), dimension: Some(dimension), link: Link::Shared })
    };
    if let Some((text, dimension)) = of_heading(head) {
        return unit(text, dimension);
    }
    // A power of ten of a unit: what stands in the cells is counted in that. `(10 s)` may be a time at which it was measured.
    let text = behind_heading(head)?;
    let read = reading(text).ok()?;
    let (size, of) = (read.number().value, read.unit()?.dimension?);
    let power = text.starts_with("10")
        && text.get(2..)?.trim_start().starts_with(['^', '*', '⁻', '²', '³', '⁴', '⁶', '⁹']);
    (power && size.is_finite() && size > 0.0).then(|| unit(text, of.times(1.0 / size))).flatten()
}
