//! Actuation: forces from controls, activations, lengths and velocities.
//!
//! See MuJoCo's documentation, "Computation: Actuation model". The force of an actuator is
//!
//! > gain(length, velocity) · input + bias(length, velocity)
//!
//! where the input is its control or, if it has dynamics, its last activation. Servos with several inputs, orientation servos and
//! motors have separate laws.

mod activation;
mod control;
mod inputs;
mod limit;
pub(crate) mod motor;
pub(crate) mod muscle;
mod rates;
mod servo;

use crate::forces::{ForceScratch, transmission};
use crate::kinds::{biastype, disable, dyntype, gaintype, joint, trntype};
use crate::math::*;
use crate::model::index::{element_range, object_index};
use crate::model::plan::PlanFlag;
use crate::model::{Fields, Model, asleep};

pub(crate) use control::{record, reset};
pub use motor::slots;
pub(crate) use rates::{advance, arrive};

/// Whether the group of actuator `i` is disabled.
pub(crate) fn switched_off(m: &Model, i: usize) -> bool {
    let group = m.actuator_group[i];
    (0..=30).contains(&group) && m.opt.disableactuator & (1 << group) != 0
}

/// Whether actuator `i` exerts a force.
fn acts(m: &Model, d: &Fields, i: usize) -> bool {
    !switched_off(m, i) && !asleep::actuator(m, d, i)
}

/// The ten parameters of actuator `i`.
pub(crate) fn prm(numbers: &[f64], i: usize) -> &[f64; 10] {
    &rows::<10>(numbers)[i]
}

/// Addresses of the activations of actuator `i`.
fn states(m: &Model, i: usize) -> std::ops::Range<usize> {
    element_range(m.actuator_actadr[i], m.actuator_actnum[i])
}

/// The value of a filter with time constant τ after a time h.
fn exact(act: f64, rate: f64, tau: f64, h: f64) -> f64 {
    let tau = tau.max(MINVAL);
    act + rate * tau * (1.0 - libm::exp(-h / tau))
}

/// Computes `actuator_force`, `act_dot`, `qfrc_actuator`.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn actuation(m: &Model, d: &mut Fields, w: &mut ForceScratch) {
    if !(d.plan.has(PlanFlag::Motors) && motors(m, d)) {
        any(m, d, w);
    }
}

/// Like [`actuation`], for actuators of any kind.
#[inline(never)]
fn any(m: &Model, d: &mut Fields, w: &mut ForceScratch) {
    if m.nactuator == 0 || m.opt.disabled(disable::ACTUATION) {
        d.actuator_force.fill(0.0);
        d.qfrc_actuator.fill(0.0);
        return;
    }
    if !(d.plan.has(PlanFlag::Servos) && servos(m, d)) {
        apply_laws(m, d);
    }
    limit::tendons(m, d, w);
    limit::forces(m, d);
    for i in (0..m.nactuator).filter(|&i| m.actuator_biastype[i] == biastype::DCMOTOR) {
        if acts(m, d, i) {
            d.actuator_force[m.actuator_outadr[i] as usize] += motor::mechanical(m, d, i);
        }
    }
    transmission::apply_forces(m, d);
    gravity_compensation(m, d);
    limit::joints(m, d);
}

/// Computes the force of each actuator with its law, before limits.
#[cfg_attr(not(feature = "small"), inline(always))]
fn apply_laws(m: &Model, d: &mut Fields) {
    d.actuator_force.fill(0.0);
    let mut ctrl = std::mem::take(&mut d.acting);
    control::effective(m, d, &mut ctrl);
    if m.na > 0 {
        for i in 0..m.nactuator {
            rates::rates(m, d, i, &mut ctrl);
        }
    }
    for i in 0..m.nactuator {
        if !acts(m, d, i) {
            continue;
        }
        match m.actuator_gaintype[i] {
            gaintype::SO3 | gaintype::PID | gaintype::DCMOTOR => separate_law_force(m, d, i, &ctrl),
            _ => {
                let input = servo::wrapped(m, d, i, input(m, d, i, &ctrl));
                d.actuator_force[m.actuator_outadr[i] as usize] = law(gain(m, d, i), input, bias(m, d, i))
            }
        }
    }
    d.acting = ctrl;
}

/// Like [`actuation`], for models whose actuators are all motors of slides and hinges with one control and one degree of freedom,
/// as in most labs. Does nothing and returns `false` if force limits apply or a control is a bad number.
#[cfg_attr(not(feature = "small"), inline(always))]
fn motors(m: &Model, d: &mut Fields) -> bool {
    let off = disable::ACTUATION | disable::CLAMPCTRL;
    if m.nactuator == 0
        || d.plan.has(PlanFlag::ForceLimits)
        || m.opt.disabled(off)
        || d.ctrl.iter().any(|&u| bad(u))
    {
        return false;
    }
    zero(&mut d.qfrc_actuator);
    let controls = d.ctrl.iter().zip(rows::<2>(&m.actuator_ctrlrange)).zip(&m.actuator_ctrllimited);
    let moments = d.moment_colind.iter().zip(&d.actuator_moment);
    let motors = rows::<10>(&m.actuator_gainprm).iter().zip(moments).zip(&mut d.actuator_force);
    for (((u, range), &limited), ((gain, (&k, moment)), force)) in controls.zip(motors) {
        *force = law(gain[0], within(*u, limited, range), 0.0);
        d.qfrc_actuator[k as usize] += moment * *force;
    }
    gravity_compensation(m, d);
    true
}

/// Computes the forces of motors and servos of slides, hinges and tendons with one control each, before limits. Does nothing and
/// returns `false` if a control is a bad number.
#[cfg_attr(not(feature = "small"), inline(always))]
fn servos(m: &Model, d: &mut Fields) -> bool {
    if m.opt.disabled(disable::CLAMPCTRL) || d.ctrl.iter().any(|&u| bad(u)) {
        return false;
    }
    let controls = d.ctrl.iter().zip(rows::<2>(&m.actuator_ctrlrange)).zip(&m.actuator_ctrllimited);
    let moving = d.actuator_length.iter().zip(&d.actuator_velocity);
    let biases = rows::<10>(&m.actuator_biasprm).iter().zip(&m.actuator_biastype).zip(moving);
    let gains = rows::<10>(&m.actuator_gainprm).iter().zip(&mut d.actuator_force);
    for ((((u, range), &limited), ((b, &kind), (length, velocity))), (gain, force)) in
        controls.zip(biases).zip(gains)
    {
        let bias = if kind == biastype::NONE { 0.0 } else { affine(b, *length, *velocity) };
        *force = law(gain[0], within(*u, limited, range), bias);
    }
    true
}

/// Computes the force of an actuator with a separate law.
#[inline(never)] // rare: keeps the common path small
fn separate_law_force(m: &Model, d: &mut Fields, i: usize, ctrl: &[f64]) {
    let o = m.actuator_outadr[i] as usize;
    match m.actuator_gaintype[i] {
        gaintype::SO3 => {
            let torque = servo::orientation(m, d, i, ctrl);
            d.actuator_force[o..o + 3].copy_from_slice(&torque);
        }
        gaintype::PID => d.actuator_force[o] = servo::pid(m, d, i, ctrl),
        _ => d.actuator_force[o] = motor::electric(m, d, i, ctrl) + bias(m, d, i),
    }
}

/// The input that the gain of actuator `i` multiplies: its control, or its last activation.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn input(m: &Model, d: &Fields, i: usize, ctrl: &[f64]) -> f64 {
    match states(m, i).last() {
        Some(last) => activation::activation_of_step(m, d, i, last),
        None if m.actuator_ctrlnum[i] == 0 => 0.0,
        None => ctrl[m.actuator_ctrladr[i] as usize],
    }
}

/// The force of an actuator.
#[cfg_attr(not(feature = "small"), inline(always))]
fn law(gain: f64, input: f64, bias: f64) -> f64 {
    gain * input + bias
}

/// p₀ + p₁ length + p₂ velocity.
#[cfg_attr(not(feature = "small"), inline(always))]
fn affine(p: &[f64; 10], length: f64, velocity: f64) -> f64 {
    p[0] + p[1] * length + p[2] * velocity
}

/// A control, clamped to its range if it has one.
#[cfg_attr(not(feature = "small"), inline(always))]
fn within(control: f64, limited: bool, range: &[f64; 2]) -> f64 {
    if limited { clip(control, *range) } else { control }
}

#[cfg_attr(not(feature = "small"), inline(always))]
fn gain(m: &Model, d: &Fields, i: usize) -> f64 {
    match m.actuator_gaintype[i] {
        gaintype::FIXED => m.actuator_gainprm[10 * i],
        _ => changing_gain(m, d, i),
    }
}

#[inline(never)] // rare; see `separate_law_force`
fn changing_gain(m: &Model, d: &Fields, i: usize) -> f64 {
    let (p, o) = (prm(&m.actuator_gainprm, i), m.actuator_outadr[i] as usize);
    match m.actuator_gaintype[i] {
        gaintype::AFFINE => affine(p, d.actuator_length[o], d.actuator_velocity[o]),
        gaintype::MUSCLE => muscle::gain(p, &muscle::MuscleState::new(m, d, o, p)),
        _ => p[0],
    }
}

#[cfg_attr(not(feature = "small"), inline(always))]
fn bias(m: &Model, d: &Fields, i: usize) -> f64 {
    match m.actuator_biastype[i] {
        biastype::NONE => 0.0,
        _ => some_bias(m, d, i),
    }
}

#[inline(never)] // rare; see `separate_law_force`
fn some_bias(m: &Model, d: &Fields, i: usize) -> f64 {
    let (p, o) = (prm(&m.actuator_biasprm, i), m.actuator_outadr[i] as usize);
    match m.actuator_biastype[i] {
        biastype::AFFINE => affine(p, d.actuator_length[o], d.actuator_velocity[o]),
        biastype::MUSCLE => muscle::bias(p, &muscle::MuscleState::new(m, d, o, p)),
        biastype::DCMOTOR => motor::back_emf(m, d, i),
        _ => 0.0,
    }
}

/// Fills `activation_of_step` with the controls that are applied at the current time.
pub(crate) fn controls(m: &Model, d: &mut Fields) {
    let mut ctrl = std::mem::take(&mut d.acting);
    control::effective(m, d, &mut ctrl);
    d.acting = ctrl;
}

/// Whether the force of actuator `i` is zero in every state, because its control is 0 and it has no bias and no activation.
pub(crate) fn idle(m: &Model, d: &Fields, i: usize) -> bool {
    let plain = matches!(m.actuator_gaintype[i], gaintype::FIXED | gaintype::AFFINE | gaintype::MUSCLE);
    let input = d.acting.get(m.actuator_ctrladr[i] as usize);
    plain
        && m.actuator_biastype[i] == biastype::NONE
        && states(m, i).is_empty()
        && (m.actuator_ctrlnum[i] == 0 || input == Some(&0.0))
}

/// The force of actuator `i` at its current length and zero velocity, before limits, and the negative derivative of the force
/// with respect to the length. `None` unless the force depends on the length of a slide, hinge or tendon only, apart from
/// damping. Uses the controls in `activation_of_step`.
pub(crate) fn along_length(m: &Model, d: &Fields, i: usize) -> Option<[f64; 2]> {
    let target = object_index(m.actuator_trnid[2 * i]);
    let simple = match m.actuator_trntype[i] {
        trntype::JOINT | trntype::JOINTINPARENT => {
            m.jnt_type.get(target).is_some_and(|&t| matches!(t, joint::SLIDE | joint::HINGE))
        }
        trntype::TENDON => true,
        _ => false,
    };
    let o = m.actuator_outadr[i] as usize;
    let p = match m.actuator_biastype[i] {
        biastype::NONE => &[0.0; 10],
        biastype::AFFINE => prm(&m.actuator_biasprm, i),
        _ => return None,
    };
    let [_, length, velocity, ..] = *p;
    if !simple || velocity > 0.0 || !states(m, i).is_empty() {
        return None;
    }
    let force = match m.actuator_gaintype[i] {
        gaintype::FIXED => {
            let bias = affine(p, d.actuator_length[o], 0.0);
            law(m.actuator_gainprm[10 * i], input(m, d, i, &d.acting), bias)
        }
        gaintype::PID => servo::pid(m, d, i, &d.acting) - velocity * d.actuator_velocity[o],
        _ => return None,
    };
    Some([force, -length])
}

/// `kp` and `kv` of actuator `i`, with respect to its own length. `None` if they depend on more than its parameters, or if
/// there is no such actuator.
pub fn servo_gains(m: &Model, i: usize) -> Option<[f64; 2]> {
    match *m.actuator_biastype.get(i)? {
        // Servos and controllers of type pid have the parameters constant, -kp, -kv.
        biastype::AFFINE => {
            rows::<10>(&m.actuator_biasprm).get(i).map(|&[_, length, velocity, ..]| [-length, -velocity])
        }
        biastype::DCMOTOR => motor::gains(m, i),
        _ => None,
    }
}

/// Adds the gravity compensation that counts as an actuator force.
#[cfg_attr(not(feature = "small"), inline(always))]
fn gravity_compensation(m: &Model, d: &mut Fields) {
    if m.ngravcomp > 0 && !m.opt.disabled(disable::GRAVITY) {
        add_gravity_compensation(m, d);
    }
}

#[inline(never)] // rare
fn add_gravity_compensation(m: &Model, d: &mut Fields) {
    for j in (0..m.njnt).filter(|&j| m.jnt_actgravcomp[j]) {
        let first = m.jnt_dofadr[j] as usize;
        for k in first..first + joint::nv(m.jnt_type[j]) {
            d.qfrc_actuator[k] += d.qfrc_gravcomp[k];
        }
    }
}

/// Whether the activation of actuator `i` is an integrated setpoint.
fn integrates(m: &Model, i: usize) -> bool {
    m.actuator_dyntype[i] == dyntype::INTEGRATOR
}
