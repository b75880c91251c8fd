//! Springs, servos and contacts whose time constants are too short for the timestep.
//!
//! A spring of stiffness k, an implicit damper d and an explicit damper c on a mass m are integrated by the semi-implicit Euler
//! method as two linear equations for the position and the speed; they stay bounded as long as h² k + 2 h c < 4 m + 2 h d (both
//! roots of the characteristic polynomial within the unit circle). The classical Runge-Kutta method is stable for h √(k/m) < 2.78
//! and h c / m < 2.78 (Hairer and Wanner, Solving Ordinary Differential Equations II, chapter IV.2).

use super::{digits, element_span, format_name};
use crate::kinds::{biastype, disable, integrator, joint, trntype};
use crate::mjcf::rules;
use crate::mjcf::text::diagnostic::Diagnostics;
use crate::mjcf::text::tree::ElementTree;
use crate::mjcf::text::values::Value;
use crate::model::{Model, Obj};

/// The stability limit of the Runge–Kutta method, on the imaginary and on the real axis.
const RUNGE_KUTTA: f64 = 2.78;
/// Attributes that contain a time constant of a constraint or a contact.
const TIMES: [&str; 5] = ["solref", "solreflimit", "solreffix", "solreffriction", "solreflimitspring"];

pub(super) fn check_time_constants(tree: &ElementTree, m: &Model, report: &mut Diagnostics) {
    joints(tree, m, report);
    constraints(tree, m, report);
}

/// The elements that act on a joint: stiffness, dampers that are integrated implicitly, dampers that are integrated explicitly.
#[derive(Clone, Copy, Default)]
struct ActingElements {
    spring: f64,
    implicit: f64,
    explicit: f64,
    servo: bool,
}

fn acting(m: &Model, j: usize) -> Option<ActingElements> {
    let dof = usize::try_from(*m.jnt_dofadr.get(j)?).ok()?;
    let method = m.opt.integrator;
    let [euler, fast] = [integrator::EULER, integrator::RK4].map(|k| method == k);
    let mut all = ActingElements::default();
    let damper = *m.dof_damping.get(dof)?;
    match fast || (euler && m.opt.disabled(disable::EULERDAMP)) {
        true => all.explicit += damper,
        false => all.implicit += damper,
    }
    all.spring += m.jnt_stiffness.get(j)?;
    for a in 0..m.nactuator {
        let on_joint = m.actuator_trntype.get(a) == Some(&trntype::JOINT)
            && m.actuator_trnid.get(2 * a) == Some(&(j as i32))
            && m.actuator_biastype.get(a) == Some(&biastype::AFFINE);
        let (Some(out), true) = (m.actuator_outadr.get(a), on_joint) else { continue };
        let gear = *m.actuator_gear.get(6 * usize::try_from(*out).ok()?)?;
        let bias = m.actuator_biasprm.get(10 * a..10 * a + 3)?;
        let [kp, kv] = [bias.get(1)?, bias.get(2)?].map(|b| -b * gear * gear);
        all.spring += kp;
        match fast || euler {
            true => all.explicit += kv,
            false => all.implicit += kv,
        }
        all.servo |= kp > 0.0 || kv > 0.0;
    }
    Some(all)
}

/// Reports joints with a spring, a damper or a servo that is unstable at this timestep.
fn joints(tree: &ElementTree, m: &Model, report: &mut Diagnostics) {
    let h = m.opt.timestep;
    let supported = [integrator::EULER, integrator::RK4, integrator::IMPLICIT, integrator::IMPLICITFAST];
    if !supported.contains(&m.opt.integrator) || h.is_nan() || h <= 0.0 {
        return;
    }
    for j in 0..m.njnt {
        let one = m.jnt_type.get(j).is_some_and(|t| matches!(*t, joint::HINGE | joint::SLIDE));
        let dof = m.jnt_dofadr.get(j).and_then(|d| usize::try_from(*d).ok());
        let (Some(inverse), Some(a), true) =
            (dof.and_then(|d| m.dof_invweight0.get(d)).filter(|w| **w > 0.0), acting(m, j), one)
        else {
            continue;
        };
        let mass = 1.0 / inverse;
        let grows = match m.opt.integrator {
            integrator::RK4 => {
                h * (a.spring.max(0.0) / mass).sqrt() > RUNGE_KUTTA || h * a.explicit / mass > RUNGE_KUTTA
            }
            _ => h * h * a.spring + 2.0 * h * a.explicit >= 4.0 * mass + 2.0 * h * a.implicit,
        };
        if !grows || (a.spring <= 0.0 && a.explicit <= 0.0) {
            continue;
        }
        let name = m.names.of_kind(Obj::Joint).get(j).map_or("", String::as_str);
        let spring = h * h * a.spring >= h * a.explicit;
        let (what, time) = match spring {
            true => ("a spring", (mass / a.spring).sqrt()),
            false => ("a damper", mass / a.explicit),
        };
        let by = if a.servo { ", with its servo," } else { "" };
        let message = format!(
            "{}{by} is {what} with a time constant of {} s, but the timestep is {} s",
            format_name("joint", name, j),
            digits(time),
            digits(h)
        );
        report
            .note(rules::TOO_FAST, element_span(tree, &["joint"], name), message)
            .why(format!(
                "with an inertia of {}, the integrator makes the motion grow from step to step, unless something else limits it",
                digits(mass)
            ))
            .help("use a shorter timestep, a softer spring or gain, or more inertia or `armature`");
    }
}

/// Reports constraints whose requested time constant is below two timesteps.
fn constraints(tree: &ElementTree, m: &Model, report: &mut Diagnostics) {
    let least = 2.0 * m.opt.timestep;
    if m.opt.disabled(disable::REFSAFE) || m.opt.integrator == integrator::DISCRETE {
        return;
    }
    for node in &tree.nodes {
        for a in node.attributes.iter().filter(|a| TIMES.contains(&a.attr.name)) {
            let Value::Reals(list) = &a.value else { continue };
            let Some(time) = list.first().filter(|t| **t > 0.0 && **t < least * (1.0 - 1e-9)) else {
                continue;
            };
            let message = format!(
                "`{}` requests {} s but gets {} s, two timesteps",
                a.attr.name,
                digits(*time),
                digits(least)
            );
            report
                .warning(rules::SOFTENED, a.span.clone(), message)
                .why("the flag `refsafe` makes constraints no stiffer than the timestep allows")
                .help("write the value that it gets, or shorten the timestep");
        }
    }
}
