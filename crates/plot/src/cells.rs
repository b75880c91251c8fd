//! A map of coloured cells: an outcome as a function of two settings, such as whether a scene is stable.
//!
//! The values of the first setting are written below the columns, those of the second next to the rows, the lowest row at
//! the bottom. The legend explains the colours. Each cell that is not of the first kind also has a mark, so that the map
//! can be read without colours.

use super::canvas::{Canvas, drop, style};
use super::frame::{self, EDGE, Frame, PlotTexts};
use super::legend::{self, LegendEntry, SAMPLE_WIDTH};
use super::style::{LABEL, LABEL_COLOUR, SHADE_COLOUR, TICK, TITLE, TITLE_COLOUR, colour, extent};
use super::text::{clean_label, fit, width};

/// A map of cells.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cells {
    /// The title above the map; may be empty.
    pub title: String,
    /// The setting that changes from column to column.
    pub xlabel: String,
    /// The setting that changes from row to row.
    pub ylabel: String,
    /// The value of each column.
    pub columns: Vec<String>,
    /// The value of each row, from the bottom.
    pub rows: Vec<String>,
    /// The kinds of cells. The first one is the good outcome, with a light colour.
    pub kinds: Vec<String>,
    /// The kind of each cell, row by row; `None` if unknown, which is left white.
    pub cells: Vec<Vec<Option<usize>>>,
    /// The width of the whole picture, pixels.
    pub width: f64,
    /// The height of the whole picture including the legend, pixels; at least 160.
    pub height: f64,
}

/// The maximum number of columns or rows that are drawn.
const MOST: usize = 200;

/// Draws a map as a complete SVG document. Any data give a picture; if there are no cells, the picture states that.
pub fn cells(chart: &Cells) -> String {
    let map = CellLayout::new(chart);
    let named = if map.words.title.trim().is_empty() { "A map of cells" } else { map.words.title };
    let mut canvas = Canvas::new(map.size, named, &describe(chart));
    let area = map.area;
    canvas.area((area.left, area.top), (area.right, area.bottom), "#ffffff");
    map.draw_cells(&mut canvas, chart);
    if map.columns == 0 || map.rows == 0 {
        frame::empty(&mut canvas, &area, "no data");
    }
    map.draw_values(&mut canvas, chart);
    map.draw_titles(&mut canvas);
    legend::draw(&mut canvas, &map.legend, &area, map.words.below(), |canvas, index, start| {
        canvas.area(
            (start.0 + SAMPLE_WIDTH - 12.0, start.1 - 6.0),
            (start.0 + SAMPLE_WIDTH, start.1 + 6.0),
            fill(index),
        );
        if index > 0 {
            canvas.open(&style(TICK, "#ffffff", "middle"));
            canvas.text((start.0 + SAMPLE_WIDTH - 6.0, start.1 + drop(TICK)), &index.to_string());
            canvas.close();
        }
    });
    canvas.finish()
}

/// The layout of the picture.
struct CellLayout<'c> {
    size: (f64, f64),
    words: PlotTexts<'c>,
    columns: usize,
    rows: usize,
    /// The values of the rows, shortened to the available width.
    row_values: Vec<String>,
    legend: legend::LegendLayout,
    /// The area of the cells.
    area: Frame,
}

impl<'c> CellLayout<'c> {
    fn new(chart: &'c Cells) -> CellLayout<'c> {
        let size = (extent(chart.width, 200.0, 640.0), extent(chart.height, 160.0, 420.0));
        let words =
            PlotTexts { title: &chart.title, xlabel: &chart.xlabel, ylabel: &chart.ylabel, width: size.0 };
        let (columns, rows) = (chart.columns.len().min(MOST), chart.rows.len().min(MOST));
        let (top, below) = (words.above(), words.below());
        let entries =
            chart.kinds.iter().enumerate().map(|(index, k)| LegendEntry { label: k.clone(), index });
        let legend = legend::plan(entries.collect(), size.0, size.1 - top - below, true);
        let bottom = (size.1 - below - legend.below).max(top + 20.0);
        let row_values: Vec<String> =
            chart.rows.iter().take(rows).map(|r| fit(&clean_label(r), TICK, 0.25 * size.0)).collect();
        let widest = row_values.iter().map(|l| width(l, TICK)).fold(0.0, f64::max);
        let left = EDGE + widest + 8.0;
        let right = (size.0 - EDGE - legend.right - 4.0).max(left + 40.0);
        let area = Frame { left, top, right, bottom };
        CellLayout { size, words, columns, rows, row_values, legend, area }
    }

    /// The left edge of a column.
    fn column_left(&self, i: usize) -> f64 {
        self.area.left + self.area.width() * i as f64 / self.columns.max(1) as f64
    }

    /// The lower edge of a row.
    fn up(&self, j: usize) -> f64 {
        self.area.bottom - self.area.height() * j as f64 / self.rows.max(1) as f64
    }

    /// Draws the cells, with marks if they fit.
    fn draw_cells(&self, canvas: &mut Canvas, chart: &Cells) {
        let mut marks = Vec::new();
        for (j, row) in chart.cells.iter().take(self.rows).enumerate() {
            for (i, kind) in row.iter().take(self.columns).enumerate() {
                let Some(kind) = kind.filter(|k| *k < chart.kinds.len()) else { continue };
                let (left, right) = (self.column_left(i), self.column_left(i + 1));
                let (lower, upper) = (self.up(j), self.up(j + 1));
                canvas.area((left, upper), (right, lower), fill(kind));
                if kind > 0 {
                    marks.push((kind, ((left + right) / 2.0, (lower + upper) / 2.0)));
                }
            }
        }
        let cell_width = self.area.width() / self.columns.max(1) as f64;
        let side = cell_width.min(self.area.height() / self.rows.max(1) as f64);
        if side >= 8.0 {
            canvas.open(&style(TICK.min(side), "#ffffff", "middle"));
            for (kind, (x, y)) in &marks {
                canvas.text((*x, y + drop(TICK.min(side))), &kind.to_string());
            }
            canvas.close();
        }
    }

    /// Draws the values of rows and columns: the first one, and then every n-th, as many as fit.
    fn draw_values(&self, canvas: &mut Canvas, chart: &Cells) {
        canvas.open(&style(TICK, LABEL_COLOUR, "end"));
        let every = (1.6 * TICK * self.rows as f64 / self.area.height()).ceil().max(1.0) as usize;
        for (j, label) in self.row_values.iter().enumerate().step_by(every) {
            let middle = (self.up(j) + self.up(j + 1)) / 2.0;
            canvas.text((self.area.left - 6.0, middle + drop(TICK)), label);
        }
        canvas.close();
        canvas.open(&style(TICK, LABEL_COLOUR, "middle"));
        let names: Vec<String> = chart
            .columns
            .iter()
            .take(self.columns)
            .map(|c| fit(&clean_label(c), TICK, 0.25 * self.size.0))
            .collect();
        let widest = names.iter().map(|l| width(l, TICK)).fold(0.0, f64::max) + 10.0;
        let every = (widest * self.columns as f64 / self.area.width()).ceil().max(1.0) as usize;
        for (i, name) in names.iter().enumerate().step_by(every) {
            canvas
                .text(((self.column_left(i) + self.column_left(i + 1)) / 2.0, self.area.bottom + 17.0), name);
        }
        canvas.close();
    }

    /// Draws the title and the labels of both axes.
    fn draw_titles(&self, canvas: &mut Canvas) {
        let (words, area, whole) = (&self.words, &self.area, self.size.0 - 2.0 * EDGE);
        canvas.open(&style(LABEL, TITLE_COLOUR, "start"));
        canvas.text((EDGE, area.top - 8.0), &fit(&clean_label(words.ylabel), LABEL, whole));
        canvas.close();
        if !words.title.trim().is_empty() {
            canvas.open(&style(TITLE, TITLE_COLOUR, "start"));
            canvas.text((EDGE, EDGE + TITLE), &fit(&clean_label(words.title), TITLE, whole));
            canvas.close();
        }
        if !words.xlabel.trim().is_empty() {
            canvas.open(&style(LABEL, TITLE_COLOUR, "middle"));
            let text = fit(&clean_label(words.xlabel), LABEL, area.width());
            canvas.text(((area.left + area.right) / 2.0, area.bottom + 35.0), &text);
            canvas.close();
        }
    }
}

/// The colour of a kind; the first kind is light.
fn fill(kind: usize) -> &'static str {
    if kind == 0 { SHADE_COLOUR } else { colour(kind - 1) }
}

/// The description of the picture in words.
fn describe(chart: &Cells) -> String {
    let count = |kind: Option<usize>| chart.cells.iter().flatten().filter(|k| **k == kind).count();
    let mut text = String::from("A map of cells.");
    for (k, name) in chart.kinds.iter().enumerate().take(12) {
        text.push_str(&format!(" {}: {}.", clean_label(name), count(Some(k))));
    }
    match count(None) {
        0 => {}
        n => text.push_str(&format!(" Not known: {n}.")),
    }
    text
}
