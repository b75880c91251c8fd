//! The area of a plot: its grid, axes, ticks and labels.

use super::axis::Axis;
use super::canvas::{Canvas, Label, drop, style};
use super::style::{AXIS, GRID, LABEL, LABEL_COLOUR, MINOR_GRID_COLOUR, TICK, TITLE, TITLE_COLOUR};
use super::text::{clean_label, fit, width};

/// A position in a picture, in pixels.
pub(super) type Point = (f64, f64);

/// A rectangle in pixels; y grows downwards, so `top` is less than `bottom`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    pub(super) left: f64,
    pub(super) top: f64,
    pub(super) right: f64,
    pub(super) bottom: f64,
}

impl Frame {
    /// Whether a point is inside or on the edge.
    pub(super) fn holds(&self, point: Point) -> bool {
        (self.left..=self.right).contains(&point.0) && (self.top..=self.bottom).contains(&point.1)
    }

    /// Whether two rectangles overlap.
    pub(super) fn overlaps(&self, other: &Frame) -> bool {
        self.left < other.right
            && other.left < self.right
            && self.top < other.bottom
            && other.top < self.bottom
    }

    /// The position for fractions along both axes.
    pub(super) fn at(&self, x: f64, y: f64) -> Point {
        (self.left + x * (self.right - self.left), self.bottom - y * (self.bottom - self.top))
    }

    /// The width.
    pub(super) fn width(&self) -> f64 {
        self.right - self.left
    }

    /// The height.
    pub(super) fn height(&self) -> f64 {
        self.bottom - self.top
    }
}

/// The title and labels of a plot.
pub(super) struct PlotTexts<'a> {
    pub(super) title: &'a str,
    pub(super) xlabel: &'a str,
    pub(super) ylabel: &'a str,
    /// The width of the whole picture: text above a plot may be wider than the plot.
    pub(super) width: f64,
}

/// The margin inside the edge of a picture.
pub(super) const EDGE: f64 = 12.0;
/// The space between an axis and the labels of its ticks.
const TO_TICK: f64 = 8.0;

impl PlotTexts<'_> {
    /// The height of the rows above the area: the title, the label of the vertical axis, and half a tick label.
    pub(super) fn above(&self) -> f64 {
        let title = if self.title.trim().is_empty() { 0.0 } else { 22.0 };
        EDGE + title + 18.0
    }

    /// The height of the rows below the area: the labels of ticks and of the horizontal axis.
    pub(super) fn below(&self) -> f64 {
        let label = if self.xlabel.trim().is_empty() { 0.0 } else { 18.0 };
        20.0 + label + 6.0
    }
}

/// The width of the tick labels of the vertical axis, to the left of the area.
pub(super) fn margin(y: &Axis) -> f64 {
    EDGE + y.widest(TICK) + TO_TICK
}

/// Draws everything except the data. The scales extend over `inner`. The horizontal lines and the border extend over `outer`,
/// which is wider than `inner` if there are strips next to the scale.
pub(super) fn draw(canvas: &mut Canvas, outer: &Frame, inner: &Frame, x: &Axis, y: &Axis, words: &PlotTexts) {
    let across = |fraction: f64| snap(inner.at(0.0, fraction).1);
    let along = |fraction: f64| snap(inner.at(fraction, 0.0).0);

    canvas.open(&format!("stroke=\"{MINOR_GRID_COLOUR}\""));
    for fraction in &y.minor {
        canvas.line((outer.left, across(*fraction)), (outer.right, across(*fraction)));
    }
    for fraction in &x.minor {
        canvas.line((along(*fraction), outer.top), (along(*fraction), outer.bottom));
    }
    canvas.close();
    canvas.open(&format!("stroke=\"{GRID}\""));
    for tick in &y.ticks {
        canvas.line((outer.left, across(tick.fraction)), (outer.right, across(tick.fraction)));
    }
    for tick in &x.ticks {
        canvas.line((along(tick.fraction), outer.top), (along(tick.fraction), outer.bottom));
    }
    canvas.close();

    canvas.open(&format!("stroke=\"{AXIS}\""));
    canvas.line((snap(outer.left), outer.top), (snap(outer.left), outer.bottom));
    canvas.line((outer.left, snap(outer.bottom)), (outer.right, snap(outer.bottom)));
    for tick in &y.ticks {
        canvas.line((outer.left - 4.0, across(tick.fraction)), (outer.left, across(tick.fraction)));
    }
    for tick in &x.ticks {
        canvas.line((along(tick.fraction), outer.bottom), (along(tick.fraction), outer.bottom + 4.0));
    }
    canvas.close();

    canvas.open(&style(TICK, LABEL_COLOUR, "end"));
    for tick in &y.ticks {
        canvas.label((outer.left - TO_TICK, inner.at(0.0, tick.fraction).1 + drop(TICK)), &tick.label);
    }
    canvas.close();
    canvas.open(&style(TICK, LABEL_COLOUR, "middle"));
    for tick in x.ticks.iter().filter(|t| t.label != Label::default()) {
        canvas.label((inner.at(tick.fraction, 0.0).0, outer.bottom + 17.0), &tick.label);
    }
    canvas.close();
    label(canvas, outer, x, y, words);
}

/// Draws the title, the label of the vertical axis, which is horizontal and above the axis so that it is easy to read, and the
/// label of the horizontal axis below it.
fn label(canvas: &mut Canvas, outer: &Frame, x: &Axis, y: &Axis, words: &PlotTexts) {
    let end = words.width - EDGE;
    // Bold glyphs are wider by about this factor.
    let title = fit(&clean_label(words.title), TITLE, (end - outer.left) / 1.08);
    if !title.is_empty() {
        canvas.open(&format!("{} font-weight=\"bold\"", style(TITLE, TITLE_COLOUR, "start")));
        canvas.text((outer.left, EDGE + TITLE - 2.0), &title);
        canvas.close();
    }
    let note_width = y.note.as_ref().map_or(0.0, |note| EDGE + note.width(TICK) + 10.0);
    let start = outer.left.max(note_width);
    let row = outer.top - 11.0;
    canvas.open(&style(LABEL, TITLE_COLOUR, "start"));
    let ylabel = fit(&clean_label(words.ylabel), LABEL, end - start);
    if !ylabel.is_empty() {
        canvas.text((start, row), &ylabel);
    }
    canvas.close();
    if let Some(note) = &y.note {
        shared(canvas, note, (EDGE, row), "start");
    }

    let (row, available) = (outer.bottom + 35.0, outer.width());
    let note_width = x.note.as_ref().map_or(0.0, |note| note.width(TICK) + 10.0);
    let xlabel = fit(&clean_label(words.xlabel), LABEL, (available - note_width).max(available / 2.0));
    if !xlabel.is_empty() {
        let wish = outer.left + available / 2.0;
        let most = outer.right - note_width - width(&xlabel, LABEL) / 2.0;
        canvas.open(&style(LABEL, TITLE_COLOUR, "middle"));
        canvas.text((wish.min(most), row), &xlabel);
        canvas.close();
    }
    if let Some(note) = &x.note {
        shared(canvas, note, (outer.right, row), "end");
    }
}

/// Draws the part that all tick labels share.
fn shared(canvas: &mut Canvas, note: &Label, position: Point, anchor: &str) {
    canvas.open(&style(TICK, LABEL_COLOUR, anchor));
    canvas.label(position, note);
    canvas.close();
}

/// Writes the reason why nothing is drawn in the middle of the plot.
pub(super) fn empty(canvas: &mut Canvas, frame: &Frame, why: &str) {
    let (x, y) = frame.at(0.5, 0.5);
    let half = width(why, LABEL) / 2.0 + 6.0;
    canvas.area((x - half, y - LABEL), (x + half, y + LABEL), "#ffffff");
    canvas.open(&style(LABEL, LABEL_COLOUR, "middle"));
    canvas.text((x, y + drop(LABEL)), why);
    canvas.close();
}

/// The middle of a pixel, where a line with a width of one pixel is sharp.
fn snap(coordinate: f64) -> f64 {
    coordinate.floor() + 0.5
}
