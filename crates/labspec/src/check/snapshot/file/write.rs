//! Writes the values that labs display as a text.

use super::super::digits;
use super::super::runs::SnapshotRun;
use super::{FIRST_LINE, MAX_TEXT, MIN_COLUMN_WIDTH, NO_CERTAIN_DIGIT, NO_VALUE, SAME_AS_FIRST_RUN};
use crate::printable::{printable, printable_json};
use crate::run::Cell;
use std::fmt::Write;

/// The text of a file. `name` is that of the lesson, without its folder.
pub(in crate::check::snapshot) fn whole<'t>(name: &str, labs: impl Iterator<Item = &'t str>) -> String {
    let mut text = format!(
        "{FIRST_LINE}\n# What the labs of {} show at 11 times: as they stand, with each slider at its ends, each select at\n# its other options, after each button. A number has the digits that neither half the timestep nor a start moved\n# by 1e-14 changes, at most five ({NO_CERTAIN_DIGIT}: none; {NO_VALUE}: nothing is shown), and matches if it rounds to them.\n# Written by `labspec snapshot`; review changes with `labspec snapshot --review`.\n",
        printable(name)
    );
    let mut count = 0;
    for lab in labs {
        text.push('\n');
        text.push_str(lab);
        count += 1;
    }
    let _ = writeln!(text, "\nend of {count} labs");
    text
}

/// The lines of a lab. Each run is given with the same run under the perturbed numerics that determine the digits.
pub(in crate::check::snapshot) fn lab(
    address: &str,
    title: &str,
    runs: &[(SnapshotRun, Vec<SnapshotRun>)],
) -> String {
    let mut text = format!("lab {} {}\n", quoted(address), quoted(title));
    let mut first = String::new();
    for (run, others) in runs {
        let mut rows = vec![times(run)];
        for (i, (name, cells)) in run.rows.iter().enumerate() {
            let others: Vec<&Vec<Cell>> = others.iter().filter_map(|o| Some(&o.rows.get(i)?.1)).collect();
            rows.push((quoted(name), row(cells, &others)));
        }
        let _ = writeln!(text, "run {}\n  {}", printable(&run.name), run.about.join(", "));
        let mut rows_text = String::new();
        table(&rows, &mut rows_text);
        if rows_text == first {
            rows_text = format!("  {SAME_AS_FIRST_RUN}\n");
        } else if first.is_empty() {
            first.clone_from(&rows_text);
        }
        text.push_str(&rows_text);
    }
    text
}

fn times(run: &SnapshotRun) -> (String, Vec<String>) {
    ("time".into(), run.times.iter().map(|t| crate::verify::significant(*t)).collect())
}

/// The values of a row with the digits that all numerics share.
fn row(cells: &[Cell], others: &[&Vec<Cell>]) -> Vec<String> {
    let numbers: Vec<f64> = cells.iter().filter_map(number).collect();
    let (finest, coarsest) = digits::units(&numbers);
    let one = |(i, cell): (usize, &Cell)| match number(cell).filter(|x| x.is_finite()) {
        None => {
            let text = plain(cell);
            let same = others.iter().all(|o| o.get(i).map(plain).as_ref() == Some(&text));
            if same { text } else { NO_CERTAIN_DIGIT.into() }
        }
        Some(x) => {
            let written_in = |unit: i32| {
                let text = digits::written(x, unit);
                let same = |o: &&Vec<Cell>| {
                    o.get(i)
                        .and_then(number)
                        .is_some_and(|y| y.is_finite() && digits::written(y, unit) == text)
                };
                others.iter().all(same).then_some(text)
            };
            (finest..=coarsest).find_map(written_in).unwrap_or_else(|| NO_CERTAIN_DIGIT.into())
        }
    };
    cells.iter().enumerate().map(one).collect()
}

fn number(cell: &Cell) -> Option<f64> {
    match cell {
        Cell::Number(x) => Some(*x),
        _ => None,
    }
}

/// The text of a value that is not a finite number: a text, a boolean, no value.
pub(in crate::check::snapshot) fn plain(cell: &Cell) -> String {
    match cell {
        Cell::Number(x) => crate::run::rounded(*x, 6),
        Cell::Bool(b) => b.to_string(),
        Cell::Nothing => NO_VALUE.into(),
        Cell::Text(text) if text.chars().count() <= MAX_TEXT => quoted(text),
        Cell::Text(text) => {
            let start: String = text.chars().take(MAX_TEXT).collect();
            let hash = text.bytes().fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
                (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
            });
            quoted(&format!("{start}… ({} bytes, {hash:016x})", text.len()))
        }
    }
}

fn quoted(text: &str) -> String {
    printable_json(&serde_json::Value::from(text).to_string()).into_owned()
}

/// Writes columns: names aligned to the left, numbers to the right.
fn table(rows: &[(String, Vec<String>)], text: &mut String) {
    let width = |text: &str| text.chars().count();
    let names = rows.iter().map(|(name, _)| width(name)).max().unwrap_or(0);
    let columns = rows.iter().map(|(_, cells)| cells.len()).max().unwrap_or(0);
    let widest = |k: usize| rows.iter().filter_map(|(_, cells)| cells.get(k)).map(|c| width(c)).max();
    let widths: Vec<usize> = (0..columns).map(|k| widest(k).unwrap_or(0).max(MIN_COLUMN_WIDTH)).collect();
    for (name, cells) in rows {
        let _ = write!(text, "  {name:names$}");
        for (cell, width) in cells.iter().zip(&widths) {
            let _ = write!(text, "  {cell:>width$}");
        }
        text.push('\n');
    }
}
