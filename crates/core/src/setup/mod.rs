//! Constants that a model computes from itself in its default configuration (`mj_setConst`, `mj_setLengthRange`).

pub(crate) mod lengthrange;
mod needs;
pub(crate) mod setconst;

pub(crate) use needs::search;
