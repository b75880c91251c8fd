//! Advice to authors: what of a model is too stiff for its timestep, and runs that go wrong without a word: each way of that in a
//! file of its own, and all of them in `watch`.

pub mod growth;
pub mod limits;
pub mod stability;
pub mod sunk;
pub mod through;
pub mod unsolved;
pub mod watch;
