//! What a reader would see differ between two runs of a lab: traces, readouts, coordinates, beyond rounding.

use crate::bind::Programs;
use crate::run::{self, Cell};
use crate::spec::Lab;
use labspec_expr::Value;

/// A difference that cannot be seen, of the range of a trace.
const VISIBLE: f64 = 1e-9;
/// A difference that rounding makes, of the largest value.
const ROUNDING: f64 = 1e-12;

/// A sample that differs between the lab as it is and with its constants computed anew.
pub(super) struct Difference {
    name: String,
    time: f64,
    cells: (Cell, Cell),
}

impl Difference {
    pub(super) fn said(&self, trial: &str) -> String {
        let (x, y) = match &self.cells {
            (Cell::Number(x), Cell::Number(y)) => {
                // As many digits as tell them apart.
                let shown = |n| (digits(*x, n), digits(*y, n));
                (4..17).map(shown).find(|(a, b)| a != b).unwrap_or_else(|| shown(17))
            }
            (x, y) => (x.shown(4), y.shown(4)),
        };
        format!(
            "{trial}, {} is {x} at t = {} s, and {y} with the constants computed anew",
            self.name,
            digits(self.time, 6)
        )
    }
}

/// What the columns of a run are: time, traces, readouts, and coordinates where they are sampled.
pub(super) struct Columns<'a> {
    pub(super) lab: &'a Lab,
    pub(super) programs: &'a Programs,
}

impl Columns<'_> {
    /// The largest visible difference of two runs.
    pub(super) fn difference(&self, a: &[Vec<Cell>], b: &[Vec<Cell>]) -> Option<Difference> {
        let width = a.first().map_or(0, Vec::len);
        let mut worst: Option<(f64, Difference)> = None;
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
                    worst =
                        Some((size, Difference { name, time: time.number(), cells: (x.clone(), y.clone()) }));
                }
            }
        }
        worst.map(|(_, d)| d)
    }

    /// How much of the range two samples differ by; `None` when nobody can see it.
    fn visible(&self, column: usize, x: &Cell, y: &Cell, range: f64, largest: f64) -> Option<f64> {
        let (Cell::Number(p), Cell::Number(q)) = (x, y) else { return (x != y).then_some(1.0) };
        if !(p.is_finite() && q.is_finite()) {
            return (p.to_bits() != q.to_bits() && !(p.is_nan() && q.is_nan())).then_some(1.0);
        }
        let apart = (p - q).abs();
        let readout =
            column.checked_sub(1 + self.lab.traces().count()).and_then(|i| self.lab.readouts.get(i));
        let printed = readout.is_some_and(|r| run::shown(*p, r.digits()) != run::shown(*q, r.digits()));
        let seen = apart > VISIBLE * range || printed;
        (seen && apart > ROUNDING * largest).then_some(apart / range)
    }

    /// What a column is called.
    fn column(&self, column: usize) -> String {
        match self.programs.probes.get(column - 1) {
            Some(probe) => format!("\"{}\"", probe.name.splitn(3, '/').last().unwrap_or("")),
            None => format!("data.qpos[{}]", column - 1 - self.programs.probes.len()),
        }
    }
}

/// A number with so many significant digits, without trailing zeros.
pub(in crate::check) fn digits(x: f64, count: usize) -> String {
    let rounded: f64 = format!("{x:.*e}", count.saturating_sub(1)).parse().unwrap_or(x);
    Value::Number(rounded).to_string()
}
