//! Stages of the pipeline that use several modules, or whose work depends on the plan.

use super::{damping, discrete, sleep};
use crate::dynamics::{camera, jacobian, subtree, tree_algorithms};
use crate::forces::{energy, tendon};
use crate::kinds::{disable, enable, integrator};
use crate::math::{combine, copy, rows};
use crate::model::plan::PlanFlag;
use crate::model::stage::Stage;
use crate::model::{Fields, Model, Warning};
use crate::sensor::body_force;
use crate::step::workspace::StepScratch;
use crate::{collision, constraint, sensor};

pub(super) fn cameras_and_lights(m: &Model, d: &mut Fields) {
    camera::cameras(m, d);
    camera::lights(m, d);
}

pub(super) fn tendons(m: &Model, d: &mut Fields) {
    tendon::tendons(m, d);
    if d.plan.keeps(Stage::Sleep) {
        sleep::wake_by_tendons(m, d);
    }
}

/// Computes `M`, except the parts that are postponed to steps with active constraints.
pub(super) fn mass_matrix(m: &Model, d: &mut Fields, s: &mut StepScratch) {
    let rows = !d.plan.has(PlanFlag::MassForRows);
    fill_mass_matrix(m, d, s, d.plan.has(PlanFlag::Composite) && rows, rows);
}

/// Computes `M`, with or without the rows of the general tree algorithm, and those of the algorithms that postpone them.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(super) fn fill_mass_matrix(m: &Model, d: &mut Fields, s: &mut StepScratch, general: bool, rows: bool) {
    tree_algorithms::mass(m, d, &mut s.dynamics, general, rows);
    if m.ntendon > 0 {
        tendon::armature(m, d);
    }
}

pub(super) fn factor(m: &Model, d: &mut Fields, s: &mut StepScratch) {
    if !d.plan.has(PlanFlag::MassForRows) {
        refactor(m, d, s);
    }
}

fn refactor(m: &Model, d: &mut Fields, s: &mut StepScratch) {
    let bad = tree_algorithms::factor(m, d, &mut s.dynamics);
    check_inertia(d, bad);
}

/// Warns about a degree of freedom without inertia.
fn check_inertia(d: &mut Fields, bad: Option<usize>) {
    if let Some(dof) = bad {
        d.warn(Warning::Inertia, dof);
    }
}

pub(super) fn collide(m: &Model, d: &mut Fields, s: &mut StepScratch) {
    if m.opt.disabled(disable::CONSTRAINT) || m.opt.disabled(disable::CONTACT) || d.meter.over() {
        return collision::none(d);
    }
    collision::collide(m, d, &mut s.collision);
    if sleep::wake_touched(m, d) {
        collision::collide(m, d, &mut s.collision);
    }
}

pub(super) fn make_constraints(m: &Model, d: &mut Fields, s: &mut StepScratch) {
    if d.plan.keeps(Stage::Sleep) {
        sleep::wake_by_equalities(m, d);
    }
    constraint::make(m, d, &mut s.constraint);
    if d.plan.has(PlanFlag::MassForRows) && d.nefc > 0 {
        let general = d.plan.has(PlanFlag::Composite);
        if general || tree_algorithms::defers_mass_rows(&s.dynamics) {
            fill_mass_matrix(m, d, s, general, true);
        }
        refactor(m, d, s);
    }
}

pub(super) fn bias(m: &Model, d: &mut Fields, s: &mut StepScratch) {
    tree_algorithms::bias(m, d, &mut s.dynamics);
    if m.ntendon > 0 {
        tendon::bias(m, d);
    }
}

/// `qfrc_smooth` and `qacc_smooth` = M⁻¹ `qfrc_smooth`. Also `qacc`, if no constraint can be active.
pub(super) fn acceleration(m: &Model, d: &mut Fields, s: &mut StepScratch) {
    if d.plan.has(PlanFlag::Ballistic) && m.opt.integrator != integrator::DISCRETE {
        ballistic(d);
    } else {
        accelerate(m, d, s);
    }
}

#[cfg_attr(not(feature = "small"), inline(never))]
fn accelerate(m: &Model, d: &mut Fields, s: &mut StepScratch) {
    if d.plan.has(PlanFlag::Unforced) {
        combine(&mut d.qfrc_smooth, [&*d.qfrc_bias], |_, [bias]| 0.0 - bias);
    } else {
        let forces = [&*d.qfrc_passive, &*d.qfrc_bias, &*d.qfrc_applied, &*d.qfrc_actuator];
        combine(&mut d.qfrc_smooth, forces, |_, [passive, bias, applied, actuator]| {
            passive - bias + applied + actuator
        });
    }
    if d.plan.has(PlanFlag::AppliedForces) {
        applied_forces(m, d);
    }
    s.damping.done = false;
    if m.opt.integrator == integrator::DISCRETE {
        discrete::acceleration(m, d, s);
    } else if d.plan.has(PlanFlag::General) {
        let mut out = std::mem::take(&mut d.qacc_smooth);
        copy(&d.qfrc_smooth, &mut out);
        if d.plan.has(PlanFlag::MassForRows) && d.nefc == 0 {
            let euler = m.opt.integrator == integrator::EULER && damping::damps(m, d);
            let bad = match euler {
                true => damping::accelerate(m, d, s, &mut out),
                false => tree_algorithms::factor_and_solve(m, d, &mut s.dynamics, &mut out),
            };
            check_inertia(d, bad);
        } else {
            tree_algorithms::solve(m, d, &mut s.dynamics, &mut out);
        }
        d.qacc_smooth = out;
    } else {
        combine(&mut d.qacc_smooth, [&*d.qfrc_smooth, &*d.qLDiagInv], |_, [f, inv]| f * inv);
    }
    if d.plan.keeps(Stage::Sleep) {
        sleep::put_back(m, d, &s.sleep);
    }
    if !d.plan.keeps(Stage::Solve) {
        copy(&d.qacc_smooth, &mut d.qacc);
        add_gyroscopic_correction(m, d, s);
    }
}

/// Like [`accelerate`], for bodies in free flight: only gravity and the bias force act, M is diagonal, and contacts are
/// impossible.
#[cfg_attr(not(feature = "small"), inline(always))]
fn ballistic(d: &mut Fields) {
    combine(&mut d.qfrc_smooth, [&*d.qfrc_bias], |_, [bias]| 0.0 - bias);
    combine(&mut d.qacc_smooth, [&*d.qfrc_smooth, &*d.qLDiagInv], |_, [force, inv]| force * inv);
    copy(&d.qacc_smooth, &mut d.qacc);
}

/// Adds Jᵀ f for the force and the torque that are applied at the centre of mass of each body.
fn applied_forces(m: &Model, d: &mut Fields) {
    let mut out = std::mem::take(&mut d.qfrc_smooth);
    for b in 1..m.nbody {
        let [fx, fy, fz, tx, ty, tz] = rows::<6>(&d.xfrc_applied)[b];
        if [fx, fy, fz, tx, ty, tz] != [0.0; 6] {
            jacobian::apply(m, d, b, rows::<3>(&d.xipos)[b], [fx, fy, fz], [tx, ty, tz], &mut out);
        }
    }
    d.qfrc_smooth = out;
}

/// `qacc` and constraint forces.
pub(super) fn solve(m: &Model, d: &mut Fields, s: &mut StepScratch) {
    if m.opt.integrator == integrator::DISCRETE {
        discrete::constraints(m, d, s);
    } else {
        constraint::solve(m, d, &mut s.constraint, &mut s.dynamics);
    }
    add_gyroscopic_correction(m, d, s);
}

/// Adds the gyroscopic correction of the discrete integrator to `qacc` of free bodies.
#[cfg_attr(not(feature = "small"), inline(always))]
fn add_gyroscopic_correction(m: &Model, d: &mut Fields, s: &mut StepScratch) {
    if m.opt.integrator == integrator::DISCRETE {
        discrete::add_gyroscopic_correction(m, d, s);
    }
}

/// Momenta of subtrees, if a sensor needs them. Otherwise the fields do not change.
pub(super) fn subtree_velocities(m: &Model, d: &mut Fields) {
    if measured(m, Stage::SubtreeVel) {
        subtree::subtree_vel(m, d);
    }
}

/// Accelerations of bodies and the forces between them, if a sensor needs them.
pub(super) fn body_forces(m: &Model, d: &mut Fields) {
    if measured(m, Stage::RnePost) {
        body_force::rne_post_constraint(m, d);
    }
}

/// Whether sensors are enabled, and one of them needs a stage.
fn measured(m: &Model, stage: Stage) -> bool {
    !m.opt.disabled(disable::SENSOR) && sensor::needs(m, stage)
}

/// Computes `energy[0]`. Sets zeros if the flag is off and no sensor has computed the energy in this pass.
pub(super) fn potential_energy(m: &Model, d: &mut Fields, s: &mut StepScratch) {
    if m.opt.enabled(enable::ENERGY) {
        energy::potential(m, d);
    } else if s.unseen || m.opt.disabled(disable::SENSOR) || !sensor::measures_potential(m) {
        d.energy = [0.0; 2];
    }
}

/// `energy[1]`.
pub(super) fn kinetic_energy(m: &Model, d: &mut Fields) {
    if m.opt.enabled(enable::ENERGY) {
        energy::kinetic(m, d);
    }
}
