//! Work–precision chart: the cost of accuracy.
//!
//! Error is on the horizontal axis, cost on the vertical axis, both logarithmic, with one curve per method over its timesteps
//! (as in Hairer, Nørsett, Wanner, "Solving Ordinary Differential Equations I", II.4). Lower and further left is better. A
//! method of order p appears as a straight line of slope -1/p. A logarithmic axis has no position for some runs: those without
//! a finite error are drawn in a separate strip at the right end, and those without any error in one at the left end. A
//! vertical bar shows the spread of a cost. An arrow to the left shows that the error is at most the drawn value.

use super::axis::{Axis, logarithmic};
use super::canvas::{Canvas, Label, style};
use super::curve::path;
use super::frame::{self, EDGE, Frame, PlotTexts, Point, draw, margin};
use super::labels::{PlacedLabel, arrange};
use super::legend::{self, LegendEntry, SAMPLE_WIDTH};
use super::number::{HUGE, px, short};
use super::style::{LABEL_COLOUR, SHADE_COLOUR, SMALL, TICK, colour, dash, extent};
use super::text::{clean_label, fit, width};

/// A curve: a method over its timesteps.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Method {
    /// The name in the legend.
    pub label: String,
    /// The runs in the order of the timestep.
    pub points: Vec<MethodPoint>,
    /// If set, this is another program's version of the method at this index, drawn in the same colour and
    /// shape, but hollow and dashed.
    pub echo: Option<usize>,
}

/// The style of a method.
#[derive(Clone, Copy)]
struct MarkerStyle {
    index: usize,
    hollow: bool,
}

impl MarkerStyle {
    fn of_method(index: usize, method: &Method) -> MarkerStyle {
        MarkerStyle { index: method.echo.unwrap_or(index), hollow: method.echo.is_some() }
    }
}

/// A run of a method.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MethodPoint {
    /// The cost in the unit of the vertical axis. A run without a positive finite cost is left out.
    pub cost: f64,
    /// The error in the unit of the horizontal axis; its sign is ignored.
    pub error: f64,
    /// The text next to the point, such as `2 ms`.
    pub note: String,
    /// Whether it diverged; `error` is then ignored.
    pub failed: bool,
    /// Whether the error is at most `error`, and nothing more is known about it.
    pub at_most: bool,
    /// The ends of a vertical bar for the spread of the cost.
    pub spread: Option<[f64; 2]>,
}

/// Cost against error for several methods.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WorkPrecision {
    /// The title above the plot; may be empty.
    pub title: String,
    /// The meaning of the error, with its unit.
    pub xlabel: String,
    /// The meaning of the cost, with its unit.
    pub ylabel: String,
    /// The curves.
    pub methods: Vec<Method>,
    /// The width of the whole picture, pixels.
    pub width: f64,
    /// The height of the whole picture including the legend, pixels; at least 160.
    pub height: f64,
}

/// The position of a run along the horizontal axis.
#[derive(Clone, Copy, PartialEq)]
enum DrawnError {
    Zero,
    Finite(f64),
    Diverged,
}

/// A run that can be drawn.
struct DrawnRun<'a> {
    error: DrawnError,
    cost: f64,
    note: &'a str,
    at_most: bool,
    spread: Option<[f64; 2]>,
}

/// The smallest positive value that is distinguished from zero.
const TINY: f64 = 1e-300;

/// Draws a work–precision chart as a complete SVG document. Any data give a picture; if there are no runs,
/// the picture states that.
pub fn work_precision(chart: &WorkPrecision) -> String {
    let size = (extent(chart.width, 200.0, 640.0), extent(chart.height, 160.0, 420.0));
    let words =
        PlotTexts { title: &chart.title, xlabel: &chart.xlabel, ylabel: &chart.ylabel, width: size.0 };
    let methods: Vec<Vec<DrawnRun>> = chart.methods.iter().map(|m| runs(&m.points)).collect();
    let all = || methods.iter().flatten();

    let (top, below) = (words.above(), words.below());
    let entries =
        chart.methods.iter().enumerate().map(|(index, m)| LegendEntry { label: m.label.clone(), index });
    let legend = legend::plan(entries.collect(), size.0, size.1 - top - below, true);
    let bottom = (size.1 - below - legend.below).max(top + 20.0);
    let y = axis(all().map(|r| r.cost), |_| 1.5 * TICK / (bottom - top));
    let left = margin(&y);
    let right = (size.0 - EDGE - legend.right - 4.0).max(left + 40.0);
    let outer = Frame { left, top, right, bottom };

    // The strips next to the scale exist only if they contain runs.
    let some = |error: DrawnError| all().any(|r| r.error == error);
    let diverging = methods.iter().filter(|m| m.iter().any(|r| r.error == DrawnError::Diverged)).count();
    let zero = if some(DrawnError::Zero) { 34.0f64.min(0.15 * outer.width()) } else { 0.0 };
    let wish = (width(DIVERGED, TICK) + 8.0).max(16.0 + 22.0 * diverging as f64);
    let failed = if diverging > 0 { wish.min(0.3 * outer.width()) } else { 0.0 };
    let inner = Frame { left: left + zero, right: right - failed, ..outer };
    let finite = all().filter_map(|r| if let DrawnError::Finite(e) = r.error { Some(e) } else { None });
    let mut x = axis(finite, |label| (label.width(TICK) + 10.0) / inner.width().max(1.0));
    drop_labels_under_strips(&mut x, &outer, &inner, size.0);

    let named = if words.title.trim().is_empty() { "Cost against error" } else { words.title };
    let mut canvas = Canvas::new(size, named, &describe(chart));
    shade_strips(&mut canvas, &outer, &inner);
    draw(&mut canvas, &outer, &inner, &x, &y, &words);
    name_strips(&mut canvas, &outer, &inner);
    if all().next().is_none() {
        frame::empty(&mut canvas, &outer, "no data");
    }

    let placed = place(&methods, (&outer, &inner), &x, &y, diverging);
    plot(&mut canvas, chart, &placed, &outer);
    legend::draw(&mut canvas, &legend, &outer, below, |canvas, index, start| {
        let look = chart
            .methods
            .get(index)
            .map_or(MarkerStyle { index, hollow: false }, |m| MarkerStyle::of_method(index, m));
        canvas.open(&stroke(look));
        canvas.line(start, (start.0 + SAMPLE_WIDTH, start.1));
        canvas.close();
        mark(canvas, look, (start.0 + SAMPLE_WIDTH / 2.0, start.1));
    });
    canvas.finish()
}

/// Removes tick labels at the ends of the scale that would overlap the names of the strips.
fn drop_labels_under_strips(x: &mut Axis, outer: &Frame, inner: &Frame, size: f64) {
    let least = if inner.left > outer.left { (outer.left + inner.left) / 2.0 + 12.0 } else { 0.0 };
    let name = width(DIVERGED, TICK);
    let most = if inner.right < outer.right { (inner.right + outer.right - name) / 2.0 - 8.0 } else { size };
    for tick in &mut x.ticks {
        let (middle, half) = (inner.at(tick.fraction, 0.0).0, tick.label.width(TICK) / 2.0);
        if middle - half < least || middle + half > most {
            tick.label = Label::default();
        }
    }
}

/// Shades the strips next to the scale: runs without an error on the left, diverged runs on the right.
fn shade_strips(canvas: &mut Canvas, outer: &Frame, inner: &Frame) {
    if inner.left > outer.left {
        canvas.area((outer.left, outer.top), (inner.left, outer.bottom), SHADE_COLOUR);
    }
    if inner.right < outer.right {
        canvas.area((inner.right, outer.top), (outer.right, outer.bottom), SHADE_COLOUR);
    }
}

fn name_strips(canvas: &mut Canvas, outer: &Frame, inner: &Frame) {
    canvas.open(&style(TICK, LABEL_COLOUR, "middle"));
    if inner.left > outer.left {
        canvas.text(((outer.left + inner.left) / 2.0, outer.bottom + 17.0), "0");
    }
    if inner.right < outer.right {
        canvas.text(((inner.right + outer.right) / 2.0, outer.bottom + 17.0), DIVERGED);
    }
    canvas.close();
}

/// The label of the strip of runs without a finite error.
const DIVERGED: &str = "diverged";

fn runs(points: &[MethodPoint]) -> Vec<DrawnRun<'_>> {
    let drawn = points.iter().filter(|p| (TINY..=HUGE).contains(&p.cost));
    let run = drawn.map(|p| {
        let error = match p.error.abs() {
            _ if p.failed => DrawnError::Diverged,
            e if e < TINY => DrawnError::Zero,
            e if e <= HUGE => DrawnError::Finite(e),
            _ => DrawnError::Diverged,
        };
        DrawnRun { error, cost: p.cost, note: &p.note, at_most: p.at_most, spread: p.spread }
    });
    run.collect()
}

fn axis(values: impl Iterator<Item = f64>, extent: impl Fn(&Label) -> f64) -> Axis {
    let (low, high) = values.fold((f64::INFINITY, 0.0f64), |(low, high), v| (low.min(v), high.max(v)));
    if low <= high { logarithmic(low, high, extent) } else { logarithmic(1.0, 10.0, extent) }
}

/// A run with its position.
struct PlacedRun<'a> {
    error: DrawnError,
    point: Point,
    note: &'a str,
    at_most: bool,
    /// The vertical positions of the ends of its bar.
    bar: Option<[f64; 2]>,
}

/// The positions of all runs. Crosses of different methods are placed side by side, in the order of the methods.
fn place<'a>(
    methods: &[Vec<DrawnRun<'a>>],
    (outer, inner): (&Frame, &Frame),
    x: &Axis,
    y: &Axis,
    diverging: usize,
) -> Vec<Vec<PlacedRun<'a>>> {
    let mut rank = 0;
    let mut placed = Vec::new();
    for method in methods {
        let cross = (f64::from(rank) + 0.5) / diverging.max(1) as f64;
        if method.iter().any(|r| r.error == DrawnError::Diverged) {
            rank += 1;
        }
        let runs = method.iter().filter_map(|run| {
            let height = inner.at(0.0, y.fraction(run.cost)?).1;
            let along = match run.error {
                DrawnError::Zero => (outer.left + inner.left) / 2.0,
                DrawnError::Finite(error) => inner.at(x.fraction(error)?, 0.0).0,
                DrawnError::Diverged => inner.right + cross * (outer.right - inner.right),
            };
            // A bar is clipped to the frame.
            let end = |cost: f64| -> Option<f64> {
                let fraction = if cost > 0.0 { y.fraction(cost) } else { None };
                Some(inner.at(0.0, fraction?.clamp(0.0, 1.0)).1)
            };
            let bar = run.spread.and_then(|[low, high]| Some([end(low)?, end(high)?]));
            Some(PlacedRun {
                error: run.error,
                point: (along, height),
                note: run.note,
                at_most: run.at_most,
                bar,
            })
        });
        placed.push(runs.collect());
    }
    placed
}

/// Draws curves, marks and the labels of points.
fn plot(canvas: &mut Canvas, chart: &WorkPrecision, methods: &[Vec<PlacedRun>], frame: &Frame) {
    let curves: Vec<Vec<Vec<Point>>> = methods.iter().map(|m| connected(m)).collect();
    for (index, (method, curve)) in chart.methods.iter().zip(&curves).enumerate() {
        let data = path(curve);
        if !data.is_empty() {
            canvas.named(&stroke(MarkerStyle::of_method(index, method)), &method.label);
            canvas.path(&data);
            canvas.close();
        }
    }
    let mut wishes = Vec::new();
    for (index, (method, drawn)) in methods.iter().zip(&chart.methods).enumerate() {
        let look = MarkerStyle::of_method(index, drawn);
        for (i, run) in method.iter().enumerate() {
            if let Some([low, high]) = run.bar {
                bar(canvas, look.index, run.point.0, [low, high]);
            }
            if run.at_most {
                arrow(canvas, look.index, run.point);
            }
            if run.error == DrawnError::Diverged {
                cross(canvas, look.index, run.point);
            } else {
                mark(canvas, look, run.point);
            }
            let text = fit(&clean_label(run.note), SMALL, 0.2 * frame.width());
            wishes.push(PlacedLabel { point: run.point, text, first: i == 0 || i + 1 == method.len() });
        }
    }
    let marks: Vec<Point> = methods.iter().flatten().map(|run| run.point).collect();
    let lines: Vec<Vec<Point>> = curves.into_iter().flatten().collect();
    canvas.open(&style(SMALL, LABEL_COLOUR, "start"));
    // At the right, a label may extend into the space before the legend.
    let bounds = Frame { right: frame.right + 8.0, ..*frame };
    for (position, text) in arrange(wishes, &marks, &lines, &bounds) {
        canvas.text(position, &text);
    }
    canvas.close();
}

/// The lines between consecutive runs that have a position on the scale.
fn connected(method: &[PlacedRun]) -> Vec<Vec<Point>> {
    let on_scale = |run: &PlacedRun| matches!(run.error, DrawnError::Finite(_));
    let parts = method.chunk_by(|a, b| on_scale(a) && on_scale(b));
    parts.filter(|p| p.len() > 1).map(|p| p.iter().map(|run| run.point).collect()).collect()
}

fn stroke(look: MarkerStyle) -> String {
    let pattern = if look.hollow { Some("2 3") } else { dash(look.index, false) };
    let pattern = pattern.map(|d| format!(" stroke-dasharray=\"{d}\"")).unwrap_or_default();
    format!("fill=\"none\" stroke=\"{}\" stroke-width=\"1.5\"{pattern}", colour(look.index))
}

/// Draws the mark of a run. Its shape corresponds to the colour, for prints without colours.
fn mark(canvas: &mut Canvas, look: MarkerStyle, point: Point) {
    let [fill, edge] = match look.hollow {
        false => [colour(look.index), "#ffffff"],
        true => ["#ffffff", colour(look.index)],
    };
    canvas.open(&format!(
        "fill=\"{fill}\" stroke=\"{edge}\" stroke-width=\"{}\"",
        if look.hollow { 1.25 } else { 0.75 }
    ));
    canvas.path(&shape(look.index, point));
    canvas.close();
}

/// A disc, square, triangle, diamond, or inverted triangle.
fn shape(index: usize, (x, y): Point) -> String {
    let corners: &[Point] = match index % 5 {
        0 => {
            let (left, right, y) = (px(x - 3.8), px(x + 3.8), px(y));
            return format!("M{left},{y}A3.8,3.8 0 1 1 {right},{y}A3.8,3.8 0 1 1 {left},{y}Z");
        }
        1 => &[(-3.4, -3.4), (3.4, -3.4), (3.4, 3.4), (-3.4, 3.4)],
        2 => &[(0.0, -4.6), (4.4, 3.1), (-4.4, 3.1)],
        3 => &[(0.0, -4.8), (4.8, 0.0), (0.0, 4.8), (-4.8, 0.0)],
        _ => &[(0.0, 4.6), (4.4, -3.1), (-4.4, -3.1)],
    };
    path(&[corners.iter().map(|(dx, dy)| (x + dx, y + dy)).collect()]) + "Z"
}

/// Draws the bar for the spread of a cost.
fn bar(canvas: &mut Canvas, index: usize, x: f64, [low, high]: [f64; 2]) {
    canvas.open(&format!("fill=\"none\" stroke=\"{}\" stroke-width=\"1\"", colour(index)));
    let end = |y: f64| vec![(x - 2.5, y), (x + 2.5, y)];
    canvas.path(&path(&[vec![(x, low), (x, high)], end(low), end(high)]));
    canvas.close();
}

/// Draws an arrow to the left of a run whose error is at most the drawn value.
fn arrow(canvas: &mut Canvas, index: usize, (x, y): Point) {
    canvas.open(&format!("fill=\"none\" stroke=\"{}\" stroke-width=\"1.25\"", colour(index)));
    let tip = (x - 12.0, y);
    let head = vec![(tip.0 + 3.0, y - 2.5), tip, (tip.0 + 3.0, y + 2.5)];
    canvas.path(&path(&[vec![(x - 4.0, y), tip], head]));
    canvas.close();
}

/// Draws the mark of a run without a finite error.
fn cross(canvas: &mut Canvas, index: usize, (x, y): Point) {
    canvas.open(&format!("fill=\"none\" stroke=\"{}\" stroke-width=\"2\"", colour(index)));
    let arms = [vec![(x - 3.5, y - 3.5), (x + 3.5, y + 3.5)], vec![(x - 3.5, y + 3.5), (x + 3.5, y - 3.5)]];
    canvas.path(&path(&arms));
    canvas.close();
}

/// The description of the picture in words.
fn describe(chart: &WorkPrecision) -> String {
    let mut text =
        String::from("Cost against error, both on logarithmic axes; lower and further left is better.");
    for method in chart.methods.iter().take(12) {
        let label = clean_label(&method.label);
        text.push_str(&format!(" {}:", if label.is_empty() { "Unnamed" } else { &label }));
        let runs = runs(&method.points);
        if runs.is_empty() {
            text.push_str(" no data.");
            continue;
        }
        let each = runs.iter().take(12).map(|run| {
            let error = match run.error {
                DrawnError::Zero => String::from("no error"),
                DrawnError::Finite(error) if run.at_most => format!("error at most {}", short(error)),
                DrawnError::Finite(error) => format!("error {}", short(error)),
                DrawnError::Diverged => String::from(DIVERGED),
            };
            let note = clean_label(run.note);
            let note = if note.is_empty() { note } else { format!("{note} ") };
            format!(" {note}{error} at cost {}", short(run.cost))
        });
        text.push_str(&each.collect::<Vec<_>>().join(","));
        text.push('.');
    }
    text
}
