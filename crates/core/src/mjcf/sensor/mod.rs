//! Reading of sensors.

pub(crate) mod read_sensor;
