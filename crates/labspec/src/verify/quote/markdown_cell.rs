//! The cell of a Markdown table at an index of the file, and the unit of its column.

use super::read::read_quote;
use super::table::rendered;
use super::unit_text::{Link, Unit};
use crate::bind::{behind_heading, of_heading};

/// A cell of a Markdown table: its row, and the heading of its column.
pub(super) struct MarkdownCell {
    pub(super) row: String,
    pub(super) head: String,
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
        let head = above.next()?.split('|').nth(column)?.trim().to_string();
        Some(MarkdownCell { row: row.to_string(), head })
    }
}

/// The unit in the heading of the column of a cell.
pub(super) fn unit_of_column(file: &str, offset: usize) -> Option<Unit> {
    unit_of_head(&rendered(&MarkdownCell::at(file, offset)?.head))
}

/// The unit of a heading: `error (mm)`, `t [ms]`, `x / mm`, `time in ms`, `depth, mm`, `t (10^-3 s)`.
pub(in crate::verify) fn unit_of_head(head: &str) -> Option<Unit> {
    let unit = |text: &str, dimension| {
        Some(Unit { text: text.to_string(), dimension: Some(dimension), link: Link::Shared })
    };
    if let Some((text, dimension)) = of_heading(head) {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cell_has_its_column_head() {
        let text = "x\n\n| h (s) | error (mm) |\n|---:|---:|\n| 0.1 | -0.7 |\n| 0.2 | -1.4 |\n";
        let offset = text.find("1.4").unwrap_or(0);
        assert_eq!(MarkdownCell::at(text, offset).map(|c| c.head), Some("error (mm)".into()));
        assert!(MarkdownCell::at("no 1 table", 3).is_none());
    }
}
