//! Inverse dynamics: the force that causes a given acceleration.

use crate::constraint;
use crate::dynamics::mass;
use crate::forces::derivative::{self, Medium, sparse};
use crate::forces::passive::spring;
use crate::kinds::{enable, integrator};
use crate::math::Spatial;
use crate::model::plan::PlanTable;
use crate::model::{Fields, Model};
use crate::sensor::{self, SensorStage};
use crate::step::workspace::StepScratch;
use crate::step::{calls, forward};
use crate::step::{damping, discrete};

/// The reason why inverse dynamics is impossible.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InverseError {
    /// The acceleration belongs to a whole step (`invdiscrete`) of a method with several stages, which cannot be inverted.
    RungeKutta,
}

impl std::fmt::Display for InverseError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(
            "inverse dynamics of a whole step (flag `invdiscrete`) is not available for an integrator with several stages, such as RK4: choose another integrator, or clear the flag",
        )
    }
}

impl std::error::Error for InverseError {}

/// Computes `qfrc_inverse` from `qpos`, `qvel` and `qacc` (`mj_inverse`): the force that actuators or external forces must apply
/// to cause this acceleration. With the flag `invdiscrete`, `qacc` is (v⁺ - v)/h of a step instead.
///
/// All fields of position and velocity, the constraint forces and the sensors are computed, whatever the plan
/// contains.
pub fn inverse(m: &Model, d: &mut Fields, s: &mut StepScratch) -> Result<(), InverseError> {
    if m.opt.enabled(enable::INVDISCRETE) && integrator::many_stages(m.opt.integrator) {
        return Err(InverseError::RungeKutta);
    }
    let plan = std::mem::replace(&mut d.plan, PlanTable::everything());
    forward::from_state(m, d, s);
    from_velocity(m, d, s);
    d.plan = plan;
    Ok(())
}

/// Like [`inverse`], after the position and velocity stages.
fn from_velocity(m: &Model, d: &mut Fields, s: &mut StepScratch) {
    let mut given = std::mem::take(&mut s.rk.slope);
    given.copy_from_slice(&d.qacc);
    if m.opt.enabled(enable::INVDISCRETE) {
        continuous(m, d, s);
    }
    if m.opt.integrator == integrator::DISCRETE {
        discrete::prepare_inverse(m, d, s);
    }
    constraint::inverse(m, d, &mut s.constraint, &mut s.dynamics);
    calls::body_forces(m, d);
    sensor::evaluate(m, d, &mut s.sensor, SensorStage::Acceleration);
    mass::mul(m, &d.M, &d.qacc, &mut d.qfrc_inverse, 0..m.nv);
    if m.opt.integrator == integrator::DISCRETE {
        discrete::add_to_inverse(m, d, s);
    }
    let internal = d.qfrc_bias.iter().zip(&d.qfrc_passive);
    for (f, ((bias, passive), constraint)) in d.qfrc_inverse.iter_mut().zip(internal.zip(&d.qfrc_constraint))
    {
        *f += bias - passive - constraint;
    }
    d.qacc.copy_from_slice(&given);
    s.rk.slope = given;
}

/// Converts `qacc` of a step to the acceleration of the equations of motion, by including the terms that the integrator adds to
/// M.
fn continuous(m: &Model, d: &mut Fields, s: &mut StepScratch) {
    let (h, force, w) = (m.opt.timestep, &mut s.damping.qacc, &mut s.derivative);
    match m.opt.integrator {
        integrator::EULER => {
            mass::mul(m, &d.M, &d.qacc, force, 0..m.nv);
            if damping::damps(m, d) {
                for i in 0..m.nv {
                    force[i] += h * spring::joint_damping(m, d, i) * d.qacc[i];
                }
            }
        }
        integrator::IMPLICIT => {
            derivative::forces(m, d, w, Medium::Whole);
            derivative::subtract_bias(m, d, w);
            sparse::mass_minus(m, &d.M, h, &mut w.whole);
            sparse::mul(m, &w.whole, &d.qacc, force);
        }
        integrator::IMPLICITFAST => {
            let matrix = &mut s.dynamics.ld;
            derivative::forces(m, d, w, Medium::Symmetric);
            matrix.copy_from_slice(&d.M);
            sparse::subtract_lower(m, &w.whole, h, matrix);
            mass::mul(m, matrix, &d.qacc, force, 0..m.nv);
            for tree in (0..m.ntree).filter(|&t| derivative::is_free_rigid(m, t)) {
                derivative::subtract_tree_bias(m, d, w, tree);
                let first = m.tree_dofadr[tree] as usize;
                let a: Spatial = std::array::from_fn(|r| d.qacc[first + r]);
                let block = derivative::free_block(m, &d.M, w, h, first);
                for (f, row) in force[first..first + 6].iter_mut().zip(block) {
                    *f = crate::math::dot(row, a);
                }
            }
        }
        // The acceleration of the discrete integrator is that of the step in all equations.
        _ => return,
    }
    mass::solve(m, &d.qLD, &d.qLDiagInv, force, 0..m.nv);
    d.qacc.copy_from_slice(force);
}
