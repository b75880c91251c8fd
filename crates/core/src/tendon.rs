//! Tendons: lengths and Jacobians of paths over joints, sites, pulleys and wrapping geoms.

use crate::{Data, Model};

/// `ten_length`, `ten_J` and the points of the paths.
pub(crate) fn tendons(_m: &Model, _d: &mut Data) {}

/// Adds a Jᵀ J to M for tendons with armature a.
pub(crate) fn armature(_m: &Model, _d: &mut Data) {}

/// `ten_velocity` = J v.
pub(crate) fn velocities(_m: &Model, _d: &mut Data) {}

/// Adds a Jᵀ (J̇ v) to `qfrc_bias` for tendons with armature a.
pub(crate) fn bias(_m: &Model, _d: &mut Data) {}
