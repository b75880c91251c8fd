//! The forward pass (`mj_forward`) and its parts. Runs the stages that the plan keeps, in their order.

use super::sequence::{BEFORE_MASS, COLLISION, FOR_LENGTHS, INPUTS, POSITIONS, VELOCITIES};
use super::{calls, sleep};
use crate::dynamics::com;
use crate::model::plan::PlanFlag;
use crate::model::{Fields, Model};
use crate::step::workspace::StepScratch;

/// Computes all results for the current state, without advancing time (`mj_forward`).
pub fn forward(m: &Model, d: &mut Fields, s: &mut StepScratch) {
    from_state(m, d, s);
    from_inputs(m, d, s);
}

/// Like [`forward`], without the stages that only sensors need, for intermediate states within a step. `energy` is then that of
/// the last evaluation, as in MuJoCo.
pub(crate) fn forward_unseen(m: &Model, d: &mut Fields, s: &mut StepScratch) {
    s.unseen = true;
    forward(m, d, s);
    s.unseen = false;
}

/// Computes the results that depend on positions and velocities, including sensors and energy.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn from_state(m: &Model, d: &mut Fields, s: &mut StepScratch) {
    let half = d.meter.half;
    d.meter.add(half);
    position(m, d, s);
    velocity(m, d, s);
}

/// Computes the results that depend on `qpos` alone.
pub fn position(m: &Model, d: &mut Fields, s: &mut StepScratch) {
    let [bits, ..] = d.plan.passes[usize::from(s.unseen)];
    POSITIONS.run(m, d, s, bits);
}

/// Computes the contacts of the geoms at their current poses.
pub fn contacts(m: &Model, d: &mut Fields, s: &mut StepScratch) {
    let [bits, ..] = d.plan.passes[0];
    POSITIONS.run(m, d, s, bits & COLLISION);
}

/// Computes the results that depend on `qvel` as well.
pub fn velocity(m: &Model, d: &mut Fields, s: &mut StepScratch) {
    let [_, bits, _] = d.plan.passes[usize::from(s.unseen)];
    VELOCITIES.run(m, d, s, bits);
}

/// Computes the results that depend on inputs as well: forces, accelerations and the other sensors.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(super) fn from_inputs(m: &Model, d: &mut Fields, s: &mut StepScratch) {
    let half = d.meter.half;
    d.meter.add(half);
    let [.., bits] = d.plan.passes[usize::from(s.unseen)];
    INPUTS.run(m, d, s, bits);
    sleep::passed(&mut s.sleep);
}

/// Like [`from_inputs`], and the results that depend on velocities.
pub(crate) fn from_velocities(m: &Model, d: &mut Fields, s: &mut StepScratch) {
    velocity(m, d, s);
    from_inputs(m, d, s);
}

/// Computes poses of bodies and lengths of tendons. Inertias and motion axes are computed only where lengths need them.
pub(crate) fn update_positions(m: &Model, d: &mut Fields, s: &mut StepScratch) {
    let [bits, ..] = d.plan.passes[0];
    let lengths = if m.ntendon + m.nactuator > 0 { FOR_LENGTHS } else { 0 };
    POSITIONS.run(m, d, s, bits & BEFORE_MASS & (!FOR_LENGTHS | lengths));
}

/// Computes spatial inertias and M for these poses.
pub fn mass_matrix(m: &Model, d: &mut Fields, s: &mut StepScratch) {
    com::com_pos(m, d);
    calls::fill_mass_matrix(m, d, s, d.plan.has(PlanFlag::Composite), true);
}
