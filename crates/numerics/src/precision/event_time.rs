//! The time of an event of a run.

/// The time of an event of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct EventTime {
    /// The time, s; NaN if the event does not happen.
    pub(super) time: f64,
    /// The error of the search, s.
    pub(super) uncertainty: f64,
    /// The rate of change of the number at the event, in its unit per s; infinite if an error of the number
    /// does not shift the time.
    pub(super) slope: f64,
    /// Whether a turning point is a maximum.
    pub(super) top: bool,
}

impl EventTime {
    pub(super) const NONE: EventTime =
        EventTime { time: f64::NAN, uncertainty: f64::NAN, slope: f64::INFINITY, top: false };
}
