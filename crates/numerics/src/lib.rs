//! Numerics for authors: the error of a lab against its run time (`precision`), and which stages of the engine it needs and what each
//! costs (`profile`).

pub mod precision;
pub mod profile;
