//! The `dcmotor` shortcut: converts the values of a data sheet to the parameters of the motor's equations.
//!
//! MuJoCo's XML reference, "actuator/dcmotor". With the motor constant K (torque per current, and voltage per
//! speed), the resistance R and the inductance L, the electrical time constant is L/R. A nominal voltage V with stall
//! torque τ and no-load speed ω gives K = V/ω and R = K V/τ.

use super::overlay::ActuatorOverlay;
use crate::forces::actuation::slots;
use crate::kinds::{biastype, choice, dyntype, gaintype};
use crate::mjcf::spec::ActuatorSpec;

/// Writes the parameters of a motor into an actuator.
pub(crate) fn dcmotor(a: &mut ActuatorSpec, e: &mut ActuatorOverlay) {
    // The values of an actuator without motor parameters count as not given.
    if a.gaintype != gaintype::DCMOTOR {
        (a.gainprm, a.biasprm, a.dynprm) = ([0.0; 10], [0.0; 10], [0.0; 10]);
    }
    let [voltage, stall, speed] = e.p.reals("nominal", [0.0; 3]);
    let from_speed = if speed > 0.0 { voltage / speed } else { 0.0 };
    // Torque constant and voltage constant are the same number in SI units. If both are given, their geometric mean is used.
    let [torque, back] = e.p.reals("motorconst", [a.gainprm[1], 0.0]);
    let from_constants = mean(torque, back);
    let k = mean(from_constants, from_speed);
    let from_stall = if stall > 0.0 { k * voltage / stall } else { 0.0 };
    let resistance = e.p.real("resistance").unwrap_or(a.gainprm[0]);
    let r = if resistance == 0.0 { from_stall } else { resistance };
    positive(e, k, "motorconst", "motor constant", "torque is the motor constant times the current");
    if k > 0.0 {
        positive(e, r, "resistance", "resistance", "the current is the voltage divided by the resistance");
    }
    (a.gainprm[0], a.gainprm[1]) = (r, k);
    saturation(a, e, k);

    let [inductance, time] = e.p.reals("inductance", [0.0, a.dynprm[0]]);
    if inductance < 0.0 || time < 0.0 {
        let owner = e.node.describe();
        e.error("inductance", format!("`inductance` of {owner} is negative"))
            .why("it gives an inductance (H), or a time constant (s)");
    }
    a.dynprm[0] = if inductance > 0.0 { inductance / r } else { time };

    let cogging = e.p.reals("cogging", [a.biasprm[0], a.biasprm[1], a.biasprm[2]]);
    a.biasprm[..3].copy_from_slice(&cogging);

    let [kp, ki, kd, slew, imax, vmax] = e.p.reals(
        "controller",
        [a.gainprm[4], a.gainprm[5], a.gainprm[6], a.dynprm[7], a.dynprm[8], a.gainprm[7]],
    );
    a.gainprm[4..8].copy_from_slice(&[kp, ki, kd, vmax.max(0.0)]);
    a.dynprm[7..9].copy_from_slice(&[slew, imax]);

    thermal(a, e);

    let [stiffness, damping, coulomb, stiction, stribeck] =
        e.p.reals("lugre", [a.dynprm[5], a.dynprm[6], a.biasprm[3], a.biasprm[4], a.biasprm[5]]);
    if stiffness > 0.0 {
        a.dynprm[5..7].copy_from_slice(&[stiffness, damping]);
        a.biasprm[3..6].copy_from_slice(&[coulomb, stiction, stribeck]);
    }

    (a.gaintype, a.biastype, a.dyntype) = (gaintype::DCMOTOR, biastype::DCMOTOR, dyntype::DCMOTOR);
    a.actearly = true;
    a.actdim = slots(&a.dynprm, &a.gainprm).count() as i32;
}

/// Sets the largest force, directly or from the largest current, and the largest rate of change of the current.
fn saturation(a: &mut ActuatorSpec, e: &mut ActuatorOverlay, k: f64) {
    let [force, current, slope] = e.p.reals("saturation", [0.0, 0.0, a.dynprm[1]]);
    if force < 0.0 && current > 0.0 {
        let owner = e.node.describe();
        e.error("saturation", format!("`saturation` of {owner} begins with {force}"))
            .why("it is the largest force, which cannot be negative")
            .help("write 0 for a limit that follows from the current");
    }
    let limit = if force > 0.0 { force } else { k * current };
    if limit > 0.0 {
        a.force.flag = choice::TRUE;
        a.force.range = [-limit, limit];
    }
    a.dynprm[1] = slope.max(0.0);
}

/// Reads thermal resistance and capacity, or one of them with their product, a time constant. Also reads how the resistance of
/// the wire grows with temperature.
fn thermal(a: &mut ActuatorSpec, e: &mut ActuatorOverlay) {
    let [resistance, capacity, time, growth, reference, ambient] =
        e.p.reals("thermal", [a.dynprm[2], a.dynprm[3], 0.0, a.gainprm[2], a.gainprm[3], a.dynprm[4]]);
    let divided = |x: f64, by: f64| if x == 0.0 && time > 0.0 && by > 0.0 { time / by } else { x };
    let (resistance, capacity) = (divided(resistance, capacity), divided(capacity, resistance));
    if resistance == 0.0 && capacity == 0.0 && time == 0.0 {
        return;
    }
    if resistance <= 0.0 || capacity <= 0.0 {
        let owner = e.node.describe();
        e.error("thermal", format!("`thermal` of {owner} lacks a resistance or a capacity"))
            .why("the temperature depends on the generated, stored and dissipated heat")
            .help("the order is resistance (K/W), capacity (J/K), time constant (s): two of these three give the third");
    }
    a.dynprm[2..5].copy_from_slice(&[resistance, capacity, ambient]);
    a.gainprm[2..4].copy_from_slice(&[growth, reference]);
}

/// The geometric mean of two numbers, or the positive one of them.
fn mean(a: f64, b: f64) -> f64 {
    match (a > 0.0, b > 0.0) {
        (true, true) => (a * b).sqrt(),
        (true, false) => a,
        _ => b,
    }
}

fn positive(e: &mut ActuatorOverlay, x: f64, attribute: &str, what: &str, why: &str) {
    if x <= 0.0 || !x.is_finite() {
        let owner = e.node.describe();
        e.error(attribute, format!("the {what} of {owner} is not larger than zero")).why(why).help(
            "give `motorconst` and `resistance`, or `nominal` with voltage, stall torque and no-load speed",
        );
    }
}
