//! What is known of the units of the measures.

use labspec_expr::KnownDimensions;
use labspec_expr::dimension::Measure;

/// What the measures of each run measure, by the place of the run.
pub(super) type RunUnits = Vec<Vec<(String, Measure)>>;

/// What is known of the numbers that claims read.
#[derive(Debug)]
pub(super) struct MeasureUnits {
    /// What the controls of the lab give.
    pub(super) given: KnownDimensions,
    pub(super) runs: RunUnits,
}
