//! Semi-implicit Euler.

use super::{Slopes, advance};
use crate::math::each;
use crate::passive::spring;
use crate::reflect::Stage;
use crate::{Data, Model, articulated, disable};

/// v += h a, then q advances with the new v. Joint damping is implicit, so that it is stable however stiff:
/// (M + h B) a' = M a, where B is the derivative of the damping force.
#[inline(never)]
pub(super) fn euler(m: &Model, d: &mut Data) {
    if !damps(m, d) {
        advance(m, d, Slopes::default());
        return;
    }
    let h = m.opt.timestep;
    let (mut acceleration, mut damping) =
        (std::mem::take(&mut d.work.qacc), std::mem::take(&mut d.work.damping));
    let force = acceleration.as_mut_slice();
    let n = force.len();
    let (smooth, constraint) = (&d.qfrc_smooth[..n], &d.qfrc_constraint[..n]);
    each(n, |k| force[k] = smooth[k] + constraint[k]);
    let actuators = d.plan.actuator_dampers;
    spring::of_dampers(m, actuators, &d.qvel, &mut damping, |law, v| h * law.slope(v.abs()));
    articulated::solve_with(m, d, &damping, &mut acceleration);
    d.work.damping = damping;
    advance(m, d, Slopes { acceleration: Some(&acceleration), ..Slopes::default() });
    d.work.qacc = acceleration;
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
