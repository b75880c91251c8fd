//! Transmissions: lengths of actuators, and their moments, which are the derivatives of the lengths with respect to the degrees
//! of freedom.
//!
//! MuJoCo's documentation, "Computation: Actuation model", lists the transmissions. `gear` scales each length. Moments are
//! stored as sparse rows, one for each output.

mod actuator_constants;
mod body_contacts;
mod space;

use crate::dynamics::reflected::target;
use crate::dynamics::walk;
use crate::forces::{ForceScratch, tendon};
use crate::kinds::{disable, joint, trntype};
use crate::math::*;
use crate::model::{Fields, Model, asleep};

pub use actuator_constants::{at_default, critical_damping, reflected};

/// The moment rows during their computation. The outputs of actuators are consecutive, so that rows are written one after the
/// other.
struct MomentRows {
    colind: Vec<i32>,
    values: Vec<f64>,
    /// The index of the next entry.
    cursor: usize,
}

impl MomentRows {
    /// Appends an entry to the current row, unless it is zero.
    #[cfg_attr(not(feature = "small"), inline(always))]
    fn push(&mut self, dof: usize, value: f64) {
        if value != 0.0
            && let (Some(k), Some(x)) = (self.colind.get_mut(self.cursor), self.values.get_mut(self.cursor))
        {
            (*k, *x) = (dof as i32, value);
            self.cursor += 1;
        }
    }

    /// Reverses a row that was written from the last degree of freedom to the first.
    fn reverse_from(&mut self, start: usize) {
        self.colind[start..self.cursor].reverse();
        self.values[start..self.cursor].reverse();
    }
}

/// The entries of the moment of output `o`.
pub fn row(d: &Fields, o: usize) -> std::ops::Range<usize> {
    let start = d.moment_rowadr[o] as usize;
    start..start + d.moment_rownnz[o] as usize
}

/// The largest possible number of entries of the moments of all actuators (`nJmom`).
pub fn entries(m: &Model) -> usize {
    let site_body = |s: usize| m.site_bodyid[s] as usize;
    let entries_of_actuator = |i: usize| match (m.actuator_trntype[i], target(m, i)) {
        (trntype::JOINT | trntype::JOINTINPARENT, (j, _)) => joint::nv(m.jnt_type[j]),
        (trntype::TENDON, (t, _)) => m.ten_J_rownnz[t] as usize,
        (trntype::SITE, (s, None)) => walk::moving(m, site_body(s)).count(),
        (trntype::SITE, (s, Some(reference))) => walk::moving_one(m, [s, reference].map(site_body)).count(),
        (trntype::SLIDERCRANK, (s, Some(slider))) => {
            walk::moving_either(m, [s, slider].map(site_body)).count()
        }
        (trntype::SO3, (_, None)) => 3,
        (trntype::SO3, _) => 3 * m.nv,
        _ => m.nv,
    };
    (0..m.nactuator).map(entries_of_actuator).sum()
}

/// Computes `actuator_length`, `actuator_moment` and its pattern. A sleeping actuator keeps its lengths and has no moments.
pub fn transmissions(m: &Model, d: &mut Fields, w: &mut ForceScratch) {
    // Removed temporarily, so that the rest of the data can be read while they are written.
    let mut out = MomentRows {
        colind: std::mem::take(&mut d.moment_colind),
        values: std::mem::take(&mut d.actuator_moment),
        cursor: 0,
    };
    let outputs = m.actuator_outadr.iter().zip(&m.actuator_outnum);
    let targets = m.actuator_trntype.iter().zip(m.actuator_trnid.as_chunks().0);
    for (i, ((&first, &number), (&kind, &[target, _]))) in outputs.zip(targets).enumerate() {
        for o in first as usize..(first + number) as usize {
            let start = out.cursor;
            if !asleep::actuator(m, d, i) {
                d.actuator_length[o] = match kind {
                    trntype::JOINT | trntype::JOINTINPARENT => {
                        let gear = &rows::<6>(&m.actuator_gear)[o];
                        at_joint(m, d, target as usize, kind == trntype::JOINTINPARENT, gear, &mut out)
                    }
                    _ => beyond_joints(m, d, [i, o], w, &mut out),
                };
            }
            (d.moment_rowadr[o], d.moment_rownnz[o]) = (start as i32, (out.cursor - start) as i32);
        }
    }
    (d.moment_colind, d.actuator_moment) = (out.colind, out.values);
}

/// Computes output `o` of actuator `i` for transmissions other than to joints.
#[inline(never)] // most actuators are motors of joints
fn beyond_joints(
    m: &Model,
    d: &mut Fields,
    [i, o]: [usize; 2],
    w: &mut ForceScratch,
    out: &mut MomentRows,
) -> f64 {
    let gear = rows::<6>(&m.actuator_gear)[o];
    let nth = o - m.actuator_outadr[i] as usize;
    match (m.actuator_trntype[i], target(m, i)) {
        (trntype::TENDON, (t, _)) => along_tendon(m, d, t, gear[0], out),
        (trntype::SITE, (s, None)) => space::site(m, d, s, gear, out),
        (trntype::SITE, (s, Some(reference))) => {
            space::pose_in_reference_frame(m, d, [s, reference], gear, out)
        }
        (trntype::SLIDERCRANK, (s, Some(slider))) => {
            space::crank(m, d, [s, slider], m.actuator_cranklength[i], gear[0], out)
        }
        (trntype::SO3, (j, None)) => {
            out.push(m.jnt_dofadr[j] as usize + nth, 1.0);
            joint_rotation(d, m.jnt_qposadr[j] as usize)[nth]
        }
        (trntype::SO3, (s, Some(reference))) => space::orientation(m, d, [s, reference], nth, out),
        (trntype::BODY, (b, _)) => body_contacts::adhesion(m, d, b, w, out),
        _ => 0.0,
    }
}

/// Rotation vector of the quaternion at index `q` of qpos.
fn joint_rotation(d: &Fields, q: usize) -> Vec3 {
    quat_to_vel(quaternion(d, q))
}

/// The quaternion at index `q` of qpos, normalized.
fn quaternion(d: &Fields, q: usize) -> Quat {
    quat_normalize([d.qpos[q], d.qpos[q + 1], d.qpos[q + 2], d.qpos[q + 3]])
}

/// The length is the coordinate of a slide or hinge, the rotation along an axis for a ball joint, and zero for a free joint, on
/// which only a force acts. A gear in the parent's frame is rotated to the child's frame, in which velocities are expressed.
fn at_joint(m: &Model, d: &Fields, j: usize, in_parent: bool, gear: &[f64; 6], out: &mut MomentRows) -> f64 {
    let (q, k) = (m.jnt_qposadr[j] as usize, m.jnt_dofadr[j] as usize);
    let [a, b, c, e, f, g] = *gear;
    let turned = |v: Vec3, q: usize| if in_parent { rotate(v, quat_conj(quaternion(d, q))) } else { v };
    let mut all = |first: usize, v: Vec3| (0..3).for_each(|i| out.push_any(first + i, v[i]));
    match m.jnt_type[j] {
        joint::SLIDE | joint::HINGE => {
            out.push_any(k, a);
            d.qpos[q] * a
        }
        joint::BALL => {
            let gear = turned([a, b, c], q);
            all(k, gear);
            dot(joint_rotation(d, q), gear)
        }
        _ => {
            all(k, [a, b, c]);
            all(k + 3, turned([e, f, g], q + 3));
            0.0
        }
    }
}

impl MomentRows {
    /// Appends an entry, zero or not. Rows of joints and tendons have a fixed pattern.
    fn push_any(&mut self, dof: usize, value: f64) {
        if let (Some(k), Some(x)) = (self.colind.get_mut(self.cursor), self.values.get_mut(self.cursor)) {
            (*k, *x) = (dof as i32, value);
            self.cursor += 1;
        }
    }
}

/// The length of tendon `t`, scaled by the gear.
fn along_tendon(m: &Model, d: &Fields, t: usize, gear: f64, out: &mut MomentRows) -> f64 {
    let row = tendon::row(m, t);
    for (&k, x) in m.ten_J_colind[row.clone()].iter().zip(&d.ten_J[row]) {
        out.push_any(k as usize, x * gear);
    }
    d.ten_length[t] * gear
}

/// Computes `actuator_velocity` = moment v. Zero if actuators are disabled.
pub(crate) fn velocities(m: &Model, d: &mut Fields) {
    if m.opt.disabled(disable::ACTUATION) {
        d.actuator_velocity.fill(0.0);
        return;
    }
    let rows = d.moment_rowadr.iter().zip(&d.moment_rownnz);
    for (velocity, (&start, &number)) in d.actuator_velocity.iter_mut().zip(rows) {
        let row = start as usize..(start + number) as usize;
        let terms = d.moment_colind[row.clone()].iter().zip(&d.actuator_moment[row]);
        *velocity = terms.map(|(&k, x)| x * d.qvel[k as usize]).sum();
    }
}

/// Computes `qfrc_actuator` = momentᵀ force.
pub(crate) fn apply_forces(m: &Model, d: &mut Fields) {
    d.qfrc_actuator.fill(0.0);
    for o in 0..m.nout {
        let force = d.actuator_force[o];
        for entry in row(d, o) {
            d.qfrc_actuator[d.moment_colind[entry] as usize] += d.actuator_moment[entry] * force;
        }
    }
}
