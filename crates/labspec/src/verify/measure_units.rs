//! The dimensions of the measures.

use labspec_expr::KnownDimensions;
use labspec_expr::dimension::Measure;

/// The dimensions of the measures of each run, indexed by run.
pub(super) type RunUnits = Vec<Vec<(String, Measure)>>;

/// The known dimensions of the numbers that claims read.
#[derive(Debug)]
pub(super) struct MeasureUnits {
    /// The dimensions that follow from the controls of the lab.
    pub(super) given: KnownDimensions,
    pub(super) runs: RunUnits,
}
