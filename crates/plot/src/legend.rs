//! The legend: to the right of the plot if it fits there, otherwise in rows below it, but never inside the plot.

use super::canvas::{Canvas, drop, style};
use super::frame::{EDGE, Frame};
use super::style::{LABEL, TITLE_COLOUR};
use super::text::{clean_label, fit, width};

/// A curve in the legend.
pub(super) struct LegendEntry {
    /// Its name.
    pub(super) label: String,
    /// The index of the curve, which determines its colour and mark.
    pub(super) index: usize,
}

/// The width of the sample line of a curve, including the space after it.
const SAMPLE: f64 = 30.0;
/// The width of the sample line alone.
pub(super) const SAMPLE_WIDTH: f64 = 22.0;
/// The height of a row.
const ROW: f64 = 18.0;
/// The space between entries in a row.
const ENTRY_SPACING: f64 = 18.0;

/// The layout of the legend.
pub(super) struct LegendLayout {
    /// The width reserved to the right of the plot.
    pub(super) right: f64,
    /// The height reserved below the labels of the horizontal axis.
    pub(super) below: f64,
    /// The entries with their positions, relative to the corner of the area if at the right, otherwise to the edge
    /// below the rows of the axis.
    entries: Vec<(f64, f64, LegendEntry)>,
    /// The number of curves without an entry, and the position of this note.
    more: Option<(f64, f64, usize)>,
}

/// Plans the legend of a picture of width `size` whose plot has height `height`. `beside_plot` allows the right side.
pub(super) fn plan(entries: Vec<LegendEntry>, size: f64, height: f64, beside_plot: bool) -> LegendLayout {
    let entries: Vec<LegendEntry> = entries
        .into_iter()
        .map(|e| LegendEntry { label: clean_label(&e.label), ..e })
        .filter(|e| !e.label.is_empty())
        .collect();
    let widest = entries.iter().map(|e| width(&e.label, LABEL)).fold(0.0, f64::max);
    if entries.is_empty() {
        return LegendLayout { right: 0.0, below: 0.0, entries: Vec::new(), more: None };
    }
    if beside_plot && SAMPLE + widest <= 0.28 * size && entries.len() as f64 * ROW <= height {
        let placed = entries.into_iter().enumerate().map(|(i, e)| (16.0, i as f64 * ROW, e));
        return LegendLayout {
            right: 16.0 + SAMPLE + widest,
            below: 0.0,
            entries: placed.collect(),
            more: None,
        };
    }
    rows(entries, size, height)
}

fn rows(entries: Vec<LegendEntry>, size: f64, height: f64) -> LegendLayout {
    let available = size - 2.0 * EDGE;
    let most = (0.4 * height / ROW).floor().max(1.0);
    let mut plan = LegendLayout { right: 0.0, below: 0.0, entries: Vec::new(), more: None };
    let (mut x, mut row) = (0.0, 0.0);
    let count = entries.len();
    for (i, entry) in entries.into_iter().enumerate() {
        let label = fit(&entry.label, LABEL, available - SAMPLE);
        let wide = SAMPLE + width(&label, LABEL);
        // The last row reserves space for the note about the remaining curves, if there are any.
        let reserve = if row + 1.0 >= most && i + 1 < count { ENTRY_SPACING + 60.0 } else { 0.0 };
        if x > 0.0 && x + wide + reserve > available {
            if row + 1.0 >= most {
                plan.more = Some((x, row * ROW, count - i));
                break;
            }
            (x, row) = (0.0, row + 1.0);
        }
        plan.entries.push((x, row * ROW, LegendEntry { label, ..entry }));
        x += wide + ENTRY_SPACING;
    }
    plan.below = (row + 1.0) * ROW + 4.0;
    plan
}

/// Draws the legend. `below` is the height of the rows of the horizontal axis. `sample` draws the sample line of a curve,
/// from a point to the right.
pub(super) fn draw(
    canvas: &mut Canvas,
    plan: &LegendLayout,
    frame: &Frame,
    below: f64,
    sample: impl Fn(&mut Canvas, usize, (f64, f64)),
) {
    if plan.entries.is_empty() {
        return;
    }
    // Rows start at the left edge of the plot if they fit, which is usually the case.
    let widest = plan.entries.iter().map(|(x, _, e)| x + SAMPLE + width(&e.label, LABEL)).fold(0.0, f64::max);
    let left = if widest + 80.0 <= frame.right - frame.left { frame.left } else { EDGE };
    let corner = if plan.right > 0.0 {
        (frame.right, frame.top + ROW / 2.0)
    } else {
        (left, frame.bottom + below + ROW / 2.0)
    };
    for (x, y, entry) in &plan.entries {
        sample(canvas, entry.index, (corner.0 + x, corner.1 + y));
    }
    canvas.open(&style(LABEL, TITLE_COLOUR, "start"));
    for (x, y, entry) in &plan.entries {
        canvas.text((corner.0 + x + SAMPLE, corner.1 + y + drop(LABEL)), &entry.label);
    }
    if let Some((x, y, count)) = plan.more {
        canvas.text((corner.0 + x, corner.1 + y + drop(LABEL)), &format!("… {count} more"));
    }
    canvas.close();
}
