//! Semi-implicit Euler.

use super::{Slopes, advance};
use crate::dynamics::articulated;
use crate::forces::passive::spring;
use crate::math::combine;
use crate::model::reflect::Stage;
use crate::{Data, Model, disable};

/// v += h a, then q advances with the new v. Joint damping is implicit, so that it is stable however stiff:
/// (M + h B) a' = M a, where B is the derivative of the damping force.
#[inline(never)]
pub(super) fn euler(m: &Model, d: &mut Data) {
    if !damps(m, d) {
        advance(m, d, Slopes::default());
        return;
    }
    if !d.work.damped {
        damp(m, d);
    }
    let acceleration = std::mem::take(&mut d.work.qacc);
    advance(m, d, Slopes { acceleration: Some(&acceleration), ..Slopes::default() });
    d.work.qacc = acceleration;
}

/// The acceleration a', by `work.qacc`.
#[inline(always)]
fn damp(m: &Model, d: &mut Data) {
    let (mut a, mut b) = (std::mem::take(&mut d.work.qacc), std::mem::take(&mut d.work.damping));
    combine(&mut a, [&*d.qfrc_smooth, &*d.qfrc_constraint], |_, [smooth, constraint]| smooth + constraint);
    damping(m, d, &mut b);
    articulated::solve_with(m, d, &b, &mut a);
    (d.work.qacc, d.work.damping) = (a, b);
}

/// Both accelerations from `qfrc_smooth`, where no constraint acts: a, and a' by `work.qacc`. Returns the first degree of
/// freedom without inertia.
pub(crate) fn accelerate(m: &Model, d: &mut Data, acceleration: &mut [f64]) -> Option<usize> {
    let (mut a, mut b) = (std::mem::take(&mut d.work.qacc), std::mem::take(&mut d.work.damping));
    // With the force of constraints, which is 0: -0 becomes 0, as everywhere.
    combine(&mut a, [&*acceleration], |_, [force]| force + 0.0);
    damping(m, d, &mut b);
    let bad = articulated::prepare_both(m, d, &b, acceleration, &mut a);
    (d.work.qacc, d.work.damping, d.work.damped) = (a, b, true);
    bad
}

/// h B.
#[inline(always)]
fn damping(m: &Model, d: &Data, out: &mut [f64]) {
    let h = m.opt.timestep;
    spring::of_dampers(m, d.plan.actuator_dampers, &d.qvel, out, |law, v| h * law.slope(v.abs()));
}

/// Whether some degree of freedom has a damper, and dampers are on.
pub(crate) fn damps(m: &Model, d: &Data) -> bool {
    d.plan.keeps(Stage::Passive)
        && !m.opt.disabled(disable::EULERDAMP)
        && !m.opt.disabled(disable::DAMPER)
        && d.plan.damped.unwrap_or_else(|| has_dampers(m))
}

/// Whether some degree of freedom has a damper.
pub(crate) fn has_dampers(m: &Model) -> bool {
    m.dof_damping.iter().any(|&b| b != 0.0)
        || m.dof_dampingpoly.iter().any(|&p| p != 0.0)
        || m.jnt_actuatorid.iter().any(|&i| i != -1)
}
