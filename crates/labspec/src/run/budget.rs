//! The work budget of a run, and the reasons for which it ends early.

/// Work, in units of about a nanosecond on a fast machine. It is counted, not measured, so the same run ends at the same
/// step on every machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Budget {
    /// The remaining work.
    pub left: u64,
}

impl Budget {
    /// For a run that a user requests.
    pub const ASKED: Budget = Budget { left: 100_000_000_000 };
    /// For a run of a check that detects breakdowns.
    pub const TRIAL: Budget = Budget { left: 1_000_000_000 };
    /// For all such runs of a file.
    pub const FILE: Budget = Budget { left: 3_000_000_000 };
    /// For one of the many runs of a comparison.
    pub const COMPARED: Budget = Budget { left: 2_000_000_000 };
    /// For a trace, a readout or a measure at one sample: a page evaluates it in every frame.
    pub(crate) const SAMPLE: Budget = Budget { left: 20_000_000 };
}

impl Default for Budget {
    fn default() -> Budget {
        Budget::ASKED
    }
}

/// The error that ended a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum End {
    /// `setup` or `controller` threw. The page freezes the lab at this time.
    Threw,
    /// The budget ran out.
    Budget {
        /// Simulated time of the last complete step, s.
        time: f64,
    },
    /// The user pressed Ctrl-C. The results of such a run are discarded.
    Interrupted,
    /// The programs were compiled for another model; nothing was run.
    Foreign,
}
