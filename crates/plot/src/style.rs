//! Colours, line patterns and sizes.
//!
//! The colours of the data are those of Okabe and Ito ("Color Universal Design", 2008), which people with all common types of
//! colour vision can distinguish. Their yellow is not used, because it is invisible on white.

/// The colours of curves, in the order of their use.
const PALETTE: [&str; 7] = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000"];
/// The dash patterns (pixels drawn, skipped, …) of curves that are not dashed, one for each cycle through the colours.
const SOLID: [Option<&str>; 3] = [None, Some("10 3 2 3"), Some("2 3")];
/// The dash patterns of dashed curves.
const DASHED: [Option<&str>; 3] = [Some("6 4"), Some("12 5"), Some("4 2")];

/// Titles and axis labels.
pub(super) const TITLE_COLOUR: &str = "#222222";
/// Labels of ticks and points.
pub(super) const LABEL_COLOUR: &str = "#4d4d4d";
/// Axes.
pub(super) const AXIS: &str = "#7f7f7f";
/// The grid line at zero.
pub(super) const ZERO: &str = "#b5b5b5";
/// Grid lines at ticks.
pub(super) const GRID: &str = "#e3e3e3";
/// Grid lines between ticks.
pub(super) const MINOR_GRID_COLOUR: &str = "#f2f2f2";
/// Areas next to a scale.
pub(super) const SHADE_COLOUR: &str = "#f6f6f6";

/// Font size of the title, in pixels.
pub(super) const TITLE: f64 = 14.0;
/// Font size of axis labels and legends, in pixels.
pub(super) const LABEL: f64 = 12.0;
/// Font size of ticks, in pixels.
pub(super) const TICK: f64 = 11.0;
/// Font size of the superscript of a tick label, in pixels.
pub(super) const POWER: f64 = 8.5;
/// Font size of labels of points and lines, in pixels.
pub(super) const SMALL: f64 = 10.0;

/// The colour of the curve with this index.
pub(super) fn colour(index: usize) -> &'static str {
    PALETTE.get(index % PALETTE.len()).copied().unwrap_or(TITLE_COLOUR)
}

/// The dash pattern of the curve with this index; `None` is a solid line. Each further cycle through the colours uses another
/// pattern, so that 21 curves of each kind differ.
pub(super) fn dash(index: usize, dashed: bool) -> Option<&'static str> {
    let patterns = if dashed { DASHED } else { SOLID };
    patterns.get(index / PALETTE.len() % patterns.len()).copied().flatten()
}

/// The width or height of a picture in pixels: the requested value within limits, or the default if it is not finite.
pub(super) fn extent(wish: f64, least: f64, default: f64) -> f64 {
    if wish.is_finite() { wish.clamp(least, 4000.0).round() } else { default }
}
