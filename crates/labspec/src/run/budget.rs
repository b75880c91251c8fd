//! How much work a run may do, and how it ends before its time.

/// Work, in units of about a nanosecond of a fast machine. It is counted, not measured: the same run ends at the same
/// place everywhere.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Budget {
    /// What may still be done.
    pub left: u64,
}

impl Budget {
    /// For a run that somebody asked for.
    pub const ASKED: Budget = Budget { left: 100_000_000_000 };
    /// For a run that a check makes to see what breaks.
    pub const TRIAL: Budget = Budget { left: 1_000_000_000 };
    /// For all such runs of a file.
    pub const FILE: Budget = Budget { left: 3_000_000_000 };
    /// For one of the many runs of a comparison.
    pub const COMPARED: Budget = Budget { left: 2_000_000_000 };
    /// What a trace, a readout or a measure may do at a sample: a page computes it for every frame.
    pub(crate) const SAMPLE: Budget = Budget { left: 20_000_000 };
}

impl Default for Budget {
    fn default() -> Budget {
        Budget::ASKED
    }
}

/// Why a run ended before its time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum End {
    /// `setup` or `controller` threw: on the page the lab is frozen there.
    Threw,
    /// The budget was spent.
    Budget {
        /// Simulated time of the last complete step, s.
        time: f64,
    },
    /// Somebody pressed Ctrl-C. What a check says of such a run is not used.
    Interrupted,
    /// The programs were compiled for another model: nothing was run.
    Foreign,
}
