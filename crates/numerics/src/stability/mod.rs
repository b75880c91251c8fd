//! How far a lab is from its faults: all possible runs of a student, remedies, and stability margins. What a student can do,
//! and the faults of one run, are in [`labspec::stress`].
//!
//! From low to high; each module uses only those before it:
//!
//! * `truth`, `remedy`: remedies and their errors
//! * `search`, `margins`, `sensitivity`, `map`: the distance of a lab from its faults
//! * `probe`: all runs of a lab, and the report

mod map;
mod margins;
mod probe;
mod remedy;
mod search;
mod sensitivity;
mod truth;

pub use map::{MapCell, StabilityMap};
pub use margins::{Margin, ParameterKind};
pub use probe::{RunCount, StabilityFinding, StressOptions, StressReport, StressRun, probe};
pub use remedy::Remedy;
pub use sensitivity::{DivergenceOfStarts, Exponent, Horizon, Sensitivity};
