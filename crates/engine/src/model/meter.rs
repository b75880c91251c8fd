//! What computing costs: a count of work that is the same on every machine, and a limit beyond which the engine does no
//! more.
//!
//! A unit is about one simple operation, a nanosecond of a fast machine. Stages add what follows from numbers they know
//! anyway: sizes of the model, pairs, rows, iterations. Beyond the limit long loops end early and stages are left out: what
//! the data hold then is of no use, and whoever set the limit has to say so.

use crate::model::Model;

/// The work done, and where it ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Meter {
    pub cost: u64,
    pub limit: u64,
    /// Half of what a forward pass costs without pairs and constraints.
    pub half: u64,
}

impl Default for Meter {
    fn default() -> Meter {
        Meter { cost: 0, limit: u64::MAX, half: 0 }
    }
}

impl Meter {
    /// Nothing done yet, and no limit.
    pub(crate) fn new(m: &Model) -> Meter {
        let linear = 30 * m.nbody + 10 * (m.ngeom + m.nsite + m.neq) + 40 * (m.nv + m.ntendon);
        let more = 60 * m.nactuator + 30 * m.nwrap + 20 * (m.nsensor + m.ncam);
        // A factorization goes through the pairs of entries of each row.
        let rows: u64 = m.M_rownnz.iter().map(|&n| u64::from(n.unsigned_abs()).pow(2)).sum();
        Meter { half: ((200 + linear + more) as u64 + rows) / 2, ..Meter::default() }
    }

    #[cfg_attr(not(feature = "small"), inline(always))]
    pub fn add(&mut self, units: u64) {
        self.cost = self.cost.saturating_add(units);
    }

    /// Whether there is nothing left.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub fn over(&self) -> bool {
        self.cost > self.limit
    }

    /// What a forward pass costs without pairs and constraints.
    pub fn pass(&self) -> u64 {
        2 * self.half
    }

    /// So much more, and no more.
    pub fn set_left(&mut self, units: u64) {
        self.limit = self.cost.saturating_add(units);
    }

    /// What is left.
    pub fn left(&self) -> u64 {
        self.limit.saturating_sub(self.cost)
    }
}
