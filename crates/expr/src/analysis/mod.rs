//! Static analyses of a program: its effects, the order of its writes and calls, and the dimensions of its numbers.

mod effects;
pub(crate) mod measure;
mod order;

pub(crate) use effects::effects;
pub(crate) use order::WriteOrder;
