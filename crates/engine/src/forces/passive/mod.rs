//! Passive forces: springs and dampers, gravity compensation, fluid forces.

pub(crate) mod adhesion;
mod ellipsoid;
pub(crate) mod fluid;
mod gravcomp;
pub(crate) mod spring;

use crate::kinds::{disable, joint};
use crate::math::combine;
use crate::model::plan::PlanFlag;
use crate::model::{Fields, Model};

/// Computes `qfrc_spring`, `qfrc_damper`, `qfrc_gravcomp`, `qfrc_fluid`, `qfrc_passive`. If springs and dampers are both
/// disabled, there are no passive forces.
pub(crate) fn passive(m: &Model, d: &mut Fields) {
    let (springs, dampers) = (!m.opt.disabled(disable::SPRING), !m.opt.disabled(disable::DAMPER));
    if d.plan.has(PlanFlag::Springs) {
        d.qfrc_spring.fill(0.0);
        if springs {
            spring::joint_springs(m, d);
        }
    }
    if d.plan.has(PlanFlag::Dampers) {
        if dampers {
            spring::damp_joints(m, d);
        } else {
            d.qfrc_damper.fill(0.0);
        }
    }
    if m.ntendon > 0 {
        spring::tendons(m, d, springs, dampers);
    }
    combine(&mut d.qfrc_passive, [&*d.qfrc_spring, &*d.qfrc_damper], |_, [spring, damper]| spring + damper);
    if d.plan.has(PlanFlag::BodyForces) {
        body_forces(m, d, springs || dampers);
    }
    if d.plan.has(PlanFlag::Adhesion) {
        d.qfrc_adhesion.fill(0.0);
        if springs || dampers {
            adhesion::adhesion(m, d);
            // Without adhesion, the force does not change, even if it is -0, as in a plan without this stage.
            for (f, pull) in d.qfrc_passive.iter_mut().zip(&d.qfrc_adhesion).filter(|(_, pull)| **pull != 0.0)
            {
                *f += pull;
            }
        }
    }
}

/// Adds the forces on bodies: gravity compensation and fluid forces.
fn body_forces(m: &Model, d: &mut Fields, on: bool) {
    d.qfrc_gravcomp.fill(0.0);
    d.qfrc_fluid.fill(0.0);
    if fluid::acts(m) {
        fluid::fluid(m, d);
        for (f, fluid) in d.qfrc_passive.iter_mut().zip(&d.qfrc_fluid) {
            *f += fluid;
        }
    }
    if on && gravcomp::gravcomp(m, d) {
        for j in 0..m.njnt {
            // Otherwise it counts as an actuator force.
            if !m.jnt_actgravcomp[j] {
                let first = m.jnt_dofadr[j] as usize;
                for k in first..first + joint::nv(m.jnt_type[j]) {
                    d.qfrc_passive[k] += d.qfrc_gravcomp[k];
                }
            }
        }
    }
}
