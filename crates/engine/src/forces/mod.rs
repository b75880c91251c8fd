//! Smooth forces, which are not constraint forces: those of springs, dampers, fluids and actuators, and the transmissions of
//! these forces.
//!
//! `tendon` and `transmission` compute moment arms, `passive` and `actuation` the magnitudes of forces, `derivative`
//! their derivatives with respect to velocity, and `energy` the stored energy. `history` stores past values for delays.

pub mod actuation;
pub(crate) mod derivative;
pub mod energy;
pub mod history;
pub(crate) mod passive;
pub mod tendon;
pub mod transmission;

use crate::dynamics::jacobian::Columns;
use crate::model::Model;

/// The memory of these stages, reused so that they do not allocate.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ForceScratch {
    /// The sum of the actuator forces on each tendon.
    tendon_force: Vec<f64>,
    /// A row of the actuator moments.
    moment: Vec<f64>,
    /// Columns of one contact's Jacobian.
    columns: Columns,
}

impl ForceScratch {
    pub(crate) fn new(m: &Model) -> ForceScratch {
        let contacts = m.actuator_trntype.contains(&crate::kinds::trntype::BODY);
        ForceScratch {
            tendon_force: vec![0.0; m.ntendon],
            moment: vec![0.0; m.nv],
            columns: Columns::with_room(if contacts { m.nv } else { 0 }),
        }
    }
}
