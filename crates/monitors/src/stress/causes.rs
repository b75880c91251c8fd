//! The cause of a fault as far as the model shows it: a spring, a servo or a contact that is too stiff for the timestep.

use crate::stability::{self, how_stiff, owner};
use labspec_core::Model;
use labspec_finding::two_digits;

/// Describes the part of the model that is too stiff for its timestep.
pub fn stiffness_cause(m: &Model) -> Option<String> {
    let worst = stability::unstable_parts(m).into_iter().next()?;
    Some(format!(
        "{} is {} for a step of {} s: the largest step that works is {} s",
        owner(m, &worst),
        how_stiff(&worst),
        m.opt.timestep,
        two_digits(worst.timestep)
    ))
}

/// The description if no single part is too stiff.
pub fn unknown_cause(m: &Model) -> String {
    format!(
        "no single spring, servo or contact is too stiff for a step of {} s; several together may be",
        m.opt.timestep
    )
}
