//! Saved simulations: state, inputs and everything computed, contacts and warnings included.
//!
//! ```
//! # fn main() -> Result<(), labspec_core::Error> {
//! use labspec_core::{Data, Model, save, step};
//! let model = Model::from_xml(
//!     "<mujoco><worldbody><body><joint/><geom size='0.1' pos='0 1 0'/></body></worldbody></mujoco>",
//! )?;
//! let mut data = Data::new(&model);
//! step(&model, &mut data)?;
//! let saved = save::save(&model, &data)?;
//! let then = data.qpos.clone();
//! step(&model, &mut data)?;
//! save::restore(&model, &mut data, &saved)?;
//! assert_eq!(data.qpos, then);
//! # Ok(())
//! # }
//! ```

use super::{Data, Error, Model, Scope};
pub use crate::step::save::RestoreError;

/// All of a simulation as bytes, for [`restore`].
pub fn save<S: Scope>(m: &Model, d: &Data<S>) -> Result<Vec<u8>, Error> {
    d.belongs_to(m)?;
    Ok(crate::step::save::save(m, &d.inner))
}

/// Brings a simulation of the same model back to where it was saved, every bit of it; its plan stays. Parameters of the
/// model are not part of it: a run goes on with those that the model has now.
pub fn restore<S: Scope>(m: &Model, d: &mut Data<S>, bytes: &[u8]) -> Result<(), Error> {
    Ok(crate::step::save::restore(m, d.engine_to_write(m)?, bytes)?)
}
