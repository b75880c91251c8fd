//! The state that the program of a control sets, and whether it resets the simulation.

use crate::bind::{Bound, functions};
use labspec_core::Model;
use labspec_core::reflect::{FieldId, Kind, Object, data};

/// The first state or input field of the data that a program sets, of those that a reset restores.
pub(crate) fn sets(bound: &Bound, model: &Model) -> Option<FieldId> {
    let set_const = bound.program.effects().calls.iter().any(|&f| functions::name(f) == Some("mj_setConst"));
    let writes = bound.program.own_writes();
    let mut set = writes.iter().filter(|w| {
        let Some(field) = FieldId::new(w.field.0 as usize) else { return false };
        let info = field.info();
        // A program that calls mj_setConst restores the previous qpos; this is not a choice of the student.
        let put_back =
            set_const && field == data::qpos && w.first == 0 && w.count.is_none_or(|n| n == model.nq);
        info.object == Object::Data && matches!(info.kind, Kind::State | Kind::Input) && !put_back
    });
    set.next().and_then(|w| FieldId::new(w.field.0 as usize))
}

/// Whether a program resets the simulation itself, so that the state that it sets is the intended start.
pub(crate) fn resets(bound: &Bound) -> bool {
    let reset = |name| matches!(name, "mj_resetData" | "mj_resetDataKeyframe" | "reset");
    bound.program.effects().calls.iter().any(|&f| functions::name(f).is_some_and(reset))
}
