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
