//! The record of a run: the displayed values of every sample, and a hash of them and of the picture.

use crate::run::{Cell, Session};
use labspec_core::Model;
use labspec_expr::Value;
use std::ops::Range;

/// The record of a run.
#[derive(Debug)]
pub(crate) struct Record {
    /// The control that was moved before it, and its value; `None` for a button that was pressed.
    pub(crate) moved: Option<(usize, Option<Value>)>,
    /// Time, then traces, then readouts, for every sample.
    pub(crate) rows: Vec<Vec<Cell>>,
    /// A hash that is equal for runs that look the same.
    pub(crate) hash: ObservationHash,
    /// Inputs outside of their range.
    pub(crate) beyond: InputsOutOfRange,
}

/// A hash of the bits that a run displays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct ObservationHash(u64);

impl Default for ObservationHash {
    fn default() -> ObservationHash {
        ObservationHash(0xcbf2_9ce4_8422_2325)
    }
}

impl ObservationHash {
    fn add(&mut self, bits: u64) {
        self.0 = (self.0 ^ bits).wrapping_mul(0x0100_0000_01b3).rotate_left(23);
    }

    fn all(&mut self, numbers: &[f64]) {
        numbers.iter().for_each(|x| self.add(x.to_bits()));
    }

    /// Adds a row, and the positions of all objects.
    pub(crate) fn observe(&mut self, row: &[Cell], session: &Session<'_>) {
        for cell in row {
            match cell {
                Cell::Number(x) => self.add(x.to_bits()),
                Cell::Bool(b) => self.add(u64::from(*b)),
                Cell::Text(text) => text.bytes().for_each(|b| self.add(u64::from(b))),
                Cell::Nothing => self.add(u64::MAX),
            }
        }
        let data = session.world.data.fields();
        [&data.qpos, &data.mocap_pos, &data.mocap_quat].into_iter().for_each(|list| self.all(list));
        // Contacts and their forces are drawn too.
        self.add(data.ncon as u64);
        self.add(data.nefc as u64);
    }

    /// Adds the geometry of the model at the end of the run.
    pub(crate) fn close(&mut self, model: &Model) {
        let lists = [&model.geom_size, &model.geom_pos, &model.geom_quat, &model.body_pos, &model.body_quat];
        lists.into_iter().for_each(|list| self.all(list));
        [&model.site_pos, &model.site_quat].into_iter().for_each(|list| self.all(list));
    }
}

/// Whether two cells are equal bit for bit.
pub(crate) fn same(a: &Cell, b: &Cell) -> bool {
    match (a, b) {
        (Cell::Number(x), Cell::Number(y)) => x.to_bits() == y.to_bits(),
        _ => a == b,
    }
}

/// Inputs that were outside of their range, with a value of each.
#[derive(Debug, Default)]
pub(crate) struct InputsOutOfRange {
    pub(crate) looks: usize,
    /// For each input, the number of samples outside of its range, and its last value there.
    pub(crate) times: Vec<(usize, f64)>,
}

impl InputsOutOfRange {
    /// Checks the inputs of a step.
    pub(crate) fn observe(&mut self, session: &Session<'_>) {
        let (model, data) = (&session.world.model, session.world.data.fields());
        self.looks += 1;
        self.times.resize(data.ctrl.len(), (0, 0.0));
        for (i, (value, times)) in data.ctrl.iter().zip(&mut self.times).enumerate() {
            let limited = model.actuator_ctrllimited.get(i).is_some_and(|l| *l);
            let [low, high] = [0, 1].map(|k| model.actuator_ctrlrange.get(2 * i + k).copied().unwrap_or(0.0));
            if limited && !(low..=high).contains(value) {
                *times = (times.0 + 1, *value);
            }
        }
    }
}

/// The cells of a column in all runs.
pub(crate) fn column(records: &[Record], column: usize) -> impl Iterator<Item = &Cell> {
    records.iter().flat_map(|r| &r.rows).filter_map(move |row| row.get(column))
}

/// The number that a column displays, if it is constant.
pub(crate) fn constant<'r>(mut cells: impl Iterator<Item = &'r Cell>) -> Option<&'r Cell> {
    let first = cells.next().filter(|c| matches!(c, Cell::Number(x) if x.is_finite()))?;
    cells.all(|c| same(c, first)).then_some(first)
}

/// The longest range of equal items, the first of several; empty where there are none.
pub(crate) fn longest_equal<T: PartialEq>(items: &[T]) -> Range<usize> {
    let (mut best, mut start) = (0..0, 0);
    for i in 1..=items.len() {
        if items.get(i) != items.get(start) {
            if i - start > best.len() {
                best = start..i;
            }
            start = i;
        }
    }
    best
}
