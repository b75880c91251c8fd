//! The engine as embedders hold it: models and data that belong together, objects by name, errors instead of panics.

pub(crate) mod addresses;
pub(crate) mod call;
pub(crate) mod data;
pub(crate) mod error;
pub(crate) mod model;
pub(crate) mod plan;
pub(crate) mod view;

#[cfg(feature = "mjcf")]
pub mod reading;
