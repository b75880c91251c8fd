//! How trees are computed: the general way, and the short ones that structure allows, as a table.
//!
//! The general way is that of `kinematics`, `com`, `mass` (composite bodies, elimination of rows) and `rne` (recursion). A
//! short way replaces some of it for trees of its kind, and nothing else; which tree takes which follows from the structure
//! of the model when data are made for it, never from a plan. Any can be forbidden ([`Ways`]): a test holds each against the
//! general one, and `docs/measured/speed.md` says what each is worth.

use super::{articulated, chain, serial, simple};
use crate::model::Model;
use crate::model::way::Way;
use crate::model::way::Ways;

/// A short way.
pub(crate) struct Row {
    pub(crate) way: Way,
    /// Whether a degree of freedom belongs to a tree of its kind.
    covers: fn(&Model, usize) -> bool,
    /// Whether M and the bias force come from it: composite bodies and recursion are not needed then.
    forces: bool,
    /// Whether M of its trees is not needed to solve with it.
    solves_alone: bool,
}

pub(crate) const TABLE: [Row; 4] = [
    Row { way: Way::Simple, covers: simple::covers, forces: true, solves_alone: true },
    Row { way: Way::Chain, covers: chain::covers, forces: true, solves_alone: true },
    Row { way: Way::Serial, covers: serial::covers, forces: false, solves_alone: false },
    Row { way: Way::Articulated, covers: articulated::covers, forces: false, solves_alone: true },
];

fn some(m: &Model, ways: Ways, dof: usize, has: impl Fn(&Row) -> bool) -> bool {
    TABLE.iter().any(|row| ways.has(row.way) && has(row) && (row.covers)(m, dof))
}

/// Whether M and the bias force of a degree of freedom need composite bodies and recursion.
pub(crate) fn needs_bodies(m: &Model, ways: Ways, dof: usize) -> bool {
    !some(m, ways, dof, |row| row.forces)
}

/// Whether accelerations of a degree of freedom are found without the rows of M.
pub(crate) fn solves_alone(m: &Model, ways: Ways, dof: usize) -> bool {
    some(m, ways, dof, |row| row.solves_alone)
}

/// Whether M of a degree of freedom is a constant number.
pub(crate) fn is_simple(m: &Model, ways: Ways, dof: usize) -> bool {
    ways.has(Way::Simple) && simple::covers(m, dof)
}
