//! States as lists of numbers.

use super::{Data, Error, Model, Scope};
use crate::model::state;
pub use crate::model::state::{
    ACT, CTRL, EQ_ACTIVE, FULLPHYSICS, HISTORY, INTEGRATION, MOCAP_POS, MOCAP_QUAT, PHYSICS, QFRC_APPLIED,
    QPOS, QVEL, StateError, TIME, USER, USERDATA, WARMSTART, XFRC_APPLIED,
};

/// The length of a state vector (`mj_stateSize`).
pub fn size(m: &Model, sig: i32) -> Result<usize, Error> {
    Ok(state::size(m, sig)?)
}

/// Writes a state to `out`, which has `size` numbers (`mj_getState`).
pub fn get<S: Scope>(m: &Model, d: &Data<S>, out: &mut [f64], sig: i32) -> Result<(), Error> {
    d.belongs_to(m)?;
    Ok(state::get(&d.fields, out, sig)?)
}

/// Sets a state (`mj_setState`). `forward` or the next step computes the results that depend on it.
pub fn set<S: Scope>(m: &Model, d: &mut Data<S>, values: &[f64], sig: i32) -> Result<(), Error> {
    Ok(state::set(m, d.engine_to_write(m)?.0, values, sig)?)
}

/// Copies the parts `to` from the state vector `from`, which has the parts `sig` (`mj_extractState`).
pub fn extract(m: &Model, from: &[f64], sig: i32, out: &mut [f64], to: i32) -> Result<(), Error> {
    Ok(state::extract(m, from, sig, out, to)?)
}

/// The parts that are no inputs: a plan assumes nothing about them.
const COORDINATES: i32 = TIME | QPOS | QVEL;

/// Copies parts of a state from other data (`mj_copyState`).
pub fn copy<S: Scope, T: Scope>(m: &Model, from: &Data<S>, to: &mut Data<T>, sig: i32) -> Result<(), Error> {
    from.belongs_to(m)?;
    let (to, _) = if sig & !COORDINATES == 0 { to.engine(m)? } else { to.engine_to_write(m)? };
    Ok(state::copy(m, &from.fields, to, sig)?)
}
