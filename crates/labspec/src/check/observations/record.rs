//! What a student saw in a run: what was shown at every sample, and a number that stands for all of it and the picture.

use super::saturated::Beyond;
use crate::run::{Cell, Session};
use labspec_core::Model;
use labspec_expr::Value;

/// A run, as it was seen.
#[derive(Debug)]
pub(in crate::check) struct Record {
    /// The control that was moved before it, and to what; `None` for a button that was pressed.
    pub(in crate::check) moved: Option<(usize, Option<Value>)>,
    /// Time, then traces, then readouts, at every sample.
    pub(in crate::check) rows: Vec<Vec<Cell>>,
    /// Two runs that look the same have the same.
    pub(in crate::check) mark: Mark,
    /// Inputs beyond their range.
    pub(in crate::check) beyond: Beyond,
}

/// A number that follows from others, bit by bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::check) struct Mark(u64);

impl Default for Mark {
    fn default() -> Mark {
        Mark(0xcbf2_9ce4_8422_2325)
    }
}

impl Mark {
    fn add(&mut self, bits: u64) {
        self.0 = (self.0 ^ bits).wrapping_mul(0x0100_0000_01b3).rotate_left(23);
    }

    fn all(&mut self, numbers: &[f64]) {
        numbers.iter().for_each(|x| self.add(x.to_bits()));
    }

    /// A row, and where everything is.
    pub(in crate::check) fn observe(&mut self, row: &[Cell], session: &Session<'_>) {
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
        // Contacts and their forces are drawn, too.
        self.add(data.ncon as u64);
        self.add(data.nefc as u64);
    }

    /// What the model itself looks like, at the end.
    pub(in crate::check) fn close(&mut self, model: &Model) {
        let lists = [&model.geom_size, &model.geom_pos, &model.geom_quat, &model.body_pos, &model.body_quat];
        lists.into_iter().for_each(|list| self.all(list));
        [&model.site_pos, &model.site_quat].into_iter().for_each(|list| self.all(list));
    }
}

/// Whether two cells are the same to the last bit.
pub(super) fn same(a: &Cell, b: &Cell) -> bool {
    match (a, b) {
        (Cell::Number(x), Cell::Number(y)) => x.to_bits() == y.to_bits(),
        _ => a == b,
    }
}
