//! The time of an event of a run.

/// When something happens in a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct EventTime {
    /// The time, s; NaN where it does not happen.
    pub(super) at: f64,
    /// How far the search may be off, s.
    pub(super) doubt: f64,
    /// How fast the number passes, in its unit per s; infinite where another number does not move the time.
    pub(super) slope: f64,
    /// Whether a turning point is a maximum.
    pub(super) top: bool,
}

impl EventTime {
    pub(super) const NONE: EventTime =
        EventTime { at: f64::NAN, doubt: f64::NAN, slope: f64::INFINITY, top: false };
}
