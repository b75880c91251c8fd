//! What is known of a program before it runs: what it touches, in which order, and what its numbers measure.

mod effects;
pub(crate) mod measure;
mod order;

pub(crate) use effects::effects;
pub(crate) use order::WriteOrder;
