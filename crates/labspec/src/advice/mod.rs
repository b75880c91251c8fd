//! Advice to authors: what of a model is too stiff for its timestep, and runs that gain energy which nothing gave them.

pub mod growth;
pub mod stability;
