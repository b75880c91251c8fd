//! Numerics for authors: the error of a lab against its run time (`precision`), which stages of the engine it needs and what each
//! costs (`profile`), and how far it is from its faults (`stability`).

pub mod precision;
pub mod profile;
pub mod stability;
