//! Forces along spatial tendons as forces on the bodies along their paths: the external effect of springs, dampers,
//! constraints and actuators of tendons.

use crate::constraint;
use crate::dynamics::reflected::tendon_inertia;
use crate::forces::passive::spring;
use crate::forces::tendon;
use crate::forces::tendon::spatial_tendon;
use crate::kinds::{disable, trntype};
use crate::math::*;
use crate::model::{Fields, Model};

/// Calls `apply` with each body that a tendon pulls, the point, and the force (world frame). A tendon that slept when
/// lengths were computed exerts no force, even if its tree has woken since: it has no length and no Jacobian in this
/// pass, and its path points may have been overwritten by others (`tendon::tendons`). A tendon whose sites coincide
/// has no direction.
pub(crate) fn for_each_pull(m: &Model, d: &Fields, mut apply: impl FnMut(usize, Vec3, Vec3)) {
    let spatial = |&t: &usize| !tendon::is_fixed(m, t) && d.ten_length[t] != 0.0;
    for t in (0..m.ntendon).filter(spatial) {
        let force = passive(m, d, t) + actuators(m, d, t) + constraint::tendon_force(m, d, t);
        let force = force - inertial(m, d, t);
        if force != 0.0 {
            spatial_tendon::pull(m, d, t, force, &mut apply);
        }
    }
}

/// The force of the spring and the damper along the tendon, N.
fn passive(m: &Model, d: &Fields, t: usize) -> f64 {
    let (springs, dampers) = (!m.opt.disabled(disable::SPRING), !m.opt.disabled(disable::DAMPER));
    spring::tendon_force(m, d, t, springs, dampers).into_iter().sum()
}

/// The force of actuators along the tendon, N.
fn actuators(m: &Model, d: &Fields, t: usize) -> f64 {
    let on = |i: &usize| m.actuator_trntype[*i] == trntype::TENDON && m.actuator_trnid[2 * i] == t as i32;
    let force = |i: usize| {
        let o = m.actuator_outadr[i] as usize;
        m.actuator_gear[6 * o] * d.actuator_force[o]
    };
    if m.opt.disabled(disable::ACTUATION) { 0.0 } else { (0..m.nactuator).filter(on).map(force).sum() }
}

/// The force that accelerates the inertia of the tendon: a (J q̈ + J̇ v), N.
fn inertial(m: &Model, d: &Fields, t: usize) -> f64 {
    let a = tendon_inertia(m, t);
    if a == 0.0 { 0.0 } else { a * (tendon::along(m, d, t, &d.qacc) + spatial_tendon::acceleration(m, d, t)) }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)] // a failing test prints the reason
mod tests {
    use super::*;
    use crate::model::asleep;
    use crate::step::workspace::Workspace;
    use crate::step::{forward, step};
    use crate::tests::compile;

    /// The path of the second tendon begins with a pulley, and its points have overwritten those of the first tendon,
    /// which sleeps.
    #[test]
    fn a_sleeping_tendon_applies_no_force() {
        let m = compile(
            "<mujoco><option><flag sleep='enable'/></option><worldbody><geom type='plane' size='5 5 1'/>\
            <site name='anchor' pos='0 0 .5'/>\
            <body name='a' pos='0 0 .1' sleep='init'><freejoint/><geom type='box' size='.1 .1 .1'/><site name='sa' pos='0 0 .1'/></body>\
            <body name='b' pos='1 0 1'><joint axis='0 1 0'/><geom size='.05' pos='.3 0 0'/><site name='sb' pos='.3 0 0'/></body></worldbody>\
            <tendon><spatial stiffness='5' springlength='.1'><site site='anchor'/><site site='sa'/></spatial>\
            <spatial stiffness='3' springlength='.1'><pulley divisor='2'/><site site='anchor'/><site site='sb'/></spatial></tendon></mujoco>",
        )
        .unwrap();
        let Workspace { fields: mut d, scratch: mut s } = Workspace::new(&m);
        step(&m, &mut d, &mut s);
        forward::forward(&m, &mut d, &mut s);
        assert!(asleep::tendon(&m, &d, 0) && !asleep::tendon(&m, &d, 1));
        let mut pulled = Vec::new();
        for_each_pull(&m, &d, |body, _, _| pulled.push(body));
        assert_eq!(pulled, [0, 2]);
    }

    /// The ball touches the box, which wakes after lengths were computed. MuJoCo 3.14.0 does the same in the same
    /// step: the tendon has no length, and its spring no force.
    #[test]
    fn a_tendon_that_wakes_pulls_from_the_next_pass_on() {
        let m = compile(
            "<mujoco><option><flag sleep='enable'/></option><worldbody><geom type='plane' size='5 5 1'/>\
            <site name='anchor' pos='0 0 .5'/><site name='other' pos='1 0 .5'/>\
            <body name='a' pos='0 0 .0998' sleep='init'><freejoint/><geom type='box' size='.1 .1 .1'/><site name='sa' pos='0 0 .1'/></body>\
            <body name='b' pos='0 0 .26'><freejoint/><geom type='sphere' size='.05'/><site name='sb'/></body></worldbody>\
            <tendon><spatial name='t0' stiffness='5' damping='1' springlength='.1'><site site='anchor'/><site site='sa'/></spatial>\
            <spatial stiffness='3' springlength='.1'><pulley divisor='2'/><site site='other'/><site site='sb'/></spatial></tendon>\
            </mujoco>"
        )
        .unwrap();
        let Workspace { fields: mut d, scratch: mut s } = Workspace::new(&m);
        let mut steps = 0;
        while steps < 2 || d.tree_awake[0] == 0 {
            step(&m, &mut d, &mut s);
            steps += 1;
        }
        assert_eq!((steps, d.ten_length[0]), (24, 0.0));
        let pulled = |d: &Fields| {
            let mut bodies = Vec::new();
            for_each_pull(&m, d, |body, _, _| bodies.push(body));
            bodies
        };
        assert_eq!(pulled(&d), [0, 2]);
        step(&m, &mut d, &mut s);
        assert!(d.ten_length[0] > 0.3);
        assert_eq!(pulled(&d), [0, 1, 0, 2]);
    }
}
