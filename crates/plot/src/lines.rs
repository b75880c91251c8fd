//! Lines over time: the plots of a lab.

use super::axis::{Axis, AxisRange, linear, range};
use super::canvas::{Canvas, drop, style};
use super::curve::{path, pieces};
use super::frame::{self, EDGE, Frame, PlotTexts, Point, draw, margin};
use super::legend::{self, LegendEntry, SAMPLE_WIDTH};
use super::number::{drawable, short};
use super::style::{AXIS, SMALL, TICK, TITLE_COLOUR, ZERO, colour, dash, extent};
use super::text::{clean_label, fit, width};

/// A curve.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Series {
    /// The name in the legend; a curve without a name has no entry.
    pub label: String,
    /// Whether the curve is dashed.
    pub dash: bool,
    /// Samples (x, y) in the units of the axes, in the order of x. A sample that is not finite breaks the line, and so
    /// does a step backwards in x.
    pub points: Vec<(f64, f64)>,
}

/// A plot of curves over time, or over another increasing quantity.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Chart {
    /// The title above the plot; may be empty.
    pub title: String,
    /// The name and the unit of the horizontal axis.
    pub xlabel: String,
    /// The name and the unit of the vertical axis.
    pub ylabel: String,
    /// The width of the whole picture, pixels.
    pub width: f64,
    /// The height of the whole picture including the legend, pixels; at least 160.
    pub height: f64,
    /// The lower end of the vertical axis; `None` uses the data.
    pub ymin: Option<f64>,
    /// The upper end of the vertical axis; `None` uses the data.
    pub ymax: Option<f64>,
    /// The left end of the horizontal axis; `None` uses the data.
    pub xmin: Option<f64>,
    /// The right end of the horizontal axis; `None` uses the data.
    pub xmax: Option<f64>,
    /// Horizontal reference lines: the value on the vertical axis, and the label.
    pub ref_lines: Vec<(f64, Option<String>)>,
    /// The curves.
    pub series: Vec<Series>,
}

/// Draws a plot of lines as a complete SVG document.
///
/// Any data give a picture: empty, reversed or non-finite ranges are replaced by those of the data, and a picture without data
/// states that. If there are many samples per pixel, the extreme ones are kept, so that the size of the result depends on the
/// width of the picture and not on the number of samples.
pub fn line_chart(chart: &Chart) -> String {
    let size = (extent(chart.width, 200.0, 640.0), extent(chart.height, 160.0, 320.0));
    let words =
        PlotTexts { title: &chart.title, xlabel: &chart.xlabel, ylabel: &chart.ylabel, width: size.0 };
    let (xs, ys) = ranges(chart);

    let refs: Vec<(f64, String)> = chart
        .ref_lines
        .iter()
        .filter(|(y, _)| drawable(*y) && (ys.free_low || *y >= ys.low) && (ys.free_high || *y <= ys.high))
        .map(|(y, label)| (*y, fit(&clean_label(label.as_deref().unwrap_or("")), SMALL, 0.24 * size.0)))
        .collect();
    let label_width = refs.iter().map(|(_, label)| width(label, SMALL)).fold(0.0, f64::max);

    let (top, below) = (words.above(), words.below());
    let entries =
        chart.series.iter().enumerate().map(|(index, s)| LegendEntry { label: s.label.clone(), index });
    let legend = legend::plan(entries.collect(), size.0, size.1 - top - below, label_width == 0.0);
    let bottom = (size.1 - below - legend.below).max(top + 20.0);
    let y = linear(ys, steps(bottom - top, 34.0).max(2), 1.0);
    let left = margin(&y);
    let beside = if label_width > 0.0 { label_width + 8.0 } else { legend.right };
    let (right, x) = horizontal(xs, left, size.0 - EDGE - beside, beside == 0.0);
    let frame = Frame { left, top, right, bottom };

    let named = if words.title.trim().is_empty() { words.ylabel } else { words.title };
    let mut canvas =
        Canvas::new(size, if named.trim().is_empty() { "Plot" } else { named }, &describe(chart));
    draw(&mut canvas, &frame, &frame, &x, &y, &words);
    if let Some(zero) = y.fraction(0.0).filter(|fraction| *fraction > 0.001 && *fraction < 0.999) {
        let height = frame.at(0.0, zero).1.floor() + 0.5;
        canvas.open(&format!("stroke=\"{ZERO}\""));
        canvas.line((frame.left, height), (frame.right, height));
        canvas.close();
    }
    references(&mut canvas, &refs, &frame, &y);
    let found = curves(&mut canvas, &chart.series, &frame, &x, &y);
    if !found {
        frame::empty(&mut canvas, &frame, empty_text(chart));
    }
    legend::draw(&mut canvas, &legend, &frame, below, |canvas, index, start| {
        let dashed = chart.series.get(index).is_some_and(|s| s.dash);
        canvas.open(&stroke(index, dashed));
        canvas.line(start, (start.0 + SAMPLE_WIDTH, start.1));
        canvas.close();
    });
    canvas.finish()
}

/// The ranges of both axes. Only samples inside a requested horizontal range are considered for the vertical one.
fn ranges(chart: &Chart) -> (AxisRange, AxisRange) {
    let samples = || chart.series.iter().flat_map(|s| &s.points).filter(|p| drawable(p.0) && drawable(p.1));
    let x = range(extremes(samples().map(|p| p.0)), chart.xmin, chart.xmax);
    let inside = |p: &&(f64, f64)| (x.free_low || p.0 >= x.low) && (x.free_high || p.0 <= x.high);
    let refs = chart.ref_lines.iter().map(|r| r.0).filter(|y| drawable(*y));
    let y = range(extremes(samples().filter(inside).map(|p| p.1).chain(refs)), chart.ymin, chart.ymax);
    (x, y)
}

fn extremes(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    values.fold(None, |found: Option<(f64, f64)>, v| {
        Some(found.map_or((v, v), |(low, high)| (low.min(v), high.max(v))))
    })
}

/// The number of steps of an axis of some length, for steps of at least `least` pixels.
fn steps(length: f64, least: f64) -> usize {
    (length / least).clamp(1.0, 10.0) as usize
}

/// The horizontal axis with as many ticks as there is space for labels, and the right end of the plot. If nothing else is to
/// the right of the plot, the end leaves space for half of the last label.
fn horizontal(range: AxisRange, left: f64, limit: f64, alone: bool) -> (f64, Axis) {
    let build = |count: usize| {
        let x = linear(range, count, 0.02);
        let last = x.ticks.last().filter(|t| t.fraction > 0.9).map_or(0.0, |t| t.label.width(TICK) / 2.0);
        let right = if alone { limit - (last - EDGE / 2.0).max(4.0) } else { limit - 4.0 };
        (right.max(left + 40.0), x)
    };
    let most = steps(limit - left, 60.0);
    let fits = |(right, x): &(f64, Axis)| x.spacing() * (right - left) >= x.widest(TICK) + 14.0;
    (1..=most).rev().map(build).find(fits).unwrap_or_else(|| build(1))
}

/// Attributes of a curve.
fn stroke(index: usize, dashed: bool) -> String {
    let colour = colour(index);
    let pattern = dash(index, dashed).map(|d| format!(" stroke-dasharray=\"{d}\"")).unwrap_or_default();
    let cap = if pattern.is_empty() { " stroke-linecap=\"round\"" } else { "" };
    format!("fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.75\" stroke-linejoin=\"round\"{cap}{pattern}")
}

/// Draws the curves, solid ones first, so that a dashed prediction stays visible on top of the predicted curve. Returns `false`
/// if there is nothing to draw.
fn curves(canvas: &mut Canvas, series: &[Series], frame: &Frame, x: &Axis, y: &Axis) -> bool {
    let place = |(sx, sy): (f64, f64)| -> Option<Point> {
        let finite = drawable(sx) && drawable(sy);
        finite.then_some(frame.at(x.fraction(sx)?, y.fraction(sy)?))
    };
    let mut order: Vec<(usize, &Series)> = series.iter().enumerate().collect();
    order.sort_by_key(|(_, s)| s.dash);
    let mut found = false;
    for (index, series) in order {
        let pieces = pieces(&series.points, frame, place);
        let data = path(&pieces);
        let dots: Vec<Point> =
            pieces.iter().filter(|p| p.len() == 1).filter_map(|p| p.first().copied()).collect();
        if data.is_empty() && dots.is_empty() {
            continue;
        }
        found = true;
        canvas.named(&stroke(index, series.dash), &series.label);
        if !data.is_empty() {
            canvas.path(&data);
        }
        for dot in dots {
            canvas.disc(dot, 2.5, colour(index));
        }
        canvas.close();
    }
    found
}

/// Draws the horizontal reference lines, with their labels to the right of the plot, where no curve is.
fn references(canvas: &mut Canvas, refs: &[(f64, String)], frame: &Frame, y: &Axis) {
    let mut seen: Vec<(f64, &str)> = refs
        .iter()
        .filter_map(|(value, label)| Some((y.fraction(*value)?, label.as_str())))
        .filter(|(fraction, _)| (0.0..=1.0).contains(fraction))
        .map(|(fraction, label)| (frame.at(0.0, fraction).1, label))
        .collect();
    if seen.is_empty() {
        return;
    }
    canvas.open(&format!("stroke=\"{AXIS}\" stroke-dasharray=\"4 3\""));
    for (height, _) in &seen {
        canvas.line((frame.left, *height), (frame.right, *height));
    }
    canvas.close();
    seen.retain(|(_, label)| !label.is_empty());
    seen.sort_by(|a, b| a.0.total_cmp(&b.0));
    seen.truncate((frame.height() / (SMALL + 2.0)).max(1.0) as usize);
    canvas.open(&style(SMALL, TITLE_COLOUR, "start"));
    for (height, (_, label)) in
        separated_heights(&seen.iter().map(|s| s.0).collect::<Vec<_>>(), frame).into_iter().zip(&seen)
    {
        canvas.text((frame.right + 6.0, height + drop(SMALL)), label);
    }
    canvas.close();
}

/// Heights in ascending order, moved apart so that lines of text do not touch: downwards from the first one, and back upwards
/// from the last one if it left the frame.
fn separated_heights(heights: &[f64], frame: &Frame) -> Vec<f64> {
    let row = SMALL + 2.0;
    let mut least = f64::NEG_INFINITY;
    let mut moved: Vec<f64> = Vec::with_capacity(heights.len());
    for height in heights {
        let height = height.max(least);
        moved.push(height);
        least = height + row;
    }
    let mut most = frame.bottom;
    for height in moved.iter_mut().rev() {
        *height = height.min(most);
        most = *height - row;
    }
    moved
}

fn empty_text(chart: &Chart) -> &'static str {
    let mut samples = chart.series.iter().flat_map(|s| &s.points);
    if chart.series.iter().all(|s| s.points.is_empty()) {
        "no data"
    } else if samples.any(|p| drawable(p.0) && drawable(p.1)) {
        "no data in this range"
    } else {
        "no finite values"
    }
}

/// The description of the picture in words.
fn describe(chart: &Chart) -> String {
    let (x, y) = (clean_label(&chart.xlabel), clean_label(&chart.ylabel));
    let over = if x.is_empty() { String::new() } else { format!(" over {x}") };
    let what = if y.is_empty() { String::from("Lines") } else { format!("Lines of {y}") };
    let mut text = format!("{what}{over}.");
    // A description of every curve would be too long for a listener.
    for series in chart.series.iter().take(12) {
        let values = || series.points.iter().filter(|p| drawable(p.0) && drawable(p.1));
        let label = clean_label(&series.label);
        let label = if label.is_empty() { "Unnamed" } else { &label };
        let Some((low, high)) = extremes(values().map(|p| p.1)) else {
            text.push_str(&format!(" {label}: no finite values."));
            continue;
        };
        let last = values().next_back().map_or(low, |p| p.1);
        text.push_str(&format!(" {label}: {} to {}, last {}.", short(low), short(high), short(last)));
    }
    text
}
