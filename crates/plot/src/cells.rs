//! A map of coloured cells: what becomes of something over two settings, such as where a scene is stable.
//!
//! The values of the first setting stand below the columns, those of the second beside the rows, the lowest row at the bottom. What
//! a colour means stands in the legend; in a cell that is not the first kind a mark says the same without colour.

use super::canvas::{Canvas, drop, style};
use super::frame::{self, EDGE, Frame, Words};
use super::legend::{self, Entry, STROKE};
use super::style::{INK, LABEL, SHADE, SOFT, TICK, TITLE, colour, extent};
use super::text::{clean, fit, width};

/// A map of cells.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cells {
    /// Shown above the map; may be empty.
    pub title: String,
    /// What changes from column to column.
    pub xlabel: String,
    /// What changes from row to row.
    pub ylabel: String,
    /// The value at each column.
    pub columns: Vec<String>,
    /// The value at each row, from the bottom.
    pub rows: Vec<String>,
    /// What a cell may be: the first is what is good, and stays light.
    pub kinds: Vec<String>,
    /// For each row, which kind each cell is; `None` for what is not known, which is left white.
    pub cells: Vec<Vec<Option<usize>>>,
    /// Width of the whole picture, pixels.
    pub width: f64,
    /// Height of the whole picture, pixels, legend included. At least 160 are used.
    pub height: f64,
}

/// Most columns or rows that are drawn.
const MOST: usize = 200;

/// Draws a map as a complete SVG document. Any data give a picture; without cells it says so.
pub fn cells(chart: &Cells) -> String {
    let size = (extent(chart.width, 200.0, 640.0), extent(chart.height, 160.0, 420.0));
    let words = Words { title: &chart.title, xlabel: &chart.xlabel, ylabel: &chart.ylabel, width: size.0 };
    let (columns, rows) = (chart.columns.len().min(MOST), chart.rows.len().min(MOST));
    let (top, below) = (words.above(), words.below());
    let entries = chart.kinds.iter().enumerate().map(|(index, k)| Entry { label: k.clone(), index });
    let legend = legend::plan(entries.collect(), size.0, size.1 - top - below, true);
    let bottom = (size.1 - below - legend.below).max(top + 20.0);
    let labels: Vec<String> =
        chart.rows.iter().take(rows).map(|r| fit(&clean(r), TICK, 0.25 * size.0)).collect();
    let widest = labels.iter().map(|l| width(l, TICK)).fold(0.0, f64::max);
    let left = EDGE + widest + 8.0;
    let right = (size.0 - EDGE - legend.right - 4.0).max(left + 40.0);
    let area = Frame { left, top, right, bottom };

    let named = if words.title.trim().is_empty() { "A map of cells" } else { words.title };
    let mut canvas = Canvas::new(size, named, &describe(chart));
    canvas.area((left, top), (right, bottom), "#ffffff");
    let across = |i: usize| left + area.width() * i as f64 / columns.max(1) as f64;
    let up = |j: usize| bottom - area.height() * j as f64 / rows.max(1) as f64;
    let mut marks = Vec::new();
    for (j, row) in chart.cells.iter().take(rows).enumerate() {
        for (i, kind) in row.iter().take(columns).enumerate() {
            let Some(kind) = kind.filter(|k| *k < chart.kinds.len()) else { continue };
            canvas.area((across(i), up(j + 1)), (across(i + 1), up(j)), fill(kind));
            if kind > 0 {
                marks.push((kind, ((across(i) + across(i + 1)) / 2.0, (up(j) + up(j + 1)) / 2.0)));
            }
        }
    }
    let room = (area.width() / columns.max(1) as f64).min(area.height() / rows.max(1) as f64);
    if room >= 8.0 {
        canvas.open(&style(TICK.min(room), "#ffffff", "middle"));
        for (kind, (x, y)) in &marks {
            canvas.text((*x, y + drop(TICK.min(room))), &kind.to_string());
        }
        canvas.close();
    }
    if columns == 0 || rows == 0 {
        frame::empty(&mut canvas, &area, "no data");
    }
    // As many values as there is room for, the first and then every so many.
    canvas.open(&style(TICK, SOFT, "end"));
    let every = (1.6 * TICK * rows as f64 / area.height()).ceil().max(1.0) as usize;
    for (j, label) in labels.iter().enumerate().step_by(every) {
        canvas.text((left - 6.0, (up(j) + up(j + 1)) / 2.0 + drop(TICK)), label);
    }
    canvas.close();
    canvas.open(&style(TICK, SOFT, "middle"));
    let names: Vec<String> =
        chart.columns.iter().take(columns).map(|c| fit(&clean(c), TICK, 0.25 * size.0)).collect();
    let widest = names.iter().map(|l| width(l, TICK)).fold(0.0, f64::max) + 10.0;
    let every = (widest * columns as f64 / area.width()).ceil().max(1.0) as usize;
    for (i, name) in names.iter().enumerate().step_by(every) {
        canvas.text(((across(i) + across(i + 1)) / 2.0, bottom + 17.0), name);
    }
    canvas.close();
    canvas.open(&style(LABEL, INK, "start"));
    canvas.text((EDGE, top - 8.0), &fit(&clean(words.ylabel), LABEL, size.0 - 2.0 * EDGE));
    canvas.close();
    if !words.title.trim().is_empty() {
        canvas.open(&style(TITLE, INK, "start"));
        canvas.text((EDGE, EDGE + TITLE), &fit(&clean(words.title), TITLE, size.0 - 2.0 * EDGE));
        canvas.close();
    }
    if !words.xlabel.trim().is_empty() {
        canvas.open(&style(LABEL, INK, "middle"));
        let text = fit(&clean(words.xlabel), LABEL, area.width());
        canvas.text(((left + right) / 2.0, bottom + 35.0), &text);
        canvas.close();
    }
    legend::draw(&mut canvas, &legend, &area, below, |canvas, index, at| {
        canvas.area((at.0 + STROKE - 12.0, at.1 - 6.0), (at.0 + STROKE, at.1 + 6.0), fill(index));
        if index > 0 {
            canvas.open(&style(TICK, "#ffffff", "middle"));
            canvas.text((at.0 + STROKE - 6.0, at.1 + drop(TICK)), &index.to_string());
            canvas.close();
        }
    });
    canvas.finish()
}

/// The colour of a kind: what is good stays light.
fn fill(kind: usize) -> &'static str {
    if kind == 0 { SHADE } else { colour(kind - 1) }
}

/// The picture in words.
fn describe(chart: &Cells) -> String {
    let count = |kind: Option<usize>| chart.cells.iter().flatten().filter(|k| **k == kind).count();
    let mut text = String::from("A map of cells.");
    for (k, name) in chart.kinds.iter().enumerate().take(12) {
        text.push_str(&format!(" {}: {}.", clean(name), count(Some(k))));
    }
    match count(None) {
        0 => {}
        n => text.push_str(&format!(" Not known: {n}.")),
    }
    text
}
