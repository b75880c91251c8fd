//! The discrete integrator.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Metric {}
