//! Forces that do not come of constraints: of springs, dampers, media and actuators, with what carries them.
//!
//! `tendon` and `transmission` say over which lever a force acts, `passive` and `actuation` how large it is, `derivative`
//! how it changes with the velocity, `energy` what is stored in it. `history` keeps what delays look back to.

pub mod actuation;
pub(crate) mod derivative;
pub mod energy;
pub mod history;
pub(crate) mod passive;
pub mod tendon;
pub mod transmission;

use crate::dynamics::jacobian::Columns;
use crate::model::Model;

/// What these stages use and nobody else looks at, kept so that they do not allocate.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scratch {
    /// Sums of the forces of actuators on each tendon.
    tendon_force: Vec<f64>,
    /// A row of the moments of actuators.
    moment: Vec<f64>,
    /// Columns of one contact's Jacobian.
    columns: Columns,
}

impl Scratch {
    pub(crate) fn new(m: &Model) -> Scratch {
        let contacts = m.actuator_trntype.contains(&crate::kinds::trntype::BODY);
        Scratch {
            tendon_force: vec![0.0; m.ntendon],
            moment: vec![0.0; m.nv],
            columns: Columns::with_room(if contacts { m.nv } else { 0 }),
        }
    }
}
