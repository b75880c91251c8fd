//! Actuators: shortcuts, reading, checks, and writing to the model.

pub(crate) mod check_actuator;
pub(crate) mod fill_actuator;
pub(crate) mod overlay;
pub(crate) mod read_actuator;
pub(crate) mod shortcut;
pub(crate) mod shortcut_motor;
