//! What a model computes of itself at its default configuration (`mj_setConst`, `mj_setLengthRange`).

pub(crate) mod lengthrange;
pub(crate) mod setconst;
