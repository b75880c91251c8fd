//! Simulations as bytes.

use super::{Data, Error, Model, Scope};
pub use crate::step::save::RestoreError;

/// All of a simulation as bytes, for [`restore`].
pub fn save<S: Scope>(m: &Model, d: &Data<S>) -> Result<Vec<u8>, Error> {
    d.belongs_to(m)?;
    Ok(crate::step::save::save(m, &d.fields))
}

/// Brings a simulation of the same model back to where it was saved, every bit of it; its plan stays. Parameters of the
/// model are not part of it: a run goes on with those that the model has now.
pub fn restore<S: Scope>(m: &Model, d: &mut Data<S>, bytes: &[u8]) -> Result<(), Error> {
    let (d, s) = d.engine_to_write(m)?;
    Ok(crate::step::save::restore(m, d, s, bytes)?)
}
