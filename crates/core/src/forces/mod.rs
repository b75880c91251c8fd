//! Forces that do not come of constraints: of springs, dampers, media and actuators, with what carries them.
//!
//! `tendon` and `transmission` say over which lever a force acts, `passive` and `actuation` how large it is, `derivative`
//! how it changes with the velocity, `energy` what is stored in it. `history` keeps what delays look back to.

pub(crate) mod actuation;
pub(crate) mod derivative;
pub(crate) mod energy;
pub(crate) mod history;
pub(crate) mod passive;
pub(crate) mod tendon;
pub(crate) mod transmission;
