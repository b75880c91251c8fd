//! Short chains in space.

use super::{ChainLink, LinkMotion, LinkPose, MAX_DOFS, length};
use crate::math::lanes::rotate_columns;
use crate::math::*;

/// Computes the rows of M of a chain.
pub(super) fn mass_matrix<const N: usize>(chain: &mut [ChainLink], qpos: &[f64], mass: &mut [f64]) {
    let n = length::<N>(chain);
    let Some(chain) = chain.get_mut(..n) else {
        return broken_invariant("a chain is as long as its length");
    };
    // All displacements before the poses, so that the sines do not wait for them.
    let mut displacements = [(0.0, 0.0); MAX_DOFS];
    for (link, displacement) in chain.iter().zip(&mut displacements) {
        let q = qpos[link.coordinate] - link.fixed.reference;
        *displacement = if link.slides { (q, 0.0) } else { libm::sincos(q) };
    }
    let mut parent = None;
    for (link, displacement) in chain.iter_mut().zip(displacements) {
        link.pose = link.forward_kinematics(parent.as_ref(), displacement);
        parent = Some(link.pose);
    }
    let mut rows = [[0.0; MAX_DOFS]; MAX_DOFS];
    for i in 0..n {
        rows[i][i] = chain[i].fixed.armature;
    }
    for i in 0..n {
        if chain[i].fixed.massless {
            continue;
        }
        let pose = chain[i].pose;
        for k in 0..=i {
            let up = &chain[k];
            chain[i].columns[k] = if up.slides {
                ([0.0; 3], up.pose.axis)
            } else {
                let turn = if k == i { up.fixed.axis } else { mat_t_mul_vec(&pose.axes, up.pose.axis) };
                (turn, cross(up.pose.axis, sub(pose.com, up.pose.anchor)))
            };
        }
        let ChainLink { fixed, columns, .. } = &chain[i];
        for k in 0..=i {
            let (turn, shift) = columns[k];
            let (spin, push) = (rotational_inertia_times(&fixed.inertia, turn), scale(shift, fixed.mass));
            for j in 0..=k {
                rows[k][j] += dot(columns[j].0, spin) + dot(columns[j].1, push);
            }
        }
    }
    for i in 0..n {
        if let Some(to) = mass.get_mut(chain[i].row..chain[i].row + i + 1) {
            to.copy_from_slice(&rows[i][..i + 1]);
        }
    }
}

impl ChainLink {
    /// The pose for a displacement of the joint: the sine and cosine of an angle, or a distance and 0.
    #[cfg_attr(not(feature = "small"), inline(always))]
    fn forward_kinematics(&self, parent: Option<&LinkPose>, displacement: (f64, f64)) -> LinkPose {
        let f = &self.fixed;
        let (mut anchor, mut axes) = match parent {
            None => (f.position, f.turn),
            Some(p) => (
                add(mat_mul_vec(&p.axes, f.position), p.anchor),
                if f.straight { p.axes } else { mat_mul(&p.axes, &f.turn) },
            ),
        };
        let axis = mat_mul_vec(&axes, f.axis);
        let (s, c) = displacement;
        if self.slides {
            anchor = add_scaled(anchor, axis, s);
        } else {
            axes = rotate_columns(&axes, f.axis, s, c);
        }
        LinkPose { anchor, axes, axis, com: add(mat_mul_vec(&axes, f.com), anchor) }
    }
}

/// Computes the bias force of a chain.
pub(super) fn bias<const N: usize>(
    chain: &mut [ChainLink],
    qvel: &[f64],
    qfrc_bias: &mut [f64],
    gravity: Vec3,
) {
    let n = length::<N>(chain);
    let Some(chain) = chain.get_mut(..n) else {
        return broken_invariant("a chain is as long as its length");
    };
    let first = chain[0].dof;
    let (Some(v), Some(out)) = (qvel.get(first..first + n), qfrc_bias.get_mut(first..first + n)) else {
        return broken_invariant("every link of a chain has a degree of freedom");
    };
    let mut forces = [0.0; MAX_DOFS];
    // Gravity is included as an upward acceleration of the world.
    let mut motion = LinkMotion { acceleration: scale(gravity, -1.0), ..LinkMotion::default() };
    for i in 0..n {
        let ChainLink { fixed, pose, columns, slides, .. } = &chain[i];
        let rate = scale(pose.axis, v[i]);
        if i > 0 {
            motion.acceleration = motion.at(sub(pose.anchor, chain[i - 1].pose.anchor));
            let extra = cross(motion.velocity, rate);
            if *slides {
                motion.acceleration = add_scaled(motion.acceleration, extra, 2.0);
            } else {
                motion.turning = add(motion.turning, extra);
            }
        }
        if !slides {
            motion.velocity = add(motion.velocity, rate);
        }
        if fixed.massless {
            continue;
        }
        let force = scale(motion.at(sub(pose.com, pose.anchor)), fixed.mass);
        let w = mat_t_mul_vec(&pose.axes, motion.velocity);
        let turning = rotational_inertia_times(&fixed.inertia, mat_t_mul_vec(&pose.axes, motion.turning));
        let torque = add(turning, cross(w, rotational_inertia_times(&fixed.inertia, w)));
        for k in 0..=i {
            forces[k] += dot(columns[k].0, torque) + dot(columns[k].1, force);
        }
    }
    out.copy_from_slice(&forces[..n]);
}

impl LinkMotion {
    /// The acceleration of a point at `arm` from the anchor.
    #[cfg_attr(not(feature = "small"), inline(always))]
    fn at(&self, arm: Vec3) -> Vec3 {
        let w = self.velocity;
        add(self.acceleration, add(cross(self.turning, arm), cross(w, cross(w, arm))))
    }
}

/// I v
#[cfg_attr(not(feature = "small"), inline(always))]
fn rotational_inertia_times(i: &[f64; 6], v: Vec3) -> Vec3 {
    [
        i[0] * v[0] + i[3] * v[1] + i[4] * v[2],
        i[3] * v[0] + i[1] * v[1] + i[5] * v[2],
        i[4] * v[0] + i[5] * v[1] + i[2] * v[2],
    ]
}
