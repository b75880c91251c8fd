//! Distinguishes drift caused by soft friction: a body that moves as fast with hard friction is pushed and has no fault.

use super::case::StressCase;
use super::interaction::Interaction;
use crate::run::Session;
use labspec_core::math::rows_mut;
use labspec_monitors::stress::{Fault, FaultKind};

/// The faults of a run, without the drift of bodies that are pushed. A run with hard friction decides this; its work is
/// returned.
pub fn without_pushed_bodies(
    case: &StressCase<'_>,
    interaction: &Interaction,
    mut faults: Vec<Fault>,
    length: f64,
    budget: u64,
) -> (Vec<Fault>, u64) {
    if !faults.iter().any(|f| f.kind == FaultKind::Drifts) {
        return (faults, 0);
    }
    let firm = case.run(interaction, Some(&raise_friction), length, budget);
    let moves =
        |f: &Fault| firm.speeds.iter().any(|(subject, speed)| *subject == f.subject && 2.0 * speed > f.size);
    // Without a complete second run, the drift is not proven.
    faults.retain(|f| f.kind != FaultKind::Drifts || !firm.cut && !moves(f));
    (faults, firm.spent)
}

/// Makes friction a hundred times harder.
fn raise_friction(session: &mut Session<'_>) {
    let model = session.world.model.edit();
    *model.opt.impratio *= 100.0;
    *model.opt.cone = 1;
    for solimp in rows_mut::<5>(model.dof_solimp) {
        reduce_softness(solimp);
    }
}

/// Reduces the softness of an impedance by a factor of a hundred.
fn reduce_softness(solimp: &mut [f64; 5]) {
    let most = solimp[1];
    solimp[..2].fill(1.0 - 0.01 * (1.0 - most));
}
