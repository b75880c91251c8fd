//! Proposals for authors. Each is a guess until an author accepts it and a check proves it.

pub mod scaffold;
pub mod trace;
