//! Springs and dampers of joints and tendons.
//!
//! The force of a spring with stiffness k and coefficients p is f = -x (k + p₁ x + p₂ x²) at displacement x. For a translation or
//! rotation in space, x is the distance or the angle, and the force has the opposite direction. The force of a damper is f = -v
//! (b + p₁ |v| + p₂ v²).

use crate::dynamics::reflected::{self, On};
use crate::forces::tendon;
use crate::kinds::joint;
use crate::math::*;
use crate::model::plan::PlanFlag;
use crate::model::{Fields, Model, asleep};

/// The coefficients of a spring or a damper.
#[derive(Clone, Copy)]
pub(crate) struct Law {
    linear: f64,
    growth: [f64; 2],
}

impl Law {
    /// The coefficients of one joint, degree of freedom or tendon.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(crate) fn new(linear: &[f64], growth: &[f64], i: usize) -> Law {
        Law { linear: linear[i], growth: rows::<2>(growth)[i] }
    }

    /// The sum with further coefficients of the same kind.
    #[cfg_attr(not(feature = "small"), inline(always))]
    fn plus(self, [linear, first, second]: [f64; 3]) -> Law {
        Law { linear: self.linear + linear, growth: [self.growth[0] + first, self.growth[1] + second] }
    }

    /// The negative derivative of the force of a damper at speed x: b + 2 p₁ x + 3 p₂ x².
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(crate) fn slope(self, x: f64) -> f64 {
        self.linear + x * (2.0 * self.growth[0] + x * 3.0 * self.growth[1])
    }

    /// Whether all coefficients are zero.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(crate) fn is_zero(self) -> bool {
        self.linear == 0.0 && self.growth == [0.0; 2]
    }

    /// The force divided by the displacement or velocity, at x.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(crate) fn at(self, x: f64) -> f64 {
        self.linear + x * (self.growth[0] + x * self.growth[1])
    }

    /// Energy of a spring at displacement x: k x²/2 + p₁ x³/3 + p₂ x⁴/4.
    pub(crate) fn energy(self, x: f64) -> f64 {
        x * x * (0.5 * self.linear + x * (self.growth[0] / 3.0 + x * 0.25 * self.growth[1]))
    }
}

/// Computes the forces of joint springs, `qfrc_spring`.
pub(super) fn joint_springs(m: &Model, d: &mut Fields) {
    let laws = m.jnt_stiffness.iter().zip(rows::<2>(&m.jnt_stiffnesspoly));
    for (j, (&linear, &growth)) in laws.enumerate() {
        let law = Law { linear, growth };
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

/// The displacement of the spring of a free or ball joint: translation (free joint only) and rotation vector.
pub(crate) fn displacements(m: &Model, d: &Fields, j: usize) -> (Option<Vec3>, Vec3) {
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

/// The negative derivative of the damper force of degree of freedom `i` with respect to its velocity, including dampers of
/// actuators.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn joint_damping(m: &Model, d: &Fields, i: usize) -> f64 {
    with_actuators(m, i, Law::new(&m.dof_damping, &m.dof_dampingpoly, i)).slope(d.qvel[i].abs())
}

#[cfg_attr(not(feature = "small"), inline(always))]
fn with_actuators(m: &Model, i: usize, spring: Law) -> Law {
    let joint = m.dof_jntid[i] as usize;
    // Few joints have a damper of an actuator.
    if m.jnt_actuatorid[joint] == -1 {
        return spring;
    }
    spring.plus(reflected::damping(m, On::Joint(joint)))
}

/// Fills `out` (nv) with a function of the damper and the velocity of each degree of freedom. Dampers of actuators are included
/// if `actuators` is set.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn of_dampers(
    m: &Model,
    actuators: bool,
    qvel: &[f64],
    out: &mut [f64],
    number: impl Fn(Law, f64) -> f64,
) {
    let n = out.len();
    let (linear, growth, v) = (&m.dof_damping[..n], &rows::<2>(&m.dof_dampingpoly)[..n], &qvel[..n]);
    let law = |k: usize| Law { linear: linear[k], growth: growth[k] };
    if actuators {
        (0..n).for_each(|k| out[k] = number(with_actuators(m, k, law(k)), v[k]));
    } else {
        each(n, |k| out[k] = number(law(k), v[k]));
    }
}

/// The damper of tendon `t`, including those of actuators.
pub(crate) fn tendon_damper(m: &Model, t: usize) -> Law {
    Law::new(&m.tendon_damping, &m.tendon_dampingpoly, t).plus(reflected::damping(m, On::Tendon(t)))
}

/// Computes the forces of joint dampers, `qfrc_damper`.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(super) fn damp_joints(m: &Model, d: &mut Fields) {
    of_dampers(m, d.plan.has(PlanFlag::ActuatorDampers), &d.qvel, &mut d.qfrc_damper, |law, v| {
        // Without a damper, the force is 0 and not -0, as in a plan that leaves this stage out.
        if law.is_zero() { 0.0 } else { -law.at(v.abs()) * v }
    });
}

/// Adds the forces of the springs and dampers of tendons to `qfrc_spring` and `qfrc_damper`. A spring is relaxed between
/// the two lengths of `tendon_lengthspring`.
pub(super) fn tendons(m: &Model, d: &mut Fields, springs: bool, dampers: bool) {
    for t in 0..m.ntendon {
        let [spring, damper] = tendon_force(m, d, t, springs, dampers);
        if spring != 0.0 {
            tendon::add_force(m, t, &d.ten_J, spring, &mut d.qfrc_spring);
        }
        if damper != 0.0 {
            tendon::add_force(m, t, &d.ten_J, damper, &mut d.qfrc_damper);
        }
    }
}

/// The forces of the spring and the damper of a tendon along its length, N.
pub(crate) fn tendon_force(m: &Model, d: &Fields, t: usize, springs: bool, dampers: bool) -> [f64; 2] {
    let mut forces = [0.0; 2];
    let spring = Law::new(&m.tendon_stiffness, &m.tendon_stiffnesspoly, t);
    if springs && !spring.is_zero() {
        let x = tendon::spring_displacement(m, d, t);
        forces[0] = -spring.at(x) * x;
    }
    let damper = tendon_damper(m, t);
    if dampers && !damper.is_zero() {
        let v = d.ten_velocity[t];
        forces[1] = -damper.at(v.abs()) * v;
    }
    forces
}

/// The energy of all springs, J.
pub(crate) fn energy(m: &Model, d: &Fields) -> f64 {
    let mut e = 0.0;
    for j in 0..m.njnt {
        let law = Law::new(&m.jnt_stiffness, &m.jnt_stiffnesspoly, j);
        if law.is_zero() || asleep::body(m, d, m.jnt_bodyid[j] as usize) {
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
        if !law.is_zero() && !asleep::tendon(m, d, t) {
            e += law.energy(tendon::spring_displacement(m, d, t));
        }
    }
    e
}
