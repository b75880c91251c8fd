//! Visible differences between two runs of a lab: traces, readouts and coordinates, beyond rounding.

use crate::bind::Programs;
use crate::run::{self, Cell};
use crate::spec::Lab;
use labspec_expr::Value;

/// A difference below this fraction of the range of a trace is not visible.
const VISIBLE: f64 = 1e-9;
/// A difference below this fraction of the largest value is rounding.
const ROUNDING: f64 = 1e-12;

/// A sample that differs between two runs.
pub(super) struct SampleDifference {
    name: String,
    time: f64,
    cells: (Cell, Cell),
}

impl SampleDifference {
    /// The difference in words; `anew` describes the second run.
    pub(super) fn describe(&self, trial: &str, anew: &str) -> String {
        let (x, y) = match &self.cells {
            (Cell::Number(x), Cell::Number(y)) => {
                // As many digits as are needed to distinguish them.
                let printed = |n| (digits(*x, n), digits(*y, n));
                (4..17).map(printed).find(|(a, b)| a != b).unwrap_or_else(|| printed(17))
            }
            (x, y) => (x.rounded(4), y.rounded(4)),
        };
        format!("{trial}, {} is {x} at t = {} s, but {y} with {anew}", self.name, digits(self.time, 6))
    }
}

/// The columns of a run: time, traces, readouts, and coordinates where they are sampled.
pub(super) struct RunColumns<'a> {
    /// Whether coordinates are compared besides displayed values.
    pub(super) whole: bool,
    pub(super) lab: &'a Lab,
    pub(super) programs: &'a Programs,
}

/// Fraction of the range by which a wrong coupled parameter must change a displayed value; numerics of a lab cause smaller
/// changes.
const MIN_RELATIVE_CHANGE: f64 = 1e-3;
/// Factor by which the change must exceed that of a perturbed start.
pub(super) const PERTURBATION_FACTOR: f64 = 10.0;

/// The largest difference of two runs in a column.
#[derive(Clone, Copy, Debug, Default)]
struct LargestDifference {
    most: f64,
    range: f64,
    largest: f64,
    time: f64,
    cells: [f64; 2],
}

/// The largest difference of two runs in a column of numbers.
fn largest_difference(a: &[Vec<Cell>], b: &[Vec<Cell>], column: usize) -> LargestDifference {
    let (mut low, mut high, mut found) = (f64::INFINITY, f64::NEG_INFINITY, LargestDifference::default());
    for (x, y) in a.iter().zip(b) {
        let (Some(time), Some(Cell::Number(x)), Some(Cell::Number(y))) =
            (x.first(), x.get(column), y.get(column))
        else {
            continue;
        };
        if !(x.is_finite() && y.is_finite()) {
            continue;
        }
        (low, high) = (low.min(*x).min(*y), high.max(*x).max(*y));
        let by = (x - y).abs();
        if by > found.most {
            found = LargestDifference { most: by, time: time.number(), cells: [*x, *y], ..found };
        }
    }
    LargestDifference { range: high - low, largest: low.abs().max(high.abs()), ..found }
}

impl RunColumns<'_> {
    /// The largest difference of two runs beyond the effect of numerics: first in displayed values, then in coordinates.
    /// `noise` repeats the first run under perturbed numerics, each with the factor by which a difference must exceed its
    /// effect.
    pub(super) fn mismatch(
        &self,
        a: &[Vec<Cell>],
        b: &[Vec<Cell>],
        noise: impl FnOnce() -> Option<Vec<(Vec<Vec<Cell>>, f64)>>,
    ) -> Option<SampleDifference> {
        let width = a.first().map_or(0, Vec::len);
        let all = (1..width).map(|column| (column, largest_difference(a, b, column)));
        let seen =
            |d: &LargestDifference| d.most > MIN_RELATIVE_CHANGE * d.range && d.most > ROUNDING * d.largest;
        let found: Vec<(usize, LargestDifference)> = all.filter(|(_, d)| seen(d)).collect();
        if found.is_empty() {
            return None;
        }
        let noise = noise()?;
        let beyond = |(column, d): &(usize, LargestDifference)| {
            noise.iter().all(|(other, factor)| d.most > factor * largest_difference(a, other, *column).most)
        };
        let coordinate = |column: usize| column > self.programs.probes.len();
        let part = |d: &LargestDifference| d.most / d.range;
        let (column, d) = found
            .into_iter()
            .filter(beyond)
            .max_by(|(i, x), (j, y)| coordinate(*j).cmp(&coordinate(*i)).then(part(x).total_cmp(&part(y))))?;
        let cells = d.cells.map(Cell::Number);
        Some(SampleDifference { name: self.column(column), time: d.time, cells: cells.into() })
    }

    /// Whether no number of two runs differs by more than this fraction of the range of its column.
    pub(super) fn close(&self, a: &[Vec<Cell>], b: &[Vec<Cell>], part: f64) -> bool {
        let width = a.first().map_or(0, Vec::len);
        let near = |d: LargestDifference| d.most <= part * d.range || d.most <= ROUNDING * d.largest;
        a.len() == b.len() && (1..width).all(|column| near(largest_difference(a, b, column)))
    }

    /// The largest visible difference of two runs in displayed values, or in coordinates if the lab displays nothing.
    pub(super) fn difference(&self, a: &[Vec<Cell>], b: &[Vec<Cell>]) -> Option<SampleDifference> {
        let width = a.first().map_or(0, Vec::len);
        let width = if self.whole { width } else { width.min(1 + self.programs.probes.len()) };
        let mut worst: Option<(f64, SampleDifference)> = None;
        for column in 1..width {
            let cells =
                || a.iter().zip(b).filter_map(|(x, y)| Some((x.first()?, x.get(column)?, y.get(column)?)));
            let numbers = cells().flat_map(|(_, x, y)| [x.number(), y.number()]).filter(|x| x.is_finite());
            let (low, high) =
                numbers.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
            let (range, largest) = (high - low, low.abs().max(high.abs()));
            for (time, x, y) in cells() {
                let Some(size) = self.visible(column, x, y, range, largest) else { continue };
                if worst.as_ref().is_none_or(|(most, _)| size > *most) {
                    let name = self.column(column);
                    worst = Some((
                        size,
                        SampleDifference { name, time: time.number(), cells: (x.clone(), y.clone()) },
                    ));
                }
            }
        }
        worst.map(|(_, d)| d)
    }

    /// The difference of two samples as a fraction of the range; `None` when it is not visible.
    fn visible(&self, column: usize, x: &Cell, y: &Cell, range: f64, largest: f64) -> Option<f64> {
        let (Cell::Number(p), Cell::Number(q)) = (x, y) else { return (x != y).then_some(1.0) };
        if !(p.is_finite() && q.is_finite()) {
            return (p.to_bits() != q.to_bits() && !(p.is_nan() && q.is_nan())).then_some(1.0);
        }
        if p == q {
            return None;
        }
        let difference = (p - q).abs();
        let printed = || {
            let readout = column.checked_sub(1 + self.lab.traces().count());
            let readout = readout.and_then(|i| self.lab.readouts.get(i));
            readout.is_some_and(|r| run::rounded(*p, r.digits()) != run::rounded(*q, r.digits()))
        };
        let seen = difference > VISIBLE * range || printed();
        (seen && difference > ROUNDING * largest).then_some(difference / range)
    }

    /// The name of a column.
    fn column(&self, column: usize) -> String {
        match self.programs.probes.get(column - 1) {
            Some(probe) => {
                // A name has the form `plot/0/label` or `readout/label`; the label itself may contain slashes.
                let (kind, rest) = probe.name.split_once('/').unwrap_or(("", &probe.name));
                let label = if kind == "plot" { rest.split_once('/').map_or(rest, |(_, l)| l) } else { rest };
                format!("\"{label}\"")
            }
            None => format!("data.qpos[{}]", column - 1 - self.programs.probes.len()),
        }
    }
}

/// A number with `count` significant digits, without trailing zeros.
pub(crate) fn digits(x: f64, count: usize) -> String {
    let rounded: f64 = format!("{x:.*e}", count.saturating_sub(1)).parse().unwrap_or(x);
    Value::Number(rounded).to_string()
}
