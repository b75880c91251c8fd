//! Tendons: reading and filling.

pub(crate) mod fill_tendon;
pub(crate) mod read_tendon;
