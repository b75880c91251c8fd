//! Actuation: forces from controls, activations, lengths and velocities.

use crate::{Data, Model};

/// `actuator_force`, `act_dot`, `qfrc_actuator`.
pub(crate) fn actuation(_m: &Model, _d: &mut Data) {}
