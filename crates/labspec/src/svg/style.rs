//! Colours, line patterns and sizes.
//!
//! Colours of the data are those of Okabe and Ito ("Color Universal Design", 2008), which people with any common
//! colour vision can tell apart; their yellow is left out, as it cannot be seen on white.

/// Colours of curves, in the order in which they are given out.
const PALETTE: [&str; 7] = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000"];
/// Patterns of dashes, in pixels: drawn, left out, …
const DASHES: [&str; 3] = ["6 4", "10 3 2 3", "2 3"];

/// Titles and labels of axes.
pub(super) const INK: &str = "#222222";
/// Labels of ticks and of points.
pub(super) const SOFT: &str = "#4d4d4d";
/// Lines of axes.
pub(super) const AXIS: &str = "#7f7f7f";
/// Lines of the grid at ticks.
pub(super) const GRID: &str = "#e3e3e3";
/// Lines of the grid between ticks.
pub(super) const FAINT: &str = "#f2f2f2";
/// Areas beside a scale.
pub(super) const SHADE: &str = "#f6f6f6";

/// Font size of the title, in pixels.
pub(super) const TITLE: f64 = 14.0;
/// Font size of axis labels and legends, in pixels.
pub(super) const LABEL: f64 = 12.0;
/// Font size of ticks, in pixels.
pub(super) const TICK: f64 = 11.0;
/// Font size of labels at points and lines, in pixels.
pub(super) const SMALL: f64 = 10.0;

/// The colour of the curve with this index.
pub(super) fn colour(index: usize) -> &'static str {
    PALETTE.get(index % PALETTE.len()).copied().unwrap_or(INK)
}

/// The dash pattern of the curve with this index; `None` is a solid line. Once all colours are given out, the next
/// round has another pattern, so that up to 28 curves differ.
pub(super) fn dash(index: usize, dashed: bool) -> Option<&'static str> {
    let round = index / PALETTE.len();
    let pattern = round + usize::from(dashed);
    pattern.checked_sub(1).and_then(|p| DASHES.get(p % DASHES.len())).copied()
}

/// A whole picture's width or height in pixels: the wish, if it is a number, within reason.
pub(super) fn extent(wish: f64, least: f64, default: f64) -> f64 {
    if wish.is_finite() { wish.clamp(least, 4000.0).round() } else { default }
}
