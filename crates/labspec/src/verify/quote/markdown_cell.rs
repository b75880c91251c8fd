//! The cell of a Markdown table at an index of the file, and the unit of its column.

use super::read::read_quote;
use super::table::rendered;
use super::unit_text::{Link, Unit};
use crate::bind::{behind_heading, of_heading};
use labspec_bind::units;
use labspec_expr::dimension::Dimension;

/// A cell of a Markdown table: its row, and the heading of its column.
pub(super) struct MarkdownCell {
    pub(super) row: String,
    pub(super) head: String,
    /// The cell of the same row in a column of units.
    unit: Option<String>,
}

/// Maximum number of bytes of a row, and of lines of a table.
pub(super) const MAX_ROW_LENGTH: usize = 2000;

const ROWS: usize = 200;

impl MarkdownCell {
    pub(super) fn at(file: &str, offset: usize) -> Option<MarkdownCell> {
        let before = file.get(..offset)?;
        let start = before.rfind('\n').map_or(0, |i| i + 1);
        let end = file.get(offset..)?.find('\n').map_or(file.len(), |i| offset + i);
        let row = file
            .get(start..end)
            .filter(|row| row.trim_start().starts_with('|') && row.len() < MAX_ROW_LENGTH)?;
        let column = file.get(start..offset)?.matches('|').count();
        let mut above = file.get(..start)?.lines().rev().take(ROWS);
        let rule = |line: &str| line.trim_start().starts_with('|') && line.contains("---");
        above.by_ref().take_while(|line| line.trim_start().starts_with('|')).find(|line| rule(line))?;
        let heads = above.next()?;
        let head = heads.split('|').nth(column)?.trim().to_string();
        let of_units = heads.split('|').position(is_head_of_units).filter(|i| *i != column);
        let unit = of_units.and_then(|i| row.split('|').nth(i)).map(|unit| unit.trim().to_string());
        Some(MarkdownCell { row: row.to_string(), head, unit })
    }
}

/// The unit in the heading of the column of a cell.
pub(super) fn unit_of_column(file: &str, offset: usize) -> Option<Unit> {
    let cell = MarkdownCell::at(file, offset)?;
    unit_of_head(&rendered(&cell.head)).or_else(|| unit_of_cell(&rendered(&cell.unit?)))
}

/// The unit of a heading: `error (mm)`, `t [ms]`, `x / mm`, `time in ms`, `depth, mm`, `t (10^-3 s)`.
pub(in crate::verify) fn unit_of_head(head: &str) -> Option<Unit> {
    let unit = |text: &str, dimension| {
        Some(Unit { text: text.to_string(), dimension: Some(dimension), link: Link::Shared })
    };
    if let Some((text, dimension)) = of_heading(head) {
        return unit(text, dimension);
    }
    if let Some((text, dimension)) = behind_heading(head).and_then(compared_unit) {
        return unit(text, dimension);
    }
    // A power of ten times a unit is the unit of the cells. `(10 s)` may be a time of measurement.
    let text = behind_heading(head)?;
    let read = read_quote(text).ok()?;
    let (size, dimension) = (read.number().value, read.unit()?.dimension?);
    let power = text.starts_with("10")
        && text.get(2..)?.trim_start().starts_with(['^', '*', '⁻', '²', '³', '⁴', '⁶', '⁹']);
    (power && size.is_finite() && size > 0.0).then(|| unit(text, dimension.times(1.0 / size))).flatten()
}

/// The unit at the beginning of a text that compares it: `% of earth`, `m above the floor`.
fn compared_unit(text: &str) -> Option<(&str, Dimension)> {
    let (unit, rest) = text.split_at_checked(units::read(text)?.length)?;
    let next = rest.strip_prefix(' ')?.split(' ').next()?;
    let compares = matches!(
        next,
        "of" | "above" | "below" | "over" | "under" | "relative" | "from" | "von" | "de" | "di"
    );
    Some((unit, units::parse(unit)?)).filter(|_| compares)
}

/// Whether a heading is that of a column of units.
pub(super) fn is_head_of_units(head: &str) -> bool {
    const HEADS: [&str; 9] =
        ["unit", "units", "einheit", "einheiten", "unité", "unités", "unidad", "unidades", "unità"];
    HEADS.contains(&head.trim().trim_matches('*').to_lowercase().as_str())
}

/// The unit that a cell of a column of units states.
pub(super) fn unit_of_cell(text: &str) -> Option<Unit> {
    let text = text.trim().trim_matches(['(', ')', '[', ']']);
    units::is_unit(text).then(|| Unit {
        text: text.to_string(),
        dimension: units::parse(text),
        link: Link::Shared,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_in_headings_and_in_columns() {
        for (head, expected) in
            [("speed (% of earth)", "%"), ("height (m above the floor)", "m"), ("t (ms)", "ms")]
        {
            assert_eq!(unit_of_head(head).map(|unit| unit.text).as_deref(), Some(expected), "{head}");
        }
        assert!(unit_of_head("car (A of two)").is_none_or(|unit| unit.text == "A"));
        let text = "| place | speed | unit |\n|---|---|---|\n| Moon | 1.61 | km/h |\n";
        let offset = text.find("1.61").unwrap_or(0);
        assert_eq!(unit_of_column(text, offset).map(|unit| unit.text).as_deref(), Some("km/h"));
    }

    #[test]
    fn a_cell_has_its_column_head() {
        let text = "x\n\n| h (s) | error (mm) |\n|---:|---:|\n| 0.1 | -0.7 |\n| 0.2 | -1.4 |\n";
        let offset = text.find("1.4").unwrap_or(0);
        assert_eq!(MarkdownCell::at(text, offset).map(|c| c.head), Some("error (mm)".into()));
        assert!(MarkdownCell::at("no 1 table", 3).is_none());
    }
}
