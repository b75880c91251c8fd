//! A run that is monitored for silent faults, and which runs can be monitored.

use crate::bind::{Bound, Programs, World};
use labspec_core::reflect::{FieldId, Kind, data, option};
use labspec_expr::FieldKey;
use labspec_monitors::watch::{self, Monitors};

/// Fields that a program may write in every step without setting positions: forces and controls.
const FORCE_FIELDS: [FieldId; 3] = [data::ctrl, data::qfrc_applied, data::xfrc_applied];

/// Whether a field is one of `FORCE_FIELDS`.
fn is_force_field(field: FieldKey) -> bool {
    FieldId::new(field.0 as usize).is_some_and(|f| FORCE_FIELDS.contains(&f))
}

/// Whether a field is derived, or only enables computations: writing it moves nothing.
fn follows(field: FieldKey) -> bool {
    FieldId::new(field.0 as usize).is_some_and(|f| f.info().kind == Kind::Derived || f == option::enableflags)
}

/// Whether a program may set positions or velocities, or change the model.
fn moves(bound: &Bound) -> bool {
    let effects = bound.program.effects();
    let still = |field: FieldKey| is_force_field(field) || follows(field);
    effects.writes_everything || effects.calls_values || !effects.writes.iter().all(|a| still(a.field))
}

/// A run that is monitored for silent faults.
#[derive(Clone, Debug)]
pub(super) struct MonitoredRun {
    pub(super) watch: Monitors,
    /// Whether the state or the model was changed from outside since the last step.
    pub(super) disturbed: bool,
}

impl MonitoredRun {
    /// Starts monitoring a run; `None` where a program sets positions, velocities or the model.
    pub(super) fn begin(programs: &Programs, world: &World) -> Option<MonitoredRun> {
        let probes = programs.probes.iter().filter_map(|p| p.bound.as_ref());
        let running: Vec<&Bound> = probes.chain(&programs.controller).collect();
        if running.iter().any(|bound| moves(bound)) {
            return None;
        }
        let pushed = running
            .iter()
            .any(|bound| bound.program.effects().writes.iter().any(|a| is_force_field(a.field)));
        let watch = watch::watch(&world.model, &world.data, pushed);
        Some(MonitoredRun { watch, disturbed: false })
    }
}
