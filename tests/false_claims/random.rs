//! Numbers as printed in a lesson.

/// A number with three significant digits, and its number of decimals. `None` if it is not finite, or too large or too small to
/// be printed without an exponent.
pub(super) fn printed(x: f64) -> Option<(String, usize)> {
    if !x.is_finite() || x.abs() < 2e-3 || x.abs() >= 1e4 {
        return None;
    }
    let decimals = (2 - x.abs().log10().floor() as i32).clamp(1, 6) as usize;
    Some((format!("{x:.decimals$}"), decimals))
}
