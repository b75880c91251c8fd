//! Sets of pairs, and the pairs that a program writes.

use super::table::{CoupledPair, PAIRS};
use labspec_core::reflect::FieldId;
use labspec_expr::Program;

/// A subset of the pairs of the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct PairSet(u32);

impl PairSet {
    pub(crate) const NONE: PairSet = PairSet(0);
    pub(crate) const ALL: PairSet = PairSet(u32::MAX);

    pub(crate) fn is_empty(self) -> bool {
        self.0 == 0
    }

    pub(crate) fn without(self, other: PairSet) -> PairSet {
        PairSet(self.0 & !other.0)
    }

    /// The pairs whose parameter a program may write.
    pub(crate) fn written_by(program: &Program) -> PairSet {
        let set = PAIRS.iter().enumerate().filter(|(_, pair)| writes_field(program, pair.parameter));
        PairSet(set.fold(0, |all, (i, _)| all | 1 << i))
    }

    /// The pairs of the set, each with the set that contains only it.
    pub(crate) fn pairs(self) -> impl Iterator<Item = (PairSet, &'static CoupledPair)> {
        let all = PAIRS.iter().enumerate().map(|(i, pair)| (PairSet(1 << i), pair));
        all.filter(move |(one, _)| self.0 & one.0 != 0)
    }
}

impl FromIterator<PairSet> for PairSet {
    fn from_iter<I: IntoIterator<Item = PairSet>>(sets: I) -> PairSet {
        PairSet(sets.into_iter().fold(0, |all, set| all | set.0))
    }
}

/// Whether a program may write a field of the model.
pub(super) fn writes_field(program: &Program, field: FieldId) -> bool {
    let effects = program.effects();
    effects.writes_everything
        || effects.calls_values
        || effects.writes.iter().any(|a| a.field.0 as usize == field.index())
}
