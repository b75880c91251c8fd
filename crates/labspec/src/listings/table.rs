//! The rows of a Markdown table that displays an output.

use super::compare::{DisplayedLine, Word, word_ranges};
use std::borrow::Cow;
use std::ops::Range;

/// Characters around a value in a cell: code, emphasis, formulas.
const MARKUP: [char; 3] = ['`', '*', '$'];

/// The body rows of a table at the start of a text, with their bytes in it, and the bytes of the whole table. `None` without
/// a head, a line of dashes and a row.
pub(super) fn read_table(text: &str, offset: usize) -> Option<(Vec<DisplayedLine<'_>>, Range<usize>)> {
    let mut lines = Vec::new();
    let mut at = 0;
    for line in text.split_inclusive('\n') {
        let bare = line.trim_start_matches([' ', '\t', '>']).trim_end();
        match (bare.starts_with('|'), bare.is_empty() && lines.is_empty()) {
            (true, _) => {
                let start = at + line.find('|').unwrap_or(0);
                lines.push((bare, start));
            }
            (false, true) => {}
            (false, false) => break,
        }
        at += line.len();
    }
    // A table without rows displays no output.
    let [head, dashes, rows @ ..] = lines.as_slice() else { return None };
    let is_dashes = |cell: Range<usize>| {
        let cell = dashes.0.get(cell).unwrap_or("").trim().trim_matches(':');
        !cell.is_empty() && cell.bytes().all(|b| b == b'-')
    };
    if !cells(dashes.0).into_iter().all(is_dashes) {
        return None;
    }
    let last = rows.last()?;
    let span = offset + head.1..offset + last.1 + last.0.len();
    Some((rows.iter().map(|(row, start)| read_row(row, offset + start)).collect(), span))
}

/// The bytes of the cells of a row.
fn cells(row: &str) -> Vec<Range<usize>> {
    let mut all = Vec::new();
    let mut start = usize::from(row.starts_with('|'));
    let mut escaped = false;
    for (i, c) in row.char_indices().skip(start) {
        if c == '|' && !escaped {
            all.push(start..i);
            start = i + 1;
        }
        escaped = c == '\\' && !escaped;
    }
    if row.get(start..).is_some_and(|rest| !rest.trim().is_empty()) {
        all.push(start..row.len());
    }
    all
}

/// The text of a cell in which a bar is escaped.
fn unescape(text: &str) -> Cow<'_, str> {
    if text.contains("\\|") { text.replace("\\|", "|").into() } else { text.into() }
}

fn read_row(row: &str, offset: usize) -> DisplayedLine<'_> {
    let mut words = Vec::new();
    for cell in cells(row) {
        let text = row.get(cell.clone()).unwrap_or("");
        let inside = text.trim_start().trim_start_matches(MARKUP);
        let start = cell.start + text.len() - inside.len();
        let inside = inside.trim_end().trim_end_matches(MARKUP);
        words.extend(word_ranges(inside).map(|range| Word {
            text: unescape(inside.get(range.clone()).unwrap_or("")),
            span: offset + start + range.start..offset + start + range.end,
        }));
    }
    DisplayedLine { words, span: offset..offset + row.len() }
}

/// The words of the last printed rows, as many as the table has.
pub(super) fn printed_rows<'p>(printed: &[&'p str], rows: usize) -> Vec<Vec<&'p str>> {
    let lines: Vec<&&str> = printed.iter().filter(|line| !line.trim().is_empty()).collect();
    let last = lines.iter().skip(lines.len().saturating_sub(rows));
    last.map(|line| line.split_whitespace().filter(|word| *word != "|").collect()).collect()
}
