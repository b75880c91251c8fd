//! Springs and dampers of joints and tendons.
//!
//! A spring with stiffness k and coefficients p pulls with f = -x (k + p₁ x + p₂ x²) at displacement x; for a
//! translation or rotation in space x is the distance or the angle, and the force points back. A damper
//! resists with f = -v (b + p₁ |v| + p₂ v²).

use crate::math::*;
use crate::{Data, Model, joint, tendon, trntype};

/// More than one actuator adds to a joint or tendon, in `jnt_actuatorid` and `tendon_actuatorid`.
const SEVERAL: i32 = -2;

/// The coefficients of a spring or a damper.
#[derive(Clone, Copy)]
pub(crate) struct Law {
    linear: f64,
    growth: [f64; 2],
}

impl Law {
    /// The law of one joint, degree of freedom or tendon.
    #[inline(always)]
    pub(crate) fn new(linear: &[f64], growth: &[f64], i: usize) -> Law {
        Law { linear: linear[i], growth: rows::<2>(growth)[i] }
    }

    /// The damper of a degree of freedom, together with those of actuators on its joint.
    pub(crate) fn dof_damper(m: &Model, i: usize) -> Law {
        let law = Law::new(&m.dof_damping, &m.dof_dampingpoly, i);
        let j = m.dof_jntid[i];
        law.with_actuators(m, m.jnt_actuatorid[j as usize], &[trntype::JOINT, trntype::JOINTINPARENT], j)
    }

    /// The damper of a tendon, together with those of actuators on it.
    pub(crate) fn tendon_damper(m: &Model, t: usize) -> Law {
        let law = Law::new(&m.tendon_damping, &m.tendon_dampingpoly, t);
        law.with_actuators(m, m.tendon_actuatorid[t], &[trntype::TENDON], t as i32)
    }

    /// Adds the dampers of actuators, each times the square of its gear: of `actuator`, or when that is
    /// [`SEVERAL`], of all that act through one of these transmissions on `target`.
    #[inline(always)]
    fn with_actuators(self, m: &Model, actuator: i32, kinds: &[i32], target: i32) -> Law {
        match actuator {
            SEVERAL => (0..m.nactuator)
                .filter(|&i| m.actuator_trnid[2 * i] == target && kinds.contains(&m.actuator_trntype[i]))
                .fold(self, |law, i| law.with_actuator(m, i)),
            ..0 => self,
            i => self.with_actuator(m, i as usize),
        }
    }

    fn with_actuator(self, m: &Model, i: usize) -> Law {
        let gear = rows::<6>(&m.actuator_gear)[m.actuator_outadr[i] as usize][0];
        let added = Law::new(&m.actuator_damping, &m.actuator_dampingpoly, i);
        let square = gear * gear;
        Law {
            linear: self.linear + square * added.linear,
            growth: add_scaled(self.growth, added.growth, square),
        }
    }

    /// Nothing there.
    #[inline(always)]
    pub(crate) fn is_zero(self) -> bool {
        self.linear == 0.0 && self.growth == [0.0; 2]
    }

    /// Force for a unit displacement or velocity, at x.
    #[inline(always)]
    pub(crate) fn at(self, x: f64) -> f64 {
        self.linear + x * (self.growth[0] + x * self.growth[1])
    }

    /// Derivative of the force of a spring at displacement x, or of a damper at velocity x, without its sign:
    /// k + 2 p₁ x + 3 p₂ x², with the magnitude of a velocity.
    #[inline(always)]
    pub(crate) fn slope(self, x: f64) -> f64 {
        self.linear + x * (2.0 * self.growth[0] + x * 3.0 * self.growth[1])
    }

    /// Energy of a spring at displacement x: k x²/2 + p₁ x³/3 + p₂ x⁴/4.
    pub(crate) fn energy(self, x: f64) -> f64 {
        x * x * (0.5 * self.linear + x * (self.growth[0] / 3.0 + x * 0.25 * self.growth[1]))
    }
}

/// The springs of joints, by `qfrc_spring`.
pub(super) fn joint_springs(m: &Model, d: &mut Data) {
    for j in 0..m.njnt {
        let law = Law::new(&m.jnt_stiffness, &m.jnt_stiffnesspoly, j);
        if law.is_zero() {
            continue;
        }
        let (q, v) = (m.jnt_qposadr[j] as usize, m.jnt_dofadr[j] as usize);
        if matches!(m.jnt_type[j], joint::SLIDE | joint::HINGE) {
            let x = d.qpos[q] - m.qpos_spring[q];
            d.qfrc_spring[v] = -law.at(x) * x;
            continue;
        }
        let (shift, turn) = displacements(m, d, j);
        let mut first = v;
        for x in [shift, Some(turn)].into_iter().flatten() {
            let k = law.at(norm(x));
            for i in 0..3 {
                d.qfrc_spring[first + i] = -k * x[i];
            }
            first += 3;
        }
    }
}

/// How far the spring of a free or ball joint is stretched: translation (free only) and rotation vector.
pub(crate) fn displacements(m: &Model, d: &Data, j: usize) -> (Option<Vec3>, Vec3) {
    let q = m.jnt_qposadr[j] as usize;
    if m.jnt_type[j] == joint::FREE {
        let shift = [0, 1, 2].map(|i| d.qpos[q + i] - m.qpos_spring[q + i]);
        (Some(shift), ball_displacement(&d.qpos[q + 3..], &m.qpos_spring[q + 3..]))
    } else {
        (None, ball_displacement(&d.qpos[q..], &m.qpos_spring[q..]))
    }
}

/// The rotation vector from `reference` to `q`, both quaternions, in the frame of `reference`.
fn ball_displacement(q: &[f64], reference: &[f64]) -> Vec3 {
    let q = quat_normalize([q[0], q[1], q[2], q[3]]);
    let r = [reference[0], reference[1], reference[2], reference[3]];
    quat_to_vel(quat_mul(quat_conj(r), q))
}

/// The dampers of joints, by `qfrc_damper`.
pub(super) fn joint_dampers(m: &Model, d: &mut Data) {
    for i in 0..m.nv {
        let law = Law::dof_damper(m, i);
        // Without a damper the force is 0, not -0: a plan that leaves this stage out finds the same.
        if !law.is_zero() {
            let v = d.qvel[i];
            d.qfrc_damper[i] = -law.at(v.abs()) * v;
        }
    }
}

/// The springs and dampers of tendons, added to `qfrc_spring` and `qfrc_damper`. A spring is relaxed between
/// the two lengths of `tendon_lengthspring`.
pub(super) fn tendons(m: &Model, d: &mut Data, springs: bool, dampers: bool) {
    for t in 0..m.ntendon {
        let spring = Law::new(&m.tendon_stiffness, &m.tendon_stiffnesspoly, t);
        let damper = Law::tendon_damper(m, t);
        if springs && !spring.is_zero() {
            let x = tendon::spring_displacement(m, d, t);
            let force = -spring.at(x) * x;
            tendon::add_force(m, t, &d.ten_J, force, &mut d.qfrc_spring);
        }
        if dampers && !damper.is_zero() {
            let v = d.ten_velocity[t];
            let force = -damper.at(v.abs()) * v;
            tendon::add_force(m, t, &d.ten_J, force, &mut d.qfrc_damper);
        }
    }
}

/// The energy of all springs, J.
pub(crate) fn energy(m: &Model, d: &Data) -> f64 {
    let mut e = 0.0;
    for j in 0..m.njnt {
        let law = Law::new(&m.jnt_stiffness, &m.jnt_stiffnesspoly, j);
        if law.is_zero() {
            continue;
        }
        if matches!(m.jnt_type[j], joint::SLIDE | joint::HINGE) {
            let q = m.jnt_qposadr[j] as usize;
            e += law.energy(d.qpos[q] - m.qpos_spring[q]);
            continue;
        }
        let (shift, turn) = displacements(m, d, j);
        e += shift.map_or(0.0, |x| law.energy(norm(x))) + law.energy(norm(turn));
    }
    for t in 0..m.ntendon {
        let law = Law::new(&m.tendon_stiffness, &m.tendon_stiffnesspoly, t);
        if !law.is_zero() {
            e += law.energy(tendon::spring_displacement(m, d, t));
        }
    }
    e
}
