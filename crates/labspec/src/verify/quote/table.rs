//! The tables of a lesson: headings and cells as a reader sees them, with their places.

use super::{fold, html};
use crate::spec::Lesson;
use std::ops::Range;

/// Most tables of a lesson, and cells of one.
const TABLES: usize = 200;
const CELLS: usize = 5000;

/// What stands in a cell.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Cell {
    /// What a reader sees.
    pub(super) text: String,
    /// Its place in the file.
    pub(super) span: Range<usize>,
}

/// A table: its headings, and its rows.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Table {
    /// The headings.
    pub(super) head: Vec<Cell>,
    /// The rows below the rule.
    pub(super) rows: Vec<Vec<Cell>>,
}

impl Table {
    /// The place of a column.
    pub(super) fn column(&self, heading: &str) -> Option<usize> {
        let wanted = shown(heading);
        self.head.iter().position(|cell| cell.text == wanted)
    }
}

/// A text as it is compared: without markup, with one kind of space.
pub(super) fn shown(text: &str) -> String {
    let (text, _) = html::strip(text);
    let (text, _) = fold::fold(&text, true);
    text.replace(['*', '`'], "").trim().to_string()
}

/// All tables outside of fences: a row of headings, a rule, and rows, each a line that begins with a bar.
pub(super) fn tables(lesson: &Lesson) -> Vec<Table> {
    let text = lesson.file.text();
    let fenced = |at: usize| lesson.scan.blocks.iter().any(|b| b.span.start <= at && at < b.span.end);
    let (mut all, mut at) = (Vec::new(), 0);
    // The line before, and the table that goes on.
    let (mut before, mut open): (Option<Vec<Cell>>, Option<Table>) = (None, None);
    for line in text.split_inclusive('\n') {
        let start = at;
        at += line.len();
        let row = line.trim_start().starts_with('|') && !fenced(start);
        if !row || all.len() > TABLES {
            all.extend(open.take());
            before = None;
            continue;
        }
        let rule = line.contains('-') && line.trim().chars().all(|c| "|-: ".contains(c));
        match (&mut open, before.take()) {
            (Some(table), _) if table.rows.len() * table.head.len() < CELLS => {
                table.rows.push(cells(line, start))
            }
            (Some(_), _) => {}
            (None, Some(head)) if rule => open = Some(Table { head, rows: Vec::new() }),
            (None, _) => before = Some(cells(line, start)),
        }
    }
    all.extend(open);
    all
}

/// The cells of a line that begins at this byte. A bar behind a backslash is a letter.
fn cells(line: &str, start: usize) -> Vec<Cell> {
    let (mut all, mut from, mut escaped) = (Vec::new(), None, false);
    let end = line.trim_end().len();
    for (i, c) in line.char_indices().take_while(|(i, _)| *i < end) {
        if c == '|' && !escaped {
            if let Some(from) = from {
                all.extend(cell(line, start, from, i));
            }
            from = Some(i + 1);
        }
        escaped = c == '\\' && !escaped;
    }
    if let Some(from) = from.filter(|from| *from < end) {
        all.extend(cell(line, start, from, end));
    }
    all
}

fn cell(line: &str, start: usize, from: usize, to: usize) -> Option<Cell> {
    let inside = line.get(from..to)?;
    let lead = inside.len() - inside.trim_start().len();
    let text = inside.trim();
    let at = start + from + lead;
    Some(Cell { text: shown(text), span: at..at + text.len() })
}
