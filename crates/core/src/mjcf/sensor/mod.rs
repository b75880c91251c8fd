//! Sensors: reading.

pub(crate) mod read_sensor;
