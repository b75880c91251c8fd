//! Monitors of runs that test a lab: bodies that tunnel or penetrate deeply, contacts that switch, creep, and motion that
//! exceeds every bound. A fault has the numbers that show it.
//!
//! From low to high; each module uses only those before it:
//!
//! * `fault`: the faults, with their evidence
//! * `bodies`, `causes`, `history`: geoms and names of a model, stiffness, the history of a run
//! * `height_field`, `creep`, `runaway`, `watch`: monitors of a run

mod bodies;
mod causes;
mod creep;
mod fault;
mod height_field;
mod history;
mod runaway;
mod watch;

pub use bodies::{body_name, body_of, geom_label, geom_name, joint_of_dof, joint_of_place, pairs};
pub use causes::{stiffness_cause, unknown_cause};
pub use fault::{Fault, FaultEvidence, FaultKind};
pub use watch::{MOST_PAIRS, RunMonitor};
