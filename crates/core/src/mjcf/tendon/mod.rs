//! Tendons: reading, and writing to the model.

pub(crate) mod fill_tendon;
pub(crate) mod read_tendon;
