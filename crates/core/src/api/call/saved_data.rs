//! Simulations as bytes.

use super::{Data, Error, Model, Scope};
pub use crate::step::save::RestoreError;

/// The complete simulation as bytes, for [`restore`].
pub fn save<S: Scope>(m: &Model, d: &Data<S>) -> Result<Vec<u8>, Error> {
    d.belongs_to(m)?;
    Ok(crate::step::save::save(m, &d.fields))
}

/// Restores a saved simulation of the same model, bit for bit. The plan of the data stays. The parameters of the model are not
/// saved: the run continues with their current values.
pub fn restore<S: Scope>(m: &Model, d: &mut Data<S>, bytes: &[u8]) -> Result<(), Error> {
    let (d, s) = d.engine_to_write(m)?;
    Ok(crate::step::save::restore(m, d, s, bytes)?)
}
