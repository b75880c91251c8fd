//! The forward pass (`mj_forward`) and its parts: the stages that the plan keeps, in their order.

use super::pipeline::{INPUTS, POSITIONS, VELOCITIES};
use super::{calls, sleep};
use crate::model::Model;
use crate::model::plan::PlanFlag;
use crate::model::stage::Stage;
use crate::step::workspace::Workspace;

/// Computes everything that follows from the state, without advancing time (`mj_forward`).
pub(crate) fn forward(m: &Model, d: &mut Workspace) {
    from_state(m, d);
    from_inputs(m, d);
}

/// The same without what sensors show, for states between those that anybody sees. The energy is that of the last one, in
/// MuJoCo as here.
pub(crate) fn forward_unseen(m: &Model, d: &mut Workspace) {
    d.work.unseen = true;
    forward(m, d);
    d.work.unseen = false;
}

/// What follows from positions and velocities, with the sensors and the energy that they determine.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn from_state(m: &Model, d: &mut Workspace) {
    let half = d.meter.half;
    d.meter.add(half);
    position(m, d);
    velocity(m, d);
}

/// What depends on `qpos` alone.
pub(crate) fn position(m: &Model, d: &mut Workspace) {
    let [bits, ..] = d.plan.passes[usize::from(d.work.unseen)];
    POSITIONS.run(m, d, bits);
}

/// The contacts of geoms where they are.
pub(crate) fn contacts(m: &Model, d: &mut Workspace) {
    let [bits, ..] = d.plan.passes[0];
    POSITIONS.run(m, d, bits & POSITIONS.stage_bits(Stage::Collision));
}

/// What depends on `qvel` as well.
pub(crate) fn velocity(m: &Model, d: &mut Workspace) {
    let [_, bits, _] = d.plan.passes[usize::from(d.work.unseen)];
    VELOCITIES.run(m, d, bits);
}

/// What follows from inputs as well: forces, accelerations and the other sensors.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(super) fn from_inputs(m: &Model, d: &mut Workspace) {
    let half = d.meter.half;
    d.meter.add(half);
    let [.., bits] = d.plan.passes[usize::from(d.work.unseen)];
    INPUTS.run(m, d, bits);
    sleep::passed(&mut d.work.sleep);
}

/// The same, and what follows from velocities.
pub(crate) fn from_velocities(m: &Model, d: &mut Workspace) {
    velocity(m, d);
    from_inputs(m, d);
}

/// Where things are and M, without what touches: what energies follow from.
pub(crate) fn placed(m: &Model, d: &mut Workspace) {
    let [bits, ..] = d.plan.passes[0];
    POSITIONS.run(m, d, bits & POSITIONS.before(Stage::MassMatrix));
    calls::fill_mass_matrix(m, d, d.plan.has(PlanFlag::Composite), true);
}
