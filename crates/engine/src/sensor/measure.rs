//! Sensors that read a number that other stages compute: of joints, tendons, actuators, limits and subtrees, and of
//! the whole scene.

use super::put;
use crate::constraint;
use crate::forces::energy;
use crate::kinds::trntype;
use crate::math::*;
use crate::model::index::object_index;
use crate::model::{Fields, Model};

/// The sensed object of sensor `s`.
fn object(m: &Model, s: usize) -> usize {
    object_index(m.sensor_objid[s])
}

/// A sensor without a measurement. Its values are zero.
pub(super) fn no_measurement(_: &Model, _: &mut Fields, _: usize, out: &mut [f64]) {
    out.fill(0.0);
}

pub(super) fn clock(_: &Model, d: &mut Fields, _: usize, out: &mut [f64]) {
    put(out, [d.time]);
}

/// The potential energy. It is computed, and written to `energy`, whether the energy flag is set or not.
pub(super) fn potential_energy(m: &Model, d: &mut Fields, _: usize, out: &mut [f64]) {
    energy::potential(m, d);
    put(out, [d.energy[0]]);
}

pub(super) fn kinetic_energy(m: &Model, d: &mut Fields, _: usize, out: &mut [f64]) {
    energy::kinetic(m, d);
    put(out, [d.energy[1]]);
}

pub(super) fn joint_position(m: &Model, d: &mut Fields, s: usize, out: &mut [f64]) {
    put(out, [d.qpos[m.jnt_qposadr[object(m, s)] as usize]]);
}

pub(super) fn joint_velocity(m: &Model, d: &mut Fields, s: usize, out: &mut [f64]) {
    put(out, [d.qvel[m.jnt_dofadr[object(m, s)] as usize]]);
}

pub(super) fn joint_actuator_force(m: &Model, d: &mut Fields, s: usize, out: &mut [f64]) {
    put(out, [d.qfrc_actuator[m.jnt_dofadr[object(m, s)] as usize]]);
}

pub(super) fn ball_orientation(m: &Model, d: &mut Fields, s: usize, out: &mut [f64]) {
    if let Some(&q) = d.qpos[m.jnt_qposadr[object(m, s)] as usize..].first_chunk::<4>() {
        put(out, quat_normalize(q));
    }
}

pub(super) fn ball_velocity(m: &Model, d: &mut Fields, s: usize, out: &mut [f64]) {
    if let Some(&w) = d.qvel[m.jnt_dofadr[object(m, s)] as usize..].first_chunk::<3>() {
        put(out, w);
    }
}

pub(super) fn tendon_length(m: &Model, d: &mut Fields, s: usize, out: &mut [f64]) {
    put(out, [d.ten_length[object(m, s)]]);
}

pub(super) fn tendon_velocity(m: &Model, d: &mut Fields, s: usize, out: &mut [f64]) {
    put(out, [d.ten_velocity[object(m, s)]]);
}

/// The sum of the forces of all actuators on the tendon.
pub(super) fn tendon_actuator_force(m: &Model, d: &mut Fields, s: usize, out: &mut [f64]) {
    let pulls =
        |&i: &usize| m.actuator_trntype[i] == trntype::TENDON && m.actuator_trnid[2 * i] == m.sensor_objid[s];
    put(out, [(0..m.nactuator).filter(pulls).map(|i| d.actuator_force[m.actuator_outadr[i] as usize]).sum()]);
}

pub(super) fn actuator_length(m: &Model, d: &mut Fields, s: usize, out: &mut [f64]) {
    outputs(m, s, &d.actuator_length, out);
}

pub(super) fn actuator_velocity(m: &Model, d: &mut Fields, s: usize, out: &mut [f64]) {
    outputs(m, s, &d.actuator_velocity, out);
}

pub(super) fn actuator_force(m: &Model, d: &mut Fields, s: usize, out: &mut [f64]) {
    outputs(m, s, &d.actuator_force, out);
}

/// The values of all outputs of the sensed actuator.
fn outputs(m: &Model, s: usize, values: &[f64], out: &mut [f64]) {
    let first = m.actuator_outadr[object(m, s)] as usize;
    out.copy_from_slice(&values[first..first + out.len()]);
}

/// The first row of the limit of a joint or tendon; `None` if the limit is not active.
fn limit(m: &Model, d: &Fields, s: usize, kind: i32) -> Option<usize> {
    (0..d.nefc).find(|&row| d.efc_type[row] == kind && d.efc_id[row] == m.sensor_objid[s])
}

macro_rules! limits {
    ($($joint:ident $tendon:ident = |$d:ident, $row:ident| $value:expr;)*) => { $(
        pub(super) fn $joint(m: &Model, $d: &mut Fields, s: usize, out: &mut [f64]) {
            put(out, [limit(m, $d, s, constraint::kind::LIMIT_JOINT).map_or(0.0, |$row| $value)]);
        }
        pub(super) fn $tendon(m: &Model, $d: &mut Fields, s: usize, out: &mut [f64]) {
            put(out, [limit(m, $d, s, constraint::kind::LIMIT_TENDON).map_or(0.0, |$row| $value)]);
        }
    )* };
}
limits! {
    joint_limit_distance tendon_limit_distance = |d, row| d.efc_pos[row] - d.efc_margin[row];
    joint_limit_velocity tendon_limit_velocity = |d, row| d.efc_vel[row];
    joint_limit_force tendon_limit_force = |d, row| d.efc_force[row];
}

pub(super) fn subtree_com(m: &Model, d: &mut Fields, s: usize, out: &mut [f64]) {
    put(out, rows::<3>(&d.subtree_com)[object(m, s)]);
}

pub(super) fn subtree_velocity(m: &Model, d: &mut Fields, s: usize, out: &mut [f64]) {
    put(out, rows::<3>(&d.subtree_linvel)[object(m, s)]);
}

pub(super) fn subtree_angular_momentum(m: &Model, d: &mut Fields, s: usize, out: &mut [f64]) {
    put(out, rows::<3>(&d.subtree_angmom)[object(m, s)]);
}
