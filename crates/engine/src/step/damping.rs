//! Euler's method with implicit damping: (M + h B) a' = M a, where B is the derivative of the damping force.

use crate::dynamics::tree_algorithms;
use crate::forces::passive::spring;
use crate::kinds::disable;
use crate::math::combine;
use crate::model::plan::PlanFlag;
use crate::model::stage::Stage;
use crate::model::{Fields, Model};
use crate::step::stages::Damping;
use crate::step::workspace::StepScratch;

/// The acceleration a'.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(super) fn damp(m: &Model, d: &Fields, s: &mut StepScratch) {
    let Damping { qacc: a, b, .. } = &mut s.damping;
    combine(a, [&*d.qfrc_smooth, &*d.qfrc_constraint], |_, [smooth, constraint]| smooth + constraint);
    damping(m, d, b);
    tree_algorithms::solve_with(m, d, &mut s.dynamics, b, a);
}

/// Computes both accelerations from `qfrc_smooth`, when no constraint is active: a, and a' in the scratch. Returns the first
/// degree of freedom without inertia.
pub(super) fn accelerate(
    m: &Model,
    d: &mut Fields,
    s: &mut StepScratch,
    acceleration: &mut [f64],
) -> Option<usize> {
    let Damping { qacc: a, b, done } = &mut s.damping;
    // Adds the constraint force, which is 0: -0 becomes 0, as in the other code paths.
    combine(a, [&*acceleration], |_, [force]| force + 0.0);
    damping(m, d, b);
    *done = true;
    tree_algorithms::solve_both(m, d, &mut s.dynamics, b, acceleration, a)
}

/// h B.
#[cfg_attr(not(feature = "small"), inline(always))]
fn damping(m: &Model, d: &Fields, out: &mut [f64]) {
    let h = m.opt.timestep;
    spring::of_dampers(m, d.plan.has(PlanFlag::ActuatorDampers), &d.qvel, out, |law, v| {
        h * law.slope(v.abs())
    });
}

/// Whether some degree of freedom has a damper, and dampers are enabled.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(super) fn damps(m: &Model, d: &Fields) -> bool {
    d.plan.keeps(Stage::Passive)
        && !m.opt.disabled(disable::EULERDAMP)
        && !m.opt.disabled(disable::DAMPER)
        && if d.plan.has(PlanFlag::ConstantDamping) {
            d.plan.has(PlanFlag::JointDampers)
        } else {
            has_dampers(m)
        }
}

/// Whether some degree of freedom has a damper.
pub(super) fn has_dampers(m: &Model) -> bool {
    let some = |numbers: &[f64]| numbers.iter().any(|&x| x != 0.0);
    // A joint may have the armature of an actuator without its damping.
    let actuators = || some(&m.actuator_damping) || some(&m.actuator_dampingpoly);
    some(&m.dof_damping)
        || some(&m.dof_dampingpoly)
        || m.jnt_actuatorid.iter().any(|&i| i != -1) && actuators()
}
