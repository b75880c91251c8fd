//! Compares stored values with those of a lab: the first value that differs, and the changes of the lab.

use super::digits;
use super::file::{NO_CERTAIN_DIGIT, StoredLab, StoredRun, plain};
use super::picture::picture;
use super::runs::SnapshotRun;
use crate::printable::printable;
use crate::run::Cell;
use crate::verify::significant;
use serde::{Deserialize, Serialize};

/// The first value that differs from the stored one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Divergence {
    /// The run, in words: `as it stands`.
    pub run: String,
    /// The trace or readout, named as in the table of `labspec run`: `plot/0/height`.
    pub trace: String,
    /// Simulated time, s.
    #[serde(with = "crate::verify::float_bits")]
    pub time: f64,
    /// The stored value.
    pub stored: String,
    /// The current value, with one more digit.
    pub current: String,
    /// The tolerance of a number; `None` for other values.
    #[serde(with = "crate::verify::float_bits")]
    pub tolerance: Option<f64>,
    /// The line of the file.
    pub line: usize,
    /// Both curves, drawn with characters.
    pub picture: Vec<String>,
}

/// The difference between a lab and its stored values.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct SnapshotDifference {
    /// The changes of the lab, one clause each.
    pub(super) changes: Vec<String>,
    /// The first value that differs, and the index of its trace or readout in the lab.
    pub(super) first: Option<(Divergence, usize)>,
    /// Number of rows that differ, over all runs.
    pub(super) rows: usize,
    /// Number of values that were compared: those without a certain digit are not.
    pub(super) compared: usize,
}

pub(super) fn compare(stored: &StoredLab, current: &[&SnapshotRun]) -> SnapshotDifference {
    let mut all = SnapshotDifference::default();
    let called = |run: &SnapshotRun| printable(&run.name).into_owned();
    for old in &stored.runs {
        match current.iter().find(|run| called(run) == old.name) {
            None => all.changes.push(format!("the run {} no longer exists", old.name)),
            Some(run) => compare_run(old, run, &mut all),
        }
    }
    let new =
        current.iter().map(|run| called(run)).filter(|name| stored.runs.iter().all(|old| old.name != *name));
    all.changes.extend(new.map(|name| format!("the run {name} is new")));
    all.changes.dedup();
    let mut reported = Vec::new();
    all.changes.retain(|change| {
        let new = !reported.contains(change);
        reported.push(change.clone());
        new
    });
    all
}

fn compare_run(old: &StoredRun, run: &SnapshotRun, all: &mut SnapshotDifference) {
    if old.about.len() == run.about.len() {
        let pairs = old.about.iter().zip(&run.about).filter(|(a, b)| a != b);
        all.changes.extend(pairs.map(|(a, b)| format!("{a} is now {b}")));
    } else {
        all.changes.push(format!("{} is now {}", old.about.join(", "), run.about.join(", ")));
    }
    let far = |(a, b): (&f64, &f64)| (a - b).abs() > 1e-4 * b.abs().max(1e-6);
    let length = |all: &[String]| all.first().cloned();
    let moved = old.times.len() != run.times.len() || old.times.iter().zip(&run.times).any(far);
    if moved && length(&old.about) == length(&run.about) {
        let list = |times: &[f64]| times.iter().map(|t| significant(*t)).collect::<Vec<_>>().join(" ");
        all.changes.push(format!("the times {} are now {}", list(&old.times), list(&run.times)));
    }
    // Values at other times cannot be compared.
    let names = pairs(old, run, moved, all);
    let mut first: Option<(usize, usize, usize)> = None;
    if !moved {
        for &(i, j) in &names {
            let (Some(row), Some((_, cells))) = (old.rows.get(i), run.rows.get(j)) else { continue };
            all.compared +=
                row.cells.iter().zip(cells).filter(|(stored, _)| *stored != NO_CERTAIN_DIGIT).count();
            let wrong = row.cells.iter().zip(cells).position(|(stored, cell)| !agrees(stored, cell));
            let Some(k) = wrong else { continue };
            all.rows += 1;
            if first.is_none_or(|(_, _, before)| k < before) {
                first = Some((i, j, k));
            }
        }
    }
    if let (None, Some((i, j, k))) = (&all.first, first) {
        all.first = divergence(old, run, i, j, k).map(|found| (found, j));
    }
}

/// Pairs stored rows with those of the run: by name, and rows of equal name in order. Rows without a pair are changes.
fn pairs(
    old: &StoredRun,
    run: &SnapshotRun,
    moved: bool,
    all: &mut SnapshotDifference,
) -> Vec<(usize, usize)> {
    let mut free: Vec<usize> = (0..run.rows.len()).collect();
    let (mut pairs, mut lost) = (Vec::new(), Vec::new());
    for (i, row) in old.rows.iter().enumerate() {
        let named = free.iter().position(|&j| run.rows.get(j).is_some_and(|(name, _)| *name == row.name));
        match named {
            Some(index) => pairs.push((i, free.remove(index))),
            None => lost.push(i),
        }
    }
    for i in lost {
        let Some(row) = old.rows.get(i) else { continue };
        let same = |j: &usize| {
            let cells = run.rows.get(*j).map(|(_, cells)| cells);
            cells.is_some_and(|cells| row.cells.iter().zip(cells).all(|(a, b)| agrees(a, b)))
        };
        let name = named(&row.name);
        match free.iter().position(same).filter(|_| !moved) {
            Some(index) => {
                let new = run.rows.get(free.remove(index)).map_or("", |(name, _)| name);
                all.changes.push(format!("{name} is now called {}", named(new)));
            }
            None => all.changes.push(format!("{name} is no longer shown")),
        }
    }
    let new = free.iter().filter_map(|&j| run.rows.get(j)).map(|(name, _)| format!("{} is new", named(name)));
    all.changes.extend(new);
    pairs
}

fn named(name: &str) -> String {
    format!("\"{}\"", printable(name))
}

/// Whether a value equals the stored one.
fn agrees(stored: &str, current: &Cell) -> bool {
    match (digits::read(stored), current) {
        _ if stored == NO_CERTAIN_DIGIT => true,
        (Some((x, unit)), Cell::Number(y)) => (x - y).abs() <= digits::tolerance(unit),
        (None, cell) => {
            let plain = plain(cell);
            // The file may have been written with other escapes.
            let text = |t: &str| serde_json::from_str::<String>(t).ok();
            !matches!(cell, Cell::Number(x) if x.is_finite())
                && (stored == plain || text(stored).is_some_and(|t| text(&plain) == Some(t)))
        }
        _ => false,
    }
}

fn divergence(old: &StoredRun, run: &SnapshotRun, i: usize, j: usize, k: usize) -> Option<Divergence> {
    let (row, (name, cells)) = (old.rows.get(i)?, run.rows.get(j)?);
    let (stored, cell) = (row.cells.get(k)?, cells.get(k)?);
    let unit = digits::read(stored).map(|(_, unit)| unit);
    let current = match (cell, unit) {
        (Cell::Number(x), Some(unit)) if x.is_finite() => digits::written(*x, unit - 1),
        (Cell::Number(x), None) if x.is_finite() => significant(*x),
        _ => plain(cell),
    };
    let before: Vec<f64> = row.cells.iter().map(|c| digits::read(c).map_or(f64::NAN, |(x, _)| x)).collect();
    let after: Vec<f64> = cells.iter().map(Cell::number).collect();
    Some(Divergence {
        run: old.name.clone(),
        trace: name.clone(),
        time: run.times.get(k).copied()?,
        stored: stored.clone(),
        current,
        tolerance: unit.map(|unit| 0.5 * digits::ten(unit)),
        line: row.line,
        picture: picture(&run.times, &before, &after),
    })
}
