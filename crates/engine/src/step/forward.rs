//! The forward pass (`mj_forward`) and its parts: the stages that the plan keeps, in their order.

use super::sequence::{INPUTS, POSITIONS, VELOCITIES};
use super::{calls, sleep};
use crate::model::plan::PlanFlag;
use crate::model::stage::Stage;
use crate::model::{Fields, Model};
use crate::step::workspace::Scratch;

/// Computes everything that follows from the state, without advancing time (`mj_forward`).
pub fn forward(m: &Model, d: &mut Fields, s: &mut Scratch) {
    from_state(m, d, s);
    from_inputs(m, d, s);
}

/// The same without what sensors show, for states between those that anybody sees. The energy is that of the last one, in
/// MuJoCo as here.
pub(crate) fn forward_unseen(m: &Model, d: &mut Fields, s: &mut Scratch) {
    s.unseen = true;
    forward(m, d, s);
    s.unseen = false;
}

/// What follows from positions and velocities, with the sensors and the energy that they determine.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn from_state(m: &Model, d: &mut Fields, s: &mut Scratch) {
    let half = d.meter.half;
    d.meter.add(half);
    position(m, d, s);
    velocity(m, d, s);
}

/// What depends on `qpos` alone.
pub fn position(m: &Model, d: &mut Fields, s: &mut Scratch) {
    let [bits, ..] = d.plan.passes[usize::from(s.unseen)];
    POSITIONS.run(m, d, s, bits);
}

/// The contacts of geoms where they are.
pub fn contacts(m: &Model, d: &mut Fields, s: &mut Scratch) {
    let [bits, ..] = d.plan.passes[0];
    POSITIONS.run(m, d, s, bits & POSITIONS.stage_bits(Stage::Collision));
}

/// What depends on `qvel` as well.
pub fn velocity(m: &Model, d: &mut Fields, s: &mut Scratch) {
    let [_, bits, _] = d.plan.passes[usize::from(s.unseen)];
    VELOCITIES.run(m, d, s, bits);
}

/// What follows from inputs as well: forces, accelerations and the other sensors.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(super) fn from_inputs(m: &Model, d: &mut Fields, s: &mut Scratch) {
    let half = d.meter.half;
    d.meter.add(half);
    let [.., bits] = d.plan.passes[usize::from(s.unseen)];
    INPUTS.run(m, d, s, bits);
    sleep::passed(&mut s.sleep);
}

/// The same, and what follows from velocities.
pub(crate) fn from_velocities(m: &Model, d: &mut Fields, s: &mut Scratch) {
    velocity(m, d, s);
    from_inputs(m, d, s);
}

/// Where things are and M, without what touches: what energies follow from.
pub(crate) fn placed(m: &Model, d: &mut Fields, s: &mut Scratch) {
    let [bits, ..] = d.plan.passes[0];
    POSITIONS.run(m, d, s, bits & POSITIONS.before(Stage::MassMatrix));
    calls::fill_mass_matrix(m, d, s, d.plan.has(PlanFlag::Composite), true);
}
