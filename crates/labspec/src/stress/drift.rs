//! Drift that the softness of friction causes: bodies that creep as fast where friction is hard are pushed along and have no fault.

use super::case::StressCase;
use super::fault::{Fault, FaultKind};
use super::interaction::Interaction;
use crate::run::Session;
use labspec_core::math::rows_mut;

/// The faults of a run, without the drift of bodies that are pushed along; and the work of the run with hard friction that decides
/// it.
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
    let firm = case.run(interaction, Some(&firmer), length, budget);
    let moves = |f: &Fault| firm.speeds.iter().any(|(who, speed)| *who == f.who && 2.0 * speed > f.size);
    // Without the other run to its end the drift is not proven.
    faults.retain(|f| f.kind != FaultKind::Drifts || !firm.cut && !moves(f));
    (faults, firm.spent)
}

/// Friction a hundred times as hard.
fn firmer(session: &mut Session<'_>) {
    let model = session.world.model.edit();
    *model.opt.impratio *= 100.0;
    *model.opt.cone = 1;
    for solimp in rows_mut::<5>(model.dof_solimp) {
        harden(solimp);
    }
}

/// An impedance that gives way a hundred times less.
fn harden(solimp: &mut [f64; 5]) {
    let most = solimp[1];
    solimp[..2].fill(1.0 - 0.01 * (1.0 - most));
}
