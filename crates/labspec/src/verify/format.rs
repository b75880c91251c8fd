//! Numbers and texts in messages.

/// A number with six significant digits, without trailing zeros.
pub fn significant(x: f64) -> String {
    if x == 0.0 || !x.is_finite() {
        return x.to_string();
    }
    let exponent = x.abs().log10().floor() as i32;
    if !(-4..=6).contains(&exponent) {
        return format!("{x:.5e}");
    }
    let text = labspec_expr::to_fixed(x, (5 - exponent).max(0) as usize);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_string() } else { text }
}

/// The first 48 characters of a text, for messages.
pub(super) fn shorten(text: &str) -> String {
    let short: String = text.chars().take(48).collect();
    if short.len() < text.len() { format!("{short}…") } else { short }
}
