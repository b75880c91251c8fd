//! A step: the stages in their order, which of them a scene needs, and what follows from the accelerations.

pub(crate) mod forward;
pub(crate) mod integrate;
pub(crate) mod inverse;
pub mod plan;
pub(crate) mod reset;
pub mod save;
pub(crate) mod sleep;
