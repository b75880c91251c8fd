//! The tables of a lesson: headings and cells as a reader sees them, with their places.

use super::{fold, html};
use std::ops::Range;

/// Most tables of a lesson, and cells of one.
const TABLES: usize = 200;
const CELLS: usize = 5000;

/// What stands in a cell.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct TableCell {
    /// What a reader sees.
    pub(super) text: String,
    /// Its place in the file.
    pub(super) span: Range<usize>,
}

/// A table: its headings, and its rows.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Table {
    /// The headings.
    pub(super) head: Vec<TableCell>,
    /// The rows below the rule.
    pub(super) rows: Vec<Vec<TableCell>>,
}

impl Table {
    /// The place of a column.
    pub(super) fn column(&self, heading: &str) -> Option<usize> {
        let wanted = rendered(heading);
        self.head.iter().position(|cell| cell.text == wanted)
    }
}

/// A text as it is compared: without markup, with one kind of space.
pub(super) fn rendered(text: &str) -> String {
    plain(&html::strip(text).0)
}

/// The same of a text without tags.
fn plain(text: &str) -> String {
    fold::fold(text, true).0.replace(['*', '`'], "").trim().to_string()
}

/// Tables while they are read.
#[derive(Debug, Default)]
pub(super) struct Tables {
    pub(super) all: Vec<Table>,
    row: Vec<TableCell>,
    /// The table at hand is beyond those that are kept.
    beyond: bool,
}

impl Tables {
    pub(super) fn begin(&mut self) {
        self.beyond = self.all.len() >= TABLES;
        if !self.beyond {
            self.all.push(Table::default());
        }
    }

    /// A cell: what a reader sees in it, and its place with the blanks around it.
    pub(super) fn cell(&mut self, cell_text: &str, source: &str, place: Range<usize>) {
        let inner = source.trim_matches(|c: char| c.is_whitespace() || c == '|');
        let start = source.find(inner).map_or(place.start, |at| place.start + at);
        self.row.push(TableCell { text: plain(cell_text), span: start..start + inner.len() });
    }

    pub(super) fn end_head(&mut self) {
        let head = std::mem::take(&mut self.row);
        if let Some(table) = self.all.last_mut().filter(|_| !self.beyond) {
            table.head = head;
        }
    }

    pub(super) fn end_row(&mut self) {
        let row = std::mem::take(&mut self.row);
        if let Some(table) =
            self.all.last_mut().filter(|t| !self.beyond && t.rows.len() * t.head.len() < CELLS)
        {
            table.rows.push(row);
        }
    }
}
