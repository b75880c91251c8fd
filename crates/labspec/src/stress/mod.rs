//! Faults that a student can provoke: runs with every control at its ends, in corners and in turn, much longer than a student looks,
//! and everything that goes wrong in them.
//!
//! From low to high; each module uses only those before it. `check` uses the modules of the first group:
//!
//! * `interaction`: what a student can do, and the list of what is tried
//! * `fault`: what goes wrong, with its evidence
//! * `bodies`, `causes`, `memory`: geoms and names of a model, stiffness, the history of a run
//! * `ground`, `rest`, `wild`, `watch`: monitors of a run
//! * `run_faults`, `case`, `drift`: a run under an interaction, and its faults
//! * `messages`: the messages for authors, and shorter timesteps that help
//!
//! The command `stability` uses the second group as well:
//!
//! * `truth`, `remedy`: remedies and their errors
//! * `search`, `margins`, `sensitivity`, `map`: how far a lab is from its faults
//! * `probe`: all runs of a lab, and the report

mod bodies;
mod case;
mod causes;
mod drift;
mod fault;
mod ground;
mod interaction;
mod map;
mod margins;
mod memory;
mod messages;
mod probe;
mod remedy;
mod rest;
mod run_faults;
mod search;
mod sensitivity;
mod truth;
mod watch;
mod wild;

pub(crate) use case::StressCase;
pub(crate) use drift::genuine;
pub(crate) use fault::add;
pub use fault::{Evidence, Fault, FaultGroup, FaultKind, Remedy};
pub(crate) use interaction::list;
pub use interaction::{Action, Interaction, Kind, window};
pub use map::{Cell, Map};
pub use margins::{Knob, Margin};
pub use messages::watched_run;
pub(crate) use messages::{describe, with_tried_timestep};
pub use probe::{Made, Options, Report, RunCount, probe};
pub use sensitivity::{Exponent, Horizon, Parting, Sensitivity};
