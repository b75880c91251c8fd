//! Faults that a student can provoke: runs with every control at its ends, in corners and in turn, and the faults of these
//! runs, which the monitors of `labspec-monitors` detect. `check` makes as many of these runs as its budget allows. The crate `labspec-numerics` makes all of them and
//! longer ones, tests remedies, and searches for the distance of a lab from its faults.
//!
//! From low to high; each module uses only those before it:
//!
//! * `interaction`: what a student can do, and the list of tested interactions
//! * `fault_groups`: faults in several settings, and the rules that report them
//! * `run_faults`, `case`, `drift`: a run under an interaction, and its faults
//! * `messages`: the messages for authors, and shorter timesteps that help
//! * `compared`: the runs of a lab that compares integrators

mod case;
mod compared;
mod drift;
mod fault_groups;
mod interaction;
mod messages;
mod run_faults;

pub use case::{Change, RunOutcome, StressCase};
pub use compared::{ComparedRun, ComparisonRow, compared_runs, comparison_rows, join_runs};
pub use drift::without_pushed_bodies;
pub use fault_groups::{FaultGroup, add_fault, worst_fault};
pub use interaction::{Action, Interaction, InteractionKind, list_interactions, window};
pub use labspec_monitors::stress::{Fault, FaultEvidence, FaultKind, body_name, body_of};
pub use messages::watched_run;
pub(crate) use messages::{describe, with_tried_end, with_tried_timestep};
