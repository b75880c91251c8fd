//! Tendons: lengths and Jacobians of paths over joints, sites, pulleys and wrapping geoms.
//!
//! A fixed tendon is a linear combination of joint coordinates. A spatial tendon is the shortest path through its sites and
//! around its geoms. A pulley divides it into branches, each scaled by a divisor. The model is documented in MuJoCo's
//! documentation, "Computation: Tendon".

mod pattern;
pub(crate) mod spatial_tendon;
mod tendon_constants;
mod wrap;

use crate::dynamics::mass;
use crate::dynamics::reflected::tendon_inertia;
use crate::kinds::wraptype;
use crate::math::*;
use crate::model::{Fields, Model, asleep};

pub use pattern::set_pattern;
pub use tendon_constants::{at_default, at_rest};

/// Whether tendon `t` is a combination of joint coordinates. Otherwise it is a spatial path.
pub(crate) fn is_fixed(m: &Model, t: usize) -> bool {
    m.wrap_type[m.tendon_adr[t] as usize] == wraptype::JOINT
}

/// Addresses of the non-zeros of a tendon's Jacobian.
pub(crate) fn row(m: &Model, t: usize) -> std::ops::Range<usize> {
    let start = m.ten_J_rowadr[t] as usize;
    start..start + m.ten_J_rownnz[t] as usize
}

/// Computes `ten_length`, `ten_J` and the points of the paths. The length of a sleeping tendon is zero, and its points do not
/// change.
pub fn tendons(m: &Model, d: &mut Fields) {
    d.ten_J.fill(0.0);
    let mut points = 0;
    for t in 0..m.ntendon {
        if asleep::tendon(m, d, t) {
            d.ten_length[t] = 0.0;
            continue;
        }
        let first = points;
        d.ten_length[t] =
            if is_fixed(m, t) { fixed(m, d, t) } else { spatial_tendon::spatial(m, d, t, &mut points) };
        d.ten_wrapadr[t] = first as i32;
        d.ten_wrapnum[t] = (points - first) as i32;
    }
}

/// The length Σ c q of a fixed tendon; its Jacobian is c.
fn fixed(m: &Model, d: &mut Fields, t: usize) -> f64 {
    let row = row(m, t);
    let (columns, jacobian) = (&m.ten_J_colind[row.clone()], &mut d.ten_J[row]);
    let path = m.tendon_adr[t] as usize..(m.tendon_adr[t] + m.tendon_num[t]) as usize;
    let (mut length, mut next) = (0.0, 0);
    for (&joint, coefficient) in m.wrap_objid[path.clone()].iter().zip(&m.wrap_prm[path]) {
        let joint = joint as usize;
        length += coefficient * d.qpos[m.jnt_qposadr[joint] as usize];
        // Joints are usually in the order of their degrees of freedom.
        let dof = m.jnt_dofadr[joint];
        let found = if columns.get(next) == Some(&dof) { Ok(next) } else { columns.binary_search(&dof) };
        if let Ok(index) = found {
            jacobian[index] += coefficient;
            next = index + 1;
        }
    }
    length
}

/// Adds a Jᵀ J to the existing entries of M for tendons with armature a. Trees stay uncoupled.
pub fn armature(m: &Model, d: &mut Fields) {
    for t in 0..m.ntendon {
        let a = tendon_inertia(m, t);
        if a == 0.0 {
            continue;
        }
        let row = row(m, t);
        mass::add_outer(m, &m.ten_J_colind[row.clone()], &d.ten_J[row], a, &mut d.M);
    }
}

/// Computes `ten_velocity` = J v.
pub(crate) fn velocities(m: &Model, d: &mut Fields) {
    for t in 0..m.ntendon {
        d.ten_velocity[t] = along(m, d, t, &d.qvel);
    }
}

/// The rate of change of the length of tendon `t` for joint velocities v (nv).
pub(crate) fn along(m: &Model, d: &Fields, t: usize, v: &[f64]) -> f64 {
    let row = row(m, t);
    m.ten_J_colind[row.clone()].iter().zip(&d.ten_J[row]).map(|(&k, x)| x * v[k as usize]).sum()
}

/// Adds a Jᵀ (J̇ v) to `qfrc_bias` for tendons with armature a.
pub(crate) fn bias(m: &Model, d: &mut Fields) {
    for t in 0..m.ntendon {
        let a = tendon_inertia(m, t);
        if a != 0.0 && !is_fixed(m, t) {
            let force = a * spatial_tendon::acceleration(m, d, t);
            add_force(m, t, &d.ten_J, force, &mut d.qfrc_bias);
        }
    }
}

/// out += Jᵀ f for a force f along tendon `t`.
pub(crate) fn add_force(m: &Model, t: usize, jacobian: &[f64], force: f64, out: &mut [f64]) {
    let row = row(m, t);
    for (&k, x) in m.ten_J_colind[row.clone()].iter().zip(&jacobian[row]) {
        out[k as usize] += x * force;
    }
}

/// The difference of a tendon's length to the range in which its spring is relaxed, m. Negative if the tendon is shorter.
pub(crate) fn spring_displacement(m: &Model, d: &Fields, t: usize) -> f64 {
    let length = d.ten_length[t];
    let [lower, upper] = rows::<2>(&m.tendon_lengthspring)[t];
    if length > upper {
        length - upper
    } else if length < lower {
        length - lower
    } else {
        0.0
    }
}
