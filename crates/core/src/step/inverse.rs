//! Inverse dynamics: the force that causes a given acceleration.

use crate::dynamics::mass;
use crate::forces::passive::spring;
use crate::forces::{derivative, derivative::Medium, derivative::sparse};
use crate::math::Spatial;
use crate::sensor::When;
use crate::step::integrate;
use crate::step::plan::Plan;
use crate::step::{forward, forward::Skip};
use crate::{Data, Model, constraint, enable, integrator};

/// What inverse dynamics cannot answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InverseError {
    /// The acceleration is that of a whole step (`invdiscrete`), of Runge and Kutta's method: it cannot be undone.
    RungeKutta,
}

impl std::fmt::Display for InverseError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(
            "inverse dynamics of a whole step (flag `invdiscrete`) is not known for the integrator RK4: choose \
             another integrator, or clear the flag",
        )
    }
}

impl std::error::Error for InverseError {}

/// `qfrc_inverse` from `qpos`, `qvel` and `qacc` (`mj_inverse`): what must be applied, by actuators or from outside,
/// to cause this acceleration. With the flag `invdiscrete`, `qacc` is (v⁺ - v)/h of a step instead.
///
/// All fields of position and velocity, the forces of constraints and sensors are computed, whatever the plan
/// says.
pub fn inverse(m: &Model, d: &mut Data) -> Result<(), InverseError> {
    if m.opt.enabled(enable::INVDISCRETE) && m.opt.integrator == integrator::RK4 {
        return Err(InverseError::RungeKutta);
    }
    let plan = std::mem::replace(&mut d.plan, Plan::default().keeping_all());
    forward::from_state(m, d, Skip::NOTHING);
    from_velocity(m, d, Skip::NOTHING);
    d.plan = plan;
    Ok(())
}

/// The same once position and velocity are known.
fn from_velocity(m: &Model, d: &mut Data, skip: Skip) {
    let mut given = std::mem::take(&mut d.work.rk.slope);
    given.copy_from_slice(&d.qacc);
    if m.opt.enabled(enable::INVDISCRETE) {
        continuous(m, d);
    }
    if m.opt.integrator == integrator::DISCRETE {
        integrate::discrete::prepare_inverse(m, d);
    }
    constraint::inverse(m, d);
    forward::read(m, d, When::Acceleration, skip);
    mass::mul(m, &d.M, &d.qacc, &mut d.qfrc_inverse, 0..m.nv);
    if m.opt.integrator == integrator::DISCRETE {
        integrate::discrete::add_to_inverse(m, d);
    }
    let internal = d.qfrc_bias.iter().zip(&d.qfrc_passive);
    for (f, ((bias, passive), constraint)) in d.qfrc_inverse.iter_mut().zip(internal.zip(&d.qfrc_constraint))
    {
        *f += bias - passive - constraint;
    }
    d.qacc.copy_from_slice(&given);
    d.work.rk.slope = given;
}

/// `qacc` of a step to that of the equations of motion: what the integrator adds to M acts on it.
fn continuous(m: &Model, d: &mut Data) {
    let h = m.opt.timestep;
    let mut force = std::mem::take(&mut d.work.qacc);
    match m.opt.integrator {
        integrator::EULER => {
            mass::mul(m, &d.M, &d.qacc, &mut force, 0..m.nv);
            if integrate::damps(m, d) {
                for i in 0..m.nv {
                    force[i] += h * spring::joint_damping(m, d, i) * d.qacc[i];
                }
            }
        }
        integrator::IMPLICIT => {
            let mut w = std::mem::take(&mut d.work.derivative);
            derivative::forces(m, d, &mut w, Medium::Whole);
            derivative::subtract_bias(m, d, &mut w);
            sparse::mass_minus(m, &d.M, h, &mut w.whole);
            sparse::mul(m, &w.whole, &d.qacc, &mut force);
            d.work.derivative = w;
        }
        integrator::IMPLICITFAST => {
            let (mut w, mut matrix) =
                (std::mem::take(&mut d.work.derivative), std::mem::take(&mut d.work.ld));
            derivative::forces(m, d, &mut w, Medium::Symmetric);
            matrix.copy_from_slice(&d.M);
            sparse::subtract_lower(m, &w.whole, h, &mut matrix);
            mass::mul(m, &matrix, &d.qacc, &mut force, 0..m.nv);
            for tree in (0..m.ntree).filter(|&t| derivative::is_free_rigid(m, t)) {
                derivative::subtract_tree_bias(m, d, &mut w, tree);
                let first = m.tree_dofadr[tree] as usize;
                let a: Spatial = std::array::from_fn(|r| d.qacc[first + r]);
                let block = derivative::free_block(m, &d.M, &w, h, first);
                for (f, row) in force[first..first + 6].iter_mut().zip(block) {
                    *f = crate::math::dot(row, a);
                }
            }
            (d.work.derivative, d.work.ld) = (w, matrix);
        }
        // The discrete integrator's acceleration is that of the step in all equations.
        _ => {
            d.work.qacc = force;
            return;
        }
    }
    mass::solve(m, &d.qLD, &d.qLDiagInv, &mut force, 0..m.nv);
    d.qacc.copy_from_slice(&force);
    d.work.qacc = force;
}
