//! Faults that a student can provoke: runs with every control at its ends, in corners and in turn, much longer than a student looks,
//! and everything that goes wrong in them.
//!
//! From low to high; each module uses only those before it. `check` uses the modules of the first group:
//!
//! * `interaction`: what a student can do, and the list of what is tried
//! * `fault`: what goes wrong, with its evidence
//! * `bodies`, `causes`, `history`: geoms and names of a model, stiffness, the history of a run
//! * `height_field`, `creep`, `runaway`, `watch`: monitors of a run
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
mod creep;
mod drift;
mod fault;
mod height_field;
mod history;
mod interaction;
mod map;
mod margins;
mod messages;
mod probe;
mod remedy;
mod run_faults;
mod runaway;
mod search;
mod sensitivity;
mod truth;
mod watch;

pub(crate) use case::StressCase;
pub(crate) use drift::genuine;
pub(crate) use fault::add;
pub use fault::{Evidence, Fault, FaultGroup, FaultKind, Remedy};
pub(crate) use interaction::list;
pub use interaction::{Action, Interaction, Kind, window};
pub use map::{MapCell, StabilityMap};
pub use margins::{Knob, Margin};
pub use messages::watched_run;
pub(crate) use messages::{describe, with_tried_timestep};
pub use probe::{Options, RunCount, StressReport, StressRun, probe};
pub use sensitivity::{Exponent, Horizon, Parting, Sensitivity};
