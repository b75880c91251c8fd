//! The tables of a lesson: rendered headings and cells, with their spans.

use super::{fold, html};
use std::ops::Range;

/// Maximum number of tables of a lesson, and of cells of one table.
const TABLES: usize = 200;
const CELLS: usize = 5000;

/// A cell of a table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct TableCell {
    /// The rendered text.
    pub(super) text: String,
    /// Its span in the file.
    pub(super) span: Range<usize>,
}

/// A table: its headings, and its rows.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct RenderedTable {
    /// The headings.
    pub(super) head: Vec<TableCell>,
    /// The rows after the heading.
    pub(super) rows: Vec<Vec<TableCell>>,
}

impl RenderedTable {
    /// The index of a column.
    pub(super) fn column(&self, heading: &str) -> Option<usize> {
        let heading_text = rendered(heading);
        self.head.iter().position(|cell| cell.text == heading_text)
    }
}

/// A text in the form in which texts are compared: without markup, with normalized spaces.
pub(super) fn rendered(text: &str) -> String {
    plain(&html::strip(text).0)
}

/// Like [`rendered`], for a text without tags.
fn plain(text: &str) -> String {
    fold::fold(text, true).0.replace(['*', '`'], "").trim().to_string()
}

/// Tables while they are read.
#[derive(Debug, Default)]
pub(super) struct Tables {
    pub(super) all: Vec<RenderedTable>,
    row: Vec<TableCell>,
    /// Whether the current table exceeds the maximum number.
    beyond: bool,
}

impl Tables {
    pub(super) fn begin(&mut self) {
        self.beyond = self.all.len() >= TABLES;
        if !self.beyond {
            self.all.push(RenderedTable::default());
        }
    }

    /// Adds a cell: its rendered text, and its range including the spaces around it.
    pub(super) fn cell(&mut self, cell_text: &str, source: &str, place: Range<usize>) {
        let inner = source.trim_matches(|c: char| c.is_whitespace() || c == '|');
        let start = source.find(inner).map_or(place.start, |offset| place.start + offset);
        self.row.push(TableCell { text: plain(cell_text), span: start..start + inner.len() });
    }

    pub(super) fn end_head(&mut self) {
        let head = std::mem::take(&mut self.row);
        if let Some(table) = self.all.last_mut().filter(|_| !self.beyond) {
            table.head = head;
        }
    }

    /// Adds the tables of printed output: consecutive lines with the same number of columns, and the line of headings before them.
    /// Each line has its start in the file.
    pub(super) fn printed(&mut self, lines: &[(String, usize)]) {
        let rows: Vec<Vec<TableCell>> = lines.iter().map(|(line, start)| printed_row(line, *start)).collect();
        let mut from = 0;
        while let Some(first) = rows.get(from) {
            let columns = first.len();
            let count = rows.iter().skip(from).take_while(|row| row.len() == columns).count();
            if columns >= 2 {
                self.begin();
                let before = from.checked_sub(1).and_then(|i| lines.get(i));
                let printed = is_heading(first).then(|| first.clone());
                let headings = printed
                    .clone()
                    .or_else(|| before.and_then(|(line, start)| headings(line, *start, columns)));
                self.row = headings.unwrap_or_default();
                self.end_head();
                for row in rows.iter().skip(from).take(count).skip(usize::from(printed.is_some())) {
                    self.row.clone_from(row);
                    self.end_row();
                }
            }
            from += count.max(1);
        }
    }

    pub(super) fn end_row(&mut self) {
        let row = std::mem::take(&mut self.row);
        if let Some(table) =
            self.all.last_mut().filter(|t| !self.beyond && t.rows.len() * t.head.len().max(row.len()) < CELLS)
        {
            table.rows.push(row);
        }
    }
}

/// The parts of a line with their starts, split where `is_end` holds.
fn split(line: &str, line_start: usize, separator: impl Fn(&str) -> Option<usize>) -> Vec<TableCell> {
    let mut cells = Vec::new();
    let (mut start, mut i) = (0, 0);
    let mut push = |from: usize, to: usize| {
        let part = line.get(from..to).unwrap_or("");
        let inner = part.trim();
        let offset = part.find(inner).unwrap_or(0);
        if !inner.is_empty() {
            let begin = line_start + from + offset;
            cells.push(TableCell { text: plain(inner), span: begin..begin + inner.len() });
        }
    };
    while let Some(rest) = line.get(i..).filter(|rest| !rest.is_empty()) {
        match separator(rest) {
            Some(length) => {
                push(start, i);
                i += length;
                start = i;
            }
            None => i += rest.chars().next().map_or(1, char::len_utf8),
        }
    }
    push(start, line.len());
    cells
}

/// The words of a line.
fn split_words(line: &str, start: usize) -> Vec<TableCell> {
    split(line, start, |rest| {
        rest.starts_with(char::is_whitespace).then(|| rest.chars().next().map_or(1, char::len_utf8))
    })
}

/// The parts of a line between wide gaps, tabs and bars.
fn split_columns(line: &str, start: usize) -> Vec<TableCell> {
    split(line, start, |rest| {
        let wide = rest.starts_with("  ").then_some(2);
        wide.or_else(|| rest.starts_with(['\t', '|']).then_some(1))
    })
}

/// Whether a cell is a number.
fn is_number(cell: &TableCell) -> bool {
    let text = cell.text.trim_start_matches(['-', '+', '−']);
    text.starts_with(|c: char| c.is_ascii_digit())
        && text.chars().all(|c| c.is_ascii_digit() || ".,eE+-%".contains(c))
}

/// The cells of a printed line: its words if all but the first are numbers, otherwise its parts between wide gaps.
fn printed_row(line: &str, start: usize) -> Vec<TableCell> {
    let all = split_words(line, start);
    if all.len() >= 2 && all.iter().skip(1).all(is_number) { all } else { split_columns(line, start) }
}

/// Whether a row consists of headings.
fn is_heading(row: &[TableCell]) -> bool {
    !row.iter().any(is_number)
}

/// The headings in the line before a table.
fn headings(line: &str, start: usize, count: usize) -> Option<Vec<TableCell>> {
    [split_columns(line, start), split_words(line, start)]
        .into_iter()
        .find(|row| row.len() == count && is_heading(row))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn printed(text: &str) -> Vec<(Vec<String>, Vec<Vec<String>>)> {
        let mut offset = 0;
        let lines: Vec<(String, usize)> = text
            .split_inclusive('\n')
            .map(|line| {
                offset += line.len();
                (line.trim_end().to_string(), offset - line.len())
            })
            .collect();
        let mut tables = Tables::default();
        tables.printed(&lines);
        let texts = |row: &Vec<TableCell>| row.iter().map(|cell| cell.text.clone()).collect::<Vec<_>>();
        for cell in tables.all.iter().flat_map(|t| t.head.iter().chain(t.rows.iter().flatten())) {
            assert_eq!(text.get(cell.span.clone()).map(plain).as_deref(), Some(cell.text.as_str()));
        }
        tables.all.iter().map(|t| (texts(&t.head), t.rows.iter().map(texts).collect())).collect()
    }

    #[test]
    fn output_is_read_as_tables() {
        let strings = |list: &[&str]| list.iter().map(|s| (*s).to_string()).collect::<Vec<String>>();
        let rows = |rows: &[&[&str]]| rows.iter().map(|row| strings(row)).collect::<Vec<_>>();
        assert_eq!(
            printed("start (rad)   period (s)\n0.1           1.421\n1.0           1.515\n"),
            [(strings(&["start (rad)", "period (s)"]), rows(&[&["0.1", "1.421"], &["1.0", "1.515"]]))]
        );
        assert_eq!(
            printed("h t error\n0.001 0.3 -0.7\n0.002 0.3 -1.4\ndone\n"),
            [(strings(&["h", "t", "error"]), rows(&[&["0.001", "0.3", "-0.7"], &["0.002", "0.3", "-1.4"]]))]
        );
        assert_eq!(
            printed("Euler 0.3 0.5\nRK4 0.1 0.2\n"),
            [(vec![], rows(&[&["Euler", "0.3", "0.5"], &["RK4", "0.1", "0.2"]]))]
        );
        assert_eq!(printed("a | b\n1 | 2\n"), [(strings(&["a", "b"]), rows(&[&["1", "2"]]))]);
        assert_eq!(printed("It took 3 s.\n\nfine\n"), []);
    }
}
