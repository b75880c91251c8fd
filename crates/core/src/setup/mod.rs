//! What a model computes of itself at its default configuration (`mj_setConst`, `mj_setLengthRange`).

pub(crate) mod lengthrange;
mod needs;
pub(crate) mod setconst;

pub(crate) use needs::search;
