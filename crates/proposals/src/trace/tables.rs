//! Tables whose first column has the values of a control: the measures of the other columns, in a run for each row.

use super::candidates::Candidate;
use super::lab::TracedLab;
use super::rank::factor;
use super::trials::{TraceRun, trials};
use super::words::split_words;
use labspec::bind::{given_by, of_label, scalar};
use labspec::json::{Number, Scalar};
use labspec::run::{StepVariant, settings};
use labspec::spec::{Control, ControlKind, Lesson};
use labspec::verify::{Quoted, RunCache, quoted};
use labspec_expr::Value;
use labspec_expr::dimension::{Dimension, Measure};
use std::collections::BTreeSet;
use std::ops::Range;

/// The minimum and the maximum number of rows: with fewer, a column could match by chance.
const MIN_ROWS: usize = 3;
const MAX_ROWS: usize = 12;

/// A column that a lab explains.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct TracedColumn {
    pub(crate) head: String,
    /// The measure, and the factor from its value to the numbers of the column.
    pub(crate) measure: String,
    pub(crate) factor: String,
    /// The places of its cells in the file.
    pub(crate) cells: Vec<Range<usize>>,
}

/// The columns of a table that belong to the same run.
#[derive(Clone, Debug)]
pub(crate) struct TracedTable {
    /// The index of the lab.
    pub(crate) lab: usize,
    /// The heading of the first column.
    pub(crate) by: String,
    /// The run without the swept control.
    pub(crate) run: TraceRun,
    /// The control and its values.
    pub(crate) control: String,
    pub(crate) values: Vec<f64>,
    pub(crate) columns: Vec<TracedColumn>,
}

/// A cell and its place in the file.
struct Cell {
    text: String,
    span: Range<usize>,
}

struct MarkdownTable {
    head: Vec<String>,
    rows: Vec<Vec<Cell>>,
    start: usize,
}

/// The tables of a lesson that labs explain.
pub(super) fn tables(lesson: &Lesson, labs: &[TracedLab<'_>], stage: &RunCache<'_>) -> Vec<TracedTable> {
    let all = markdown_tables(lesson.file.text());
    let heads: Vec<&String> = all.iter().flat_map(|table| &table.head).collect();
    let mut traced = Vec::new();
    for table in all.iter().filter(|table| (MIN_ROWS..=MAX_ROWS).contains(&table.rows.len())) {
        let mut order: Vec<usize> = (0..labs.len()).collect();
        let away =
            |i: &usize| labs.get(*i).map_or(usize::MAX, |lab| lab.lab.span.start.abs_diff(table.start));
        order.sort_by_key(away);
        let found = order.into_iter().find_map(|lab| {
            let tried = labs.get(lab).filter(|tried| tried.owner.is_none())?;
            Some(of_lab(table, (lab, tried), stage)).filter(|found| !found.is_empty())
        });
        for mut one in found.into_iter().flatten() {
            // A claim names a column by its heading, so another table must not have it.
            one.columns.retain(|column| heads.iter().filter(|head| **head == &column.head).count() == 1);
            if !one.columns.is_empty() {
                traced.push(one);
            }
        }
    }
    traced
}

/// The columns of a table that a lab explains: in its run as it stands, or with the choice that the heading names.
fn of_lab(
    table: &MarkdownTable,
    (lab, tried): (usize, &TracedLab<'_>),
    stage: &RunCache<'_>,
) -> Vec<TracedTable> {
    let Some((control, values)) = swept(table, tried) else { return Vec::new() };
    let Some(base) = trials(tried.lab, &[]).into_iter().next() else { return Vec::new() };
    let mut all: Vec<TracedTable> = Vec::new();
    for (k, head) in table.head.iter().enumerate().skip(1) {
        let run = chosen(&base, tried, head);
        let index = all.iter().position(|t| t.run.set == run.set).unwrap_or_else(|| {
            all.push(TracedTable {
                lab,
                by: table.head.first().cloned().unwrap_or_default(),
                run: run.clone(),
                control: control.label.value.clone(),
                values: values.clone(),
                columns: Vec::new(),
            });
            all.len() - 1
        });
        let rows: Vec<Vec<f64>> = values
            .iter()
            .map(|x| tried.values_of(&with(&run, control, *x), stage, StepVariant::NOMINAL))
            .collect();
        let Some(entry) = all.get_mut(index) else { continue };
        // Two columns show two quantities.
        let used: Vec<&str> = entry.columns.iter().map(|column| column.measure.as_str()).collect();
        let free: Vec<(usize, &Candidate)> =
            tried.candidates.iter().enumerate().filter(|(_, c)| !used.contains(&c.text.as_str())).collect();
        if let Some(column) = column(table, k, &free, &rows) {
            entry.columns.push(column);
        }
    }
    all.retain(|table| !table.columns.is_empty());
    all
}

/// The slider that the heading of the first column names, and its value in each row.
fn swept<'l>(table: &MarkdownTable, tried: &TracedLab<'l>) -> Option<(&'l Control, Vec<f64>)> {
    let head = table.head.first()?;
    let unit = of_label(head).map(|(_, unit)| unit);
    let words = name_words(head);
    let is_named = |control: &&Control| {
        let label = name_words(control.label.as_str());
        let same_unit = match (given_by(control), &unit) {
            (Measure::Dimension(slider_unit), Some(unit)) => {
                slider_unit.agrees(unit) && slider_unit.factor == unit.factor
            }
            (Measure::Dimension(_), None) => false,
            (_, unit) => unit.is_none(),
        };
        matches!(control.kind, ControlKind::Slider { .. })
            && same_unit
            && !words.is_empty()
            && words.is_subset(&label)
    };
    let mut named = tried.lab.controls.iter().filter(is_named);
    let control = named.next().filter(|_| named.next().is_none())?;
    let value = |row: &Vec<Cell>| {
        let x: f64 = row.first()?.text.parse().ok()?;
        settings::value(control, &Value::Number(x)).is_ok().then_some(x)
    };
    Some((control, table.rows.iter().map(value).collect::<Option<_>>()?))
}

/// The words of a label without its unit.
fn name_words(label: &str) -> BTreeSet<String> {
    split_words(label.split('(').next().unwrap_or(label)).collect()
}

/// The run with the choice that a heading names.
fn chosen(base: &TraceRun, tried: &TracedLab<'_>, head: &str) -> TraceRun {
    let head = head.to_lowercase();
    for control in &tried.lab.controls {
        let ControlKind::Select { options, value, .. } = &control.kind else { continue };
        let named = options.iter().find(|choice| {
            let text = choice.text.value.to_lowercase();
            text.chars().any(char::is_alphabetic) && head.contains(&text)
        });
        if let Some(choice) = named.filter(|choice| scalar(&choice.value) != scalar(value)) {
            let set = vec![(control.label.value.clone(), choice.value.clone())];
            return TraceRun { set, name: super::names::named_value(control, &choice.value), ..base.clone() };
        }
    }
    base.clone()
}

/// A run with a value of the swept slider.
fn with(run: &TraceRun, control: &Control, x: f64) -> TraceRun {
    let mut set = run.set.clone();
    set.push((control.label.value.clone(), Scalar::Number(Number { value: x, span: 0..0 })));
    TraceRun { set, ..run.clone() }
}

/// The measure that has the digits of every row of a column. Of several, the one that the heading names, and the simplest.
fn column(
    table: &MarkdownTable,
    k: usize,
    candidates: &[(usize, &Candidate)],
    rows: &[Vec<f64>],
) -> Option<TracedColumn> {
    let head = table.head.get(k)?;
    let unit = of_label(head).map_or(Dimension::NUMBER, |(_, unit)| unit);
    let cells: Vec<&Cell> = table.rows.iter().map(|row| row.get(k)).collect::<Option<_>>()?;
    let numbers: Vec<Quoted> = cells.iter().map(|cell| quoted(&cell.text).ok()).collect::<Option<_>>()?;
    let words: BTreeSet<String> = split_words(head).collect();
    let mut best: Option<(usize, f64, TracedColumn)> = None;
    for &(i, c) in candidates {
        if c.constant.is_some() || !c.dimension.agrees(&unit) {
            continue;
        }
        let ratio = unit.factor / c.dimension.factor;
        let value = |row: usize| rows.get(row).and_then(|v| v.get(i)).copied().unwrap_or(f64::NAN) * ratio;
        let Some(sign) = ["", "-"].into_iter().find(|sign| {
            let sign = if sign.is_empty() { 1.0 } else { -1.0 };
            numbers.iter().enumerate().all(|(row, number)| number.is(sign * value(row)))
        }) else {
            continue;
        };
        let shared = c.words.intersection(&words).count();
        let is_better =
            best.as_ref().is_none_or(|(most, least, _)| shared > *most || shared == *most && c.cost < *least);
        if is_better {
            let cells = cells.iter().map(|cell| cell.span.clone()).collect();
            let factor = factor(sign, ratio);
            best = Some((
                shared,
                c.cost,
                TracedColumn { head: head.clone(), measure: c.text.clone(), factor, cells },
            ));
        }
    }
    best.map(|(.., column)| column)
}

/// The tables of a text, outside of fences.
fn markdown_tables(text: &str) -> Vec<MarkdownTable> {
    let mut all: Vec<MarkdownTable> = Vec::new();
    let (mut offset, mut is_fenced, mut before): (usize, bool, Option<&str>) = (0, false, None);
    let mut is_inside = false;
    for line in text.split_inclusive('\n') {
        let trimmed = line.trim();
        is_fenced ^= trimmed.starts_with("```");
        let is_row = !is_fenced && trimmed.starts_with('|');
        let is_rule = is_row && trimmed.contains("---");
        // A line of text directly below a table is a row of it for Markdown, without numbers.
        if is_inside && !is_row && !trimmed.is_empty() {
            all.pop();
        }
        if is_rule {
            let head = before.map_or(Vec::new(), |head| cells(head, 0).into_iter().map(|c| c.text).collect());
            all.push(MarkdownTable { head, rows: Vec::new(), start: offset });
        } else if is_row
            && is_inside
            && let Some(table) = all.last_mut()
        {
            table.rows.push(cells(line, offset));
        }
        is_inside = is_row && (is_rule || is_inside);
        before = is_row.then_some(line);
        offset += line.len();
    }
    all
}

/// The cells of a line that begins at this place.
fn cells(line: &str, offset: usize) -> Vec<Cell> {
    let mut all = Vec::new();
    let mut from = 0;
    for part in line.split('|') {
        let start = from + (part.len() - part.trim_start().len());
        let text = part.trim().to_string();
        all.push(Cell { span: offset + start..offset + start + text.len(), text });
        from += part.len() + 1;
    }
    // The line begins and ends with a bar.
    let inner = all.len().saturating_sub(1);
    all.into_iter().take(inner).skip(1).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_read() {
        let text = "a\n\n| x | y (s) |\n|---|---|\n| 1 | 2.5 |\n| 2 | 3 |\n\n```text\n| 1 |\n|---|\n```\n\n| z |\n|---|\n| 1 |\ntext\n";
        let all = markdown_tables(text);
        assert_eq!(all.iter().map(|table| table.head.join(";")).collect::<Vec<_>>(), ["x;y (s)"]);
        let found = || all.iter().flat_map(|table| &table.rows);
        let rows: Vec<Vec<&str>> =
            found().map(|row| row.iter().map(|cell| cell.text.as_str()).collect()).collect();
        assert_eq!(rows, [["1", "2.5"], ["2", "3"]]);
        let cell = found().next().and_then(|row| row.get(1)).map(|cell| cell.span.clone());
        assert_eq!(cell.and_then(|span| text.get(span)), Some("2.5"));
    }
}
