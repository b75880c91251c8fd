//! The cause of a fault as far as the model shows it: a spring, a servo or a contact that is too stiff for the timestep.

use crate::monitors::stability;
use crate::run;
use labspec_core::Model;

/// Describes the part of the model that is too stiff for its timestep.
pub(super) fn stiffness_cause(m: &Model) -> Option<String> {
    let worst = stability::unstable_parts(m).into_iter().next()?;
    Some(format!(
        "{} is {} for a step of {} s: the largest step that works is {} s",
        run::owner(m, &worst),
        run::how_stiff(&worst),
        m.opt.timestep,
        run::two_digits(worst.timestep)
    ))
}

/// The description if no single part is too stiff.
pub(super) fn unknown_cause(m: &Model) -> String {
    format!(
        "no single spring, servo or contact is too stiff for a step of {} s; several together may be",
        m.opt.timestep
    )
}
