//! Derivatives of smooth forces with respect to velocities, for integrators that are implicit in velocity.
//!
//! ∂(`qfrc_actuator` + `qfrc_passive` - `qfrc_bias`)/∂`qvel` is stored for pairs of a degree of freedom and its ancestors and
//! descendants. Couplings of other pairs (a tendon over two branches) are left out, as in MuJoCo.

pub(crate) mod actuator_slope;
mod bias;
pub(crate) mod sparse;

use std::ops::Range;

use crate::dynamics::{jacobian, mass, tree_algorithms, walk};
use crate::forces::passive::fluid::{self, FluidFrame, FluidShape};
use crate::forces::passive::spring;
use crate::forces::tendon;
use crate::kinds::{disable, joint};
use crate::math::*;
use crate::model::plan::PlanFlag;
use crate::model::{Fields, Model};

/// Results that are recomputed in every step. The arrays are allocated at their first use.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Work {
    /// The derivative D, then the matrix M - h D and its factorization.
    pub(crate) whole: Vec<f64>,
    /// The derivative of the forces of actuators, dampers and the fluid.
    forces: Vec<f64>,
    /// Whether `forces` is valid for the current model and for the actuator derivatives in `actuators`.
    is_current: bool,
    actuators: Vec<f64>,
    /// The motion of a frame for a unit velocity of each degree of freedom that moves it.
    columns: Vec<Spatial>,
    /// The negative derivative of the damper force of each degree of freedom with respect to its velocity.
    slopes: Vec<f64>,
    bias: bias::BiasSums,
}

/// Which part of the fluid forces is differentiated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Medium {
    /// Everything.
    Whole,
    /// The symmetric part, for bodies that are not free rigid bodies.
    Symmetric,
    /// The symmetric part of drag and viscosity, which are dissipative.
    Drag,
}

impl Work {
    fn resize(&mut self, m: &Model) {
        self.whole.resize(m.nD, 0.0);
        self.forces.resize(m.nD, 0.0);
        self.actuators.resize(m.nactuator, 0.0);
        self.columns.resize(m.nv, [0.0; 6]);
        self.slopes.resize(m.nv, 0.0);
        self.bias.resize(m);
    }

    /// Marks the stored derivative as invalid, because the parameters of the model or the plan may have changed.
    pub(crate) fn invalidate(&mut self) {
        self.is_current = false;
    }
}

/// `w.whole` ← the derivative of the forces of actuators, dampers and the fluid.
///
/// If everything else is constant, only the derivatives of actuator forces may change. While these are the same, the stored
/// result is reused.
pub(crate) fn forces(m: &Model, d: &Fields, w: &mut Work, medium: Medium) {
    if !(w.is_current
        && d.plan.has(PlanFlag::ConstantVelocityDerivatives)
        && !actuator_slope::find(m, d, &mut w.actuators))
    {
        make_forces(m, d, w, medium);
    }
    w.whole.copy_from_slice(&w.forces);
}

fn make_forces(m: &Model, d: &Fields, w: &mut Work, medium: Medium) {
    w.resize(m);
    w.forces.fill(0.0);
    actuator_slope::find(m, d, &mut w.actuators);
    actuator_slope::add_velocity(m, d, &w.actuators, &mut w.forces);
    if !m.opt.disabled(disable::DAMPER) {
        dampers(m, d, w);
    }
    if fluid::acts(m) {
        let Work { forces, columns, .. } = w;
        add_fluid(m, d, columns, forces, medium);
    }
    w.is_current = true;
}

/// Subtracts the derivative of the bias force of all trees.
pub(crate) fn subtract_bias(m: &Model, d: &Fields, w: &mut Work) {
    bias::subtract(m, d, &mut w.bias, 1..m.nbody, 0..m.nv, &mut w.whole);
}

/// Subtracts the derivative of the bias force of one tree that is a free body.
pub(crate) fn subtract_tree_bias(m: &Model, d: &Fields, w: &mut Work, tree: usize) {
    if tree_algorithms::bias_is_free_torque(m, d.plan.algorithms, tree) {
        return subtract_gyroscopic(m, d, &mut w.whole, tree);
    }
    let first = m.tree_bodyadr[tree] as usize;
    let bodies = first..first + m.tree_bodynum[tree] as usize;
    bias::subtract(m, d, &mut w.bias, bodies, tree_dofs(m, tree), &mut w.whole);
}

/// Like [`subtract_tree_bias`], for a body with its inertia along its own axes, for which Euler's equations give the derivative
/// directly.
fn subtract_gyroscopic(m: &Model, d: &Fields, whole: &mut [f64], tree: usize) {
    let first = m.tree_dofs(tree).start + 3;
    let body = m.dof_bodyid[first] as usize;
    let turn = [d.qvel[first], d.qvel[first + 1], d.qvel[first + 2]];
    for (r, slope) in
        tree_algorithms::gyroscopic_jacobian(rows::<3>(&m.body_inertia)[body], turn).iter().enumerate()
    {
        let row = m.D_rowadr[first + r] as usize + 3;
        for (x, s) in whole[row..row + 3].iter_mut().zip(slope) {
            *x -= s;
        }
    }
}

/// The rows of one tree in `w.whole` ← the negative derivative of its bias force.
pub(crate) fn tree_bias(m: &Model, d: &Fields, w: &mut Work, tree: usize) {
    w.resize(m);
    for i in tree_dofs(m, tree) {
        let start = m.D_rowadr[i] as usize;
        w.whole[start..start + m.D_rownnz[i] as usize].fill(0.0);
    }
    subtract_tree_bias(m, d, w, tree);
}

/// `w.whole` ← the derivative of the fluid forces.
pub(crate) fn medium(m: &Model, d: &Fields, w: &mut Work, medium: Medium) {
    w.resize(m);
    w.whole.fill(0.0);
    add_fluid(m, d, &mut w.columns, &mut w.whole, medium);
}

/// M - h D for a free joint, given its first degree of freedom. `mass` may be another matrix than M.
pub(crate) fn free_block(m: &Model, mass: &[f64], w: &Work, h: f64, first: usize) -> [Spatial; 6] {
    let mut out = mass::free_block(m, mass, first);
    let rows = w.whole.get(m.D_rowadr[first] as usize..).and_then(|rows| rows.first_chunk::<36>());
    if let Some(rows) = rows {
        for (x, y) in out.as_flattened_mut().iter_mut().zip(rows) {
            *x -= h * y;
        }
    }
    out
}

/// The degrees of freedom of a tree.
pub(crate) fn tree_dofs(m: &Model, tree: usize) -> Range<usize> {
    let first = m.tree_dofadr[tree] as usize;
    first..first + m.tree_dofnum[tree] as usize
}

/// Whether a tree is a free rigid body.
pub(crate) fn is_free_rigid(m: &Model, tree: usize) -> bool {
    let dofs = tree_dofs(m, tree);
    dofs.len() == 6 && m.jnt_type[m.dof_jntid[dofs.start] as usize] == joint::FREE
}

/// Adds the derivatives of the dampers of joints and tendons.
fn dampers(m: &Model, d: &Fields, w: &mut Work) {
    let Work { forces: out, slopes, .. } = w;
    let actuators = d.plan.has(PlanFlag::ActuatorDampers);
    spring::of_dampers(m, actuators, &d.qvel, slopes, |law, v| law.slope(v.abs()));
    for (i, slope) in slopes.iter().enumerate().filter(|(_, slope)| **slope != 0.0) {
        out[sparse::diagonal(m, i)] -= slope;
    }
    for t in 0..m.ntendon {
        let law = spring::tendon_damper(m, t);
        if !law.is_zero() {
            let row = tendon::row(m, t);
            let (dofs, values) = (&m.ten_J_colind[row.clone()], &d.ten_J[row]);
            sparse::add_outer(m, dofs, values, -law.slope(d.ten_velocity[t].abs()), out);
        }
    }
}

/// Adds Jᵀ B J for the derivative B of the fluid forces on every body or geom.
fn add_fluid(m: &Model, d: &Fields, columns: &mut [Spatial], out: &mut [f64], medium: Medium) {
    fluid::shapes(m, d, |frame, shape| {
        let last = walk::last_dof(m, frame.body);
        if last < 0 {
            return;
        }
        let last = last as usize;
        let slope = slope(m, frame, shape, medium);
        let dofs = || sparse::ancestors(m, last).iter().map(|&k| k as usize).chain([last]);
        for (k, column) in dofs().zip(columns.iter_mut()) {
            let (turn, shift) = jacobian::dof_motion(m, d, k, frame.pos);
            let (turn, shift) = (mat_t_mul_vec(&frame.mat, turn), mat_t_mul_vec(&frame.mat, shift));
            *column = spatial(turn, shift);
        }
        for (b, j) in dofs().enumerate() {
            let force: Spatial = std::array::from_fn(|r| dot(slope[r], columns[b]));
            for (a, i) in dofs().enumerate() {
                // Element (i, j): the force along i for a velocity of j.
                let place = match i.cmp(&j) {
                    std::cmp::Ordering::Less => sparse::pair(m, j, i, a).1,
                    std::cmp::Ordering::Equal => sparse::diagonal(m, i),
                    std::cmp::Ordering::Greater => sparse::pair(m, i, j, b).0,
                };
                out[place] += dot(columns[a], force);
            }
        }
    });
}

/// The derivative of torque and force with respect to the motion, row by row.
fn slope(m: &Model, frame: &FluidFrame, shape: &FluidShape, medium: Medium) -> [Spatial; 6] {
    let mut b = [[0.0; 6]; 6];
    match shape {
        FluidShape::Box(inertia) => {
            for (r, x) in inertia.derivative(frame.motion).into_iter().enumerate() {
                b[r][r] = x;
            }
        }
        FluidShape::Ellipsoid(ellipsoid) if medium == Medium::Drag => {
            let [torque, force] = ellipsoid.drag(frame.motion);
            for (r, row) in b.iter_mut().enumerate() {
                let (from, column) = if r < 3 { (&torque, 0) } else { (&force, 3) };
                row[column..column + 3].copy_from_slice(&from[3 * (r % 3)..][..3]);
            }
        }
        FluidShape::Ellipsoid(ellipsoid) => b = ellipsoid.derivative(frame.motion),
    }
    let tree = m.body_treeid[frame.body];
    let symmetric = match medium {
        Medium::Whole => false,
        Medium::Symmetric => !(tree >= 0 && is_free_rigid(m, tree as usize)),
        Medium::Drag => true,
    };
    if symmetric {
        for r in 0..6 {
            for c in 0..r {
                let mean = 0.5 * (b[r][c] + b[c][r]);
                (b[r][c], b[c][r]) = (mean, mean);
            }
        }
    }
    b
}
