//! Advice to authors: parts of a model that are too stiff for its timestep, and runs that fail silently. Each failure has
//! its own file; `watch` combines them.

pub mod growth;
pub mod limits;
pub mod stability;
pub mod sunk;
pub mod through;
pub mod unsolved;
pub mod watch;
