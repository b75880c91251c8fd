//! The kinetic energy of bodies, from their poses and the velocities of joints.
//!
//! For the velocity v of the centre of mass of a body, its angular velocity ω and its principal moments of inertia I_k, it is
//! ½ Σ (m |v|² + Σ_k I_k ω_k²) with the components ω_k along the principal axes (König's theorem). It needs neither spatial inertias
//! nor the mass matrix.

use super::DynamicsScratch;
use crate::kinds::joint;
use crate::math::*;
use crate::model::index::element_range;
use crate::model::{Fields, Model};

/// The motion of a body, world frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct BodyMotion {
    /// Angular velocity, rad/s.
    angular: Vec3,
    /// Velocity of the centre of mass, m/s.
    linear: Vec3,
}

/// The kinetic energy of all bodies whose inertia follows their pose, J. The inertia of simple bodies is constant in M.
pub(crate) fn of_bodies(m: &Model, d: &Fields, w: &mut DynamicsScratch) -> f64 {
    let (moments, ximat) = (rows::<3>(&m.body_inertia), rows::<9>(&d.ximat));
    let mut twice = 0.0;
    for i in 1..m.nbody {
        let motion = of_body(m, d, i, &w.motions[m.body_parentid[i] as usize]);
        w.motions[i] = motion;
        if m.body_simple[i] == 0 {
            let turning = mat_t_mul_vec(&ximat[i], motion.angular);
            let squares = [turning[0] * turning[0], turning[1] * turning[1], turning[2] * turning[2]];
            twice += m.body_mass[i] * dot(motion.linear, motion.linear) + dot(moments[i], squares);
        }
    }
    0.5 * twice
}

/// The motion of a body, from that of its parent and the velocities of its joints.
#[cfg_attr(not(feature = "small"), inline(always))]
fn of_body(m: &Model, d: &Fields, i: usize, parent: &BodyMotion) -> BodyMotion {
    let xipos = rows::<3>(&d.xipos);
    let (xanchor, xaxis) = (rows::<3>(&d.xanchor), rows::<3>(&d.xaxis));
    let centre = xipos[i];
    let mut motion = *parent;
    // The parent moves this point as if the two bodies were one.
    let lever = sub(centre, xipos[m.body_parentid[i] as usize]);
    motion.linear = add(motion.linear, cross(motion.angular, lever));
    for j in element_range(m.body_jntadr[i], m.body_jntnum[i]) {
        let mut k = m.jnt_dofadr[j] as usize;
        let angular = match m.jnt_type[j] {
            joint::SLIDE => {
                motion.linear = add_scaled(motion.linear, xaxis[j], d.qvel[k]);
                continue;
            }
            joint::HINGE => scale(xaxis[j], d.qvel[k]),
            kind => {
                if kind == joint::FREE {
                    motion.linear = add(motion.linear, [d.qvel[k], d.qvel[k + 1], d.qvel[k + 2]]);
                    k += 3;
                }
                mat_mul_vec(&rows::<9>(&d.xmat)[i], [d.qvel[k], d.qvel[k + 1], d.qvel[k + 2]])
            }
        };
        motion.angular = add(motion.angular, angular);
        motion.linear = add(motion.linear, cross(angular, sub(centre, xanchor[j])));
    }
    motion
}
