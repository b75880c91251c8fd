//! Transmissions: lengths and moment arms of actuators.

use crate::{Data, Model};

/// `actuator_length`, `actuator_moment`.
pub(crate) fn transmissions(_m: &Model, _d: &mut Data) {}

/// `actuator_velocity` = moment v.
pub(crate) fn velocities(_m: &Model, _d: &mut Data) {}
