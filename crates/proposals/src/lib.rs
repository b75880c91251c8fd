//! Proposals for authors. Each is a guess until an author accepts it and a check verifies it.

pub mod scaffold;
pub mod trace;
