//! Counts the work of computation, identically on every machine, and limits it.
//!
//! A unit is about one simple operation, a nanosecond on a fast machine. Stages add an estimate from numbers that they
//! have anyway: sizes of the model, pairs, rows, iterations. Beyond the limit, long loops end early and stages are left out. The
//! data are then not valid, and the code that set the limit must report this.

use crate::model::Model;

/// The work that was done, and its limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Meter {
    pub cost: u64,
    pub limit: u64,
    /// Half the work of a forward pass without collision pairs and constraints.
    pub half: u64,
}

impl Default for Meter {
    fn default() -> Meter {
        Meter { cost: 0, limit: u64::MAX, half: 0 }
    }
}

impl Meter {
    /// A meter at zero, without a limit.
    pub(crate) fn new(m: &Model) -> Meter {
        let linear = 30 * m.nbody + 10 * (m.ngeom + m.nsite + m.neq) + 40 * (m.nv + m.ntendon);
        let more = 60 * m.nactuator + 30 * m.nwrap + 20 * (m.nsensor + m.ncam);
        // A factorization processes the pairs of entries of each row.
        let rows: u64 = m.M_rownnz.iter().map(|&n| u64::from(n.unsigned_abs()).pow(2)).sum();
        Meter { half: ((200 + linear + more) as u64 + rows) / 2, ..Meter::default() }
    }

    #[cfg_attr(not(feature = "small"), inline(always))]
    pub fn add(&mut self, units: u64) {
        self.cost = self.cost.saturating_add(units);
    }

    /// Whether the limit is exceeded.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub fn over(&self) -> bool {
        self.cost > self.limit
    }

    /// The work of a forward pass without collision pairs and constraints.
    pub fn pass(&self) -> u64 {
        2 * self.half
    }

    /// Limits the further work to this many units.
    pub fn set_left(&mut self, units: u64) {
        self.limit = self.cost.saturating_add(units);
    }

    /// The remaining work.
    pub fn left(&self) -> u64 {
        self.limit.saturating_sub(self.cost)
    }
}
