//! DC motors: voltage, current, temperature, friction.
//!
//! See MuJoCo's note "DC Motor Model". With motor constant K, resistance R and speed ω, the current of the winding is
//! i = (V - K ω)/R, or approaches that value with the electrical time constant, and the torque is K i. Friction of the
//! bearing follows the LuGre model (Canudas de Wit et al. 1995) with the bristle deflection z, ż = ω - σ₀ |ω| z/g(ω).

use super::inputs::{self, ServoInputs, anti_windup_rate};
use super::{exact, prm, states};
use crate::kinds::dyntype;
use crate::math::*;
use crate::model::{Fields, Model};

/// Indexes of a motor's states among its activations; `None` for states that it does not have.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Slots {
    slew: Option<usize>,
    integral: Option<usize>,
    temperature: Option<usize>,
    bristle: Option<usize>,
    current: Option<usize>,
}

impl Slots {
    /// Number of states.
    pub fn count(&self) -> usize {
        [self.slew, self.integral, self.temperature, self.bristle, self.current].iter().flatten().count()
    }
}

/// The states that a motor with these parameters has.
pub fn slots(dynprm: &[f64; 10], gainprm: &[f64; 10]) -> Slots {
    let mut next = 0;
    let mut place = |has: bool| {
        next += usize::from(has);
        has.then(|| next - 1)
    };
    Slots {
        slew: place(dynprm[7] > 0.0),
        integral: place(gainprm[5] > 0.0),
        temperature: place(dynprm[2] > 0.0),
        bristle: place(dynprm[5] > 0.0),
        current: place(dynprm[0] > 0.0),
    }
}

/// The parameters and states of a motor.
struct Motor<'a> {
    dyn_: &'a [f64; 10],
    gain: &'a [f64; 10],
    bias: &'a [f64; 10],
    slots: Slots,
    /// The index of its first activation.
    first: usize,
    length: f64,
    velocity: f64,
}

impl<'a> Motor<'a> {
    /// A value of a state, clamped to its limits.
    fn within(&self, slot: Option<usize>, value: f64) -> f64 {
        let limit = self.dyn_[8];
        if slot == self.slots.integral && limit > 0.0 { clamp(value, -limit, limit) } else { value }
    }

    fn new(m: &'a Model, d: &Fields, i: usize) -> Motor<'a> {
        let (dyn_, gain) = (prm(&m.actuator_dynprm, i), prm(&m.actuator_gainprm, i));
        let (states, o) = (states(m, i), m.actuator_outadr[i] as usize);
        // If programs have written parameters that do not match the number of states, there are none.
        let slots = Some(slots(dyn_, gain))
            .filter(|s| m.actuator_dyntype[i] == dyntype::DCMOTOR && s.count() == states.len());
        Motor {
            dyn_,
            gain,
            bias: prm(&m.actuator_biasprm, i),
            slots: slots.unwrap_or_default(),
            first: states.start,
            length: d.actuator_length[o],
            velocity: d.actuator_velocity[o],
        }
    }

    fn state(&self, d: &Fields, slot: Option<usize>) -> Option<f64> {
        slot.map(|s| d.act[self.first + s])
    }

    /// K.
    fn constant(&self) -> f64 {
        self.gain[1]
    }

    /// R at the temperature of the winding. The state is the difference to the ambient temperature.
    fn resistance(&self, d: &Fields) -> f64 {
        let [cold, _, growth, reference, ..] = *self.gain;
        let ambient = self.dyn_[4];
        let warm = self.state(d, self.slots.temperature);
        warm.map_or(cold, |t| cold * (1.0 + growth * (t + ambient - reference)))
    }

    /// The voltage that a controller applies to obtain a torque, computed with the resistance of the cold winding, plus the
    /// voltage input.
    fn voltage(&self, d: &Fields, inputs: &ServoInputs) -> f64 {
        if !inputs.controller {
            return inputs.voltage;
        }
        let [resistance, k, _, _, kp, ki, kd, limit, ..] = *self.gain;
        let sum = self.state(d, self.slots.integral).unwrap_or(0.0);
        let (error, slip) = (inputs.pos.unwrap_or(0.0) - self.length, inputs.vel - self.velocity);
        let torque = kp * error + ki * sum + kd * slip + inputs.ff;
        let voltage = resistance / k * torque + k * self.velocity;
        inputs.voltage + if limit > 0.0 { clamp(voltage, -limit, limit) } else { voltage }
    }

    /// g(ω): dry friction, which is larger at low speed.
    fn dry_friction(&self) -> f64 {
        let [_, _, _, coulomb, stiction, speed, ..] = *self.bias;
        let ratio = self.velocity / speed.max(MINVAL);
        coulomb + (stiction - coulomb) * libm::exp(-ratio * ratio)
    }

    /// -σ₀ |ω|/g(ω): the decay rate of the bristle deflection.
    fn slipping(&self) -> f64 {
        -self.dyn_[5] * self.velocity.abs() / self.dry_friction().max(MINVAL)
    }
}

/// Computes `act_dot` of a motor. If the motor has a slew rate limit, its first control is replaced by the limited one.
pub(super) fn rates(m: &Model, d: &mut Fields, i: usize, ctrl: &mut [f64]) {
    let motor = Motor::new(m, d, i);
    let (slots, first, h) = (motor.slots, motor.first, m.opt.timestep);
    if let Some(last) = motor.state(d, slots.slew) {
        let step = motor.dyn_[7] * h;
        if let Some(u) = ctrl.get_mut(m.actuator_ctrladr[i] as usize).filter(|_| m.actuator_ctrlnum[i] > 0) {
            *u = clip(*u, [last - step, last + step]);
            d.act_dot[first + slots.slew.unwrap_or(0)] = (*u - last) / h;
        }
    }
    let inputs = ServoInputs::new(m, i, ctrl);
    let voltage = motor.voltage(d, &inputs);
    let (k, resistance) = (motor.constant(), motor.resistance(d));
    if let Some(s) = slots.integral {
        let error = inputs.pos.unwrap_or(0.0) - motor.length;
        d.act_dot[first + s] = anti_windup_rate(error, d.act[first + s], motor.dyn_[8]);
    }
    if let Some(s) = slots.temperature {
        let [_, _, thermal_resistance, capacity, ..] = *motor.dyn_;
        let current =
            motor.state(d, slots.current).unwrap_or_else(|| (voltage - k * motor.velocity) / resistance);
        let heat = resistance * current * current - d.act[first + s] / thermal_resistance;
        d.act_dot[first + s] = heat / capacity;
    }
    if let Some(s) = slots.bristle {
        d.act_dot[first + s] = motor.slipping() * d.act[first + s] + motor.velocity;
    }
    if let Some(s) = slots.current {
        let limit = motor.dyn_[1];
        let rate =
            (voltage / resistance - k / resistance * motor.velocity - d.act[first + s]) / motor.dyn_[0];
        d.act_dot[first + s] = if limit > 0.0 { clamp(rate, -limit, limit) } else { rate };
    }
}

/// Activation `index` of a motor at the end of the step. The current and the bristle deflection are integrated exactly, for constant
/// voltage and speed.
pub(super) fn next(m: &Model, d: &Fields, i: usize, index: usize, rate: f64) -> f64 {
    let motor = Motor::new(m, d, i);
    let (act, h, slot) = (d.act[index], m.opt.timestep, Some(index - motor.first));
    if slot == motor.slots.current {
        exact(act, rate, motor.dyn_[0], h)
    } else if slot == motor.slots.bristle {
        let a = motor.slipping();
        let decay = libm::exp(a * h);
        let gain = if a.abs() > MINVAL { (decay - 1.0) / a } else { h };
        decay * act + gain * motor.velocity
    } else {
        motor.within(slot, act + rate * h)
    }
}

/// A value of activation `index` of a motor, clamped to its limits. Only the integral of the error has a limit.
pub(super) fn within(m: &Model, d: &Fields, i: usize, index: usize, value: f64) -> f64 {
    let motor = Motor::new(m, d, i);
    motor.within(Some(index - motor.first), value)
}

/// The torque of the winding. Without a state for the current, the back EMF is not included.
pub(super) fn electric(m: &Model, d: &Fields, i: usize, ctrl: &[f64]) -> f64 {
    let motor = Motor::new(m, d, i);
    match motor.slots.current {
        Some(s) => {
            let index = motor.first + s;
            let current =
                if m.actuator_actearly[i] { next(m, d, i, index, d.act_dot[index]) } else { d.act[index] };
            motor.constant() * current
        }
        None => {
            let voltage = motor.voltage(d, &ServoInputs::new(m, i, ctrl));
            motor.constant() / motor.resistance(d).max(MINVAL) * voltage
        }
    }
}

/// The torque -K²ω/R of the back EMF. Zero with a state for the current, whose equation contains the back EMF.
pub(super) fn back_emf(m: &Model, d: &Fields, i: usize) -> f64 {
    let motor = Motor::new(m, d, i);
    if motor.slots.current.is_some() {
        return 0.0;
    }
    let k = motor.constant();
    -(k / motor.resistance(d).max(MINVAL)) * k * motor.velocity
}

/// The derivatives of a motor's torque with respect to velocity and length. They consist of those of the winding, which follows a
/// change of the voltage with the electrical time constant if it has one, and of the viscous friction of the
/// bristles. Voltage limits, cogging and the deflection of bristles are not included, as in MuJoCo.
pub(crate) fn slopes(m: &Model, d: &Fields, i: usize, ctrl: &[f64]) -> [f64; 2] {
    let motor = Motor::new(m, d, i);
    let (k, resistance) = (motor.constant(), motor.resistance(d).max(MINVAL));
    let mut voltage = [-k, 0.0];
    if ServoInputs::new(m, i, ctrl).controller {
        let [cold, _, _, _, kp, _, kd, ..] = *motor.gain;
        voltage = [-cold / k * kd, -cold / k * kp];
    }
    let followed = match motor.slots.current {
        Some(_) => 1.0 - libm::exp(-m.opt.timestep / motor.dyn_[0]),
        None => 1.0,
    };
    let [velocity, length] = voltage.map(|v| v * k / resistance * followed);
    let viscous = if motor.slots.bristle.is_some() { motor.dyn_[6] } else { 0.0 };
    [velocity - viscous, length]
}

/// `kp` and `kv` of a motor at its reference temperature: those of its controller, which compensates the back EMF, or 0 and K²/R
/// without a controller. `None` if the current or the temperature is a state: the force then follows the position with a delay,
/// or decreases over time.
pub(crate) fn gains(m: &Model, i: usize) -> Option<[f64; 2]> {
    let [electric, _, thermal, ..] = *prm(&m.actuator_dynprm, i);
    let [resistance, k, _, _, kp, _, kd, ..] = *prm(&m.actuator_gainprm, i);
    let controller = m.actuator_ctrlnum[i] > 0 && inputs::controls_motion(m.actuator_ctrlspec[i]);
    let at_once = electric <= 0.0 && thermal <= 0.0;
    at_once.then(|| if controller { [kp, kd] } else { [0.0, k * k / resistance.max(MINVAL)] })
}

/// Cogging and friction torque, to which limits of the current do not apply.
pub(super) fn mechanical(m: &Model, d: &Fields, i: usize) -> f64 {
    let motor = Motor::new(m, d, i);
    let [amplitude, teeth, phase, ..] = *motor.bias;
    let cogging = if amplitude == 0.0 { 0.0 } else { amplitude * libm::sin(teeth * motor.length + phase) };
    let friction = motor
        .slots
        .bristle
        .map_or(0.0, |s| motor.dyn_[5] * d.act[motor.first + s] + motor.dyn_[6] * d.act_dot[motor.first + s]);
    cogging - friction
}
