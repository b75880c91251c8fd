//! Work-precision comparison: the error of each integrator and timestep, and its cost.
//!
//! The truth is the closed form that the author gives (`exact` in the lab's `verify`), otherwise the solution on which two
//! families of methods agree (`reference.rs`). Reporting error against cost instead of timestep is the method of Hairer,
//! Nørsett and Wanner 1993, *Solving Ordinary Differential Equations I*, section II.10.

mod advice;
mod agreement;
mod beside;
mod case;
mod chebyshev;
mod compare;
mod conserved;
mod event_finder;
mod event_time;
mod events;
mod extrapolation;
mod integrator_work;
mod judge;
mod jumps;
mod ladder;
mod numbers;
mod orders;
mod reference;
mod report;
mod run_cost;
mod run_record;
mod setting;
mod step_replay;

pub use beside::{Beside, BesideRow, OtherRecording};
pub use case::OmittedNumber;
pub use compare::compare;
pub use events::{Event, NearbyStarts};
pub use judge::{Compared, Errors};
pub use numbers::milliseconds;
pub use report::{Advice, AdviceKind, PrecisionOptions, PrecisionResults, PrecisionRow};
pub use run_cost::RunCost;
pub use run_record::RunStatus;
pub use setting::{Setting, SolverVariation, VariedSetting};
