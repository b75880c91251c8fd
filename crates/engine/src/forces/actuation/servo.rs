//! Servos: position servos for angles, PID controllers, orientation servos.

use super::inputs::{ServoInputs, anti_windup_rate};
use super::{activation, prm, states};
use crate::dynamics::reflected::target;
use crate::kinds::{biastype, dyntype, gaintype, joint, trntype};
use crate::math::*;
use crate::model::{Fields, Model};
use std::f64::consts::PI;

/// The value of `actuator_ctrlspec` for controls that are a quaternion.
const QUAT: i32 = 2;

/// The change of the length of actuator `i` in one full turn, if its length is a periodic angle.
fn full_turn_length(m: &Model, i: usize) -> Option<f64> {
    let gear = rows::<6>(&m.actuator_gear)[m.actuator_outadr[i] as usize];
    let [along, about] = [[gear[0], gear[1], gear[2]], [gear[3], gear[4], gear[5]]];
    let axis = match (m.actuator_trntype[i], target(m, i)) {
        (trntype::SITE, (_, Some(_))) if along == [0.0; 3] => about,
        (trntype::JOINT | trntype::JOINTINPARENT, (j, _)) if m.jnt_type[j] == joint::BALL => along,
        _ => return None,
    };
    Some(2.0 * PI * norm(axis)).filter(|&t| t > 0.0)
}

/// The number that is nearest to `to` and differs from `u` by whole turns.
fn nearest(u: f64, to: f64, turn: f64) -> f64 {
    u - turn * ((u - to) / turn).round()
}

/// The setpoint of a position servo. If the length is an angle, whole turns are added to bring the setpoint close to it. Other
/// values are unchanged.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(super) fn wrapped(m: &Model, d: &Fields, i: usize, setpoint: f64) -> f64 {
    // The checks that exclude most actuators come first.
    let servo = m.actuator_biastype[i] == biastype::AFFINE
        && m.actuator_gaintype[i] == gaintype::FIXED
        && m.actuator_gainprm[10 * i] == -m.actuator_biasprm[10 * i + 1]
        && matches!(m.actuator_dyntype[i], dyntype::NONE | dyntype::INTEGRATOR);
    if servo { next_to_length(m, d, i, setpoint) } else { setpoint }
}

#[inline(never)] // rare: keeps the common path small
fn next_to_length(m: &Model, d: &Fields, i: usize, setpoint: f64) -> f64 {
    match full_turn_length(m, i) {
        Some(turn) => nearest(setpoint, d.actuator_length[m.actuator_outadr[i] as usize], turn),
        None => setpoint,
    }
}

/// The states of a PID controller: its setpoint, if it has a slew rate limit, and the integral of the error. If programs have
/// written parameters that do not match the number of states, there are none.
struct Pid {
    slew: Option<usize>,
    integral: Option<usize>,
}

impl Pid {
    fn new(m: &Model, i: usize) -> Pid {
        let (slews, integrates) = (m.actuator_dynprm[10 * i + 1] > 0.0, m.actuator_gainprm[10 * i] > 0.0);
        let mut states = states(m, i);
        if m.actuator_dyntype[i] != dyntype::PID
            || states.len() != usize::from(slews) + usize::from(integrates)
        {
            return Pid { slew: None, integral: None };
        }
        let slew = if slews { states.next() } else { None };
        Pid { slew, integral: states.next() }
    }

    /// The position setpoint at the current time.
    fn setpoint(&self, m: &Model, d: &Fields, i: usize, pos: f64) -> f64 {
        let turn = full_turn_length(m, i);
        let mut pos = pos;
        if let Some(index) = self.slew {
            let last = d.act[index];
            let step = m.actuator_dynprm[10 * i + 1] * m.opt.timestep;
            pos = clip(turn.map_or(pos, |turn| nearest(pos, last, turn)), [last - step, last + step]);
        }
        turn.map_or(pos, |turn| nearest(pos, d.actuator_length[m.actuator_outadr[i] as usize], turn))
    }
}

/// Computes `act_dot` of a PID controller.
pub(super) fn rates(m: &Model, d: &mut Fields, i: usize, ctrl: &[f64]) {
    let pid = Pid::new(m, i);
    let pos = ServoInputs::new(m, i, ctrl).pos.unwrap_or(0.0);
    if let Some(index) = pid.slew {
        let last = d.act[index];
        let step = m.actuator_dynprm[10 * i + 1] * m.opt.timestep;
        let to = full_turn_length(m, i).map_or(pos, |turn| nearest(pos, last, turn));
        d.act_dot[index] = (clip(to, [last - step, last + step]) - last) / m.opt.timestep;
    }
    if let Some(index) = pid.integral {
        let error = pid.setpoint(m, d, i, pos) - d.actuator_length[m.actuator_outadr[i] as usize];
        d.act_dot[index] = anti_windup_rate(error, d.act[index], m.actuator_dynprm[10 * i]);
    }
}

/// kp (pos - length) + kv (vel - velocity) + ki ∫ + feedforward + constant.
pub(super) fn pid(m: &Model, d: &Fields, i: usize, ctrl: &[f64]) -> f64 {
    let o = m.actuator_outadr[i] as usize;
    let b = prm(&m.actuator_biasprm, i);
    let states = Pid::new(m, i);
    let inputs = ServoInputs::new(m, i, ctrl);
    let setpoint = inputs.pos.map_or(0.0, |pos| states.setpoint(m, d, i, pos));
    let sum = states.integral.map_or(0.0, |index| activation::activation_of_step(m, d, i, index));
    let (error, slip) = (setpoint - d.actuator_length[o], inputs.vel - d.actuator_velocity[o]);
    b[0] - b[1] * error - b[2] * slip + m.actuator_gainprm[10 * i] * sum + inputs.ff
}

/// The torque kp log(q⁻¹ q*) + constant - kv ω, which rotates the orientation q towards q*.
pub(super) fn orientation(m: &Model, d: &Fields, i: usize, ctrl: &[f64]) -> Vec3 {
    let o = m.actuator_outadr[i] as usize;
    let vector_at = |list: &[f64], first: usize| [list[first], list[first + 1], list[first + 2]];
    let u = m.actuator_ctrladr[i] as usize;
    let states = states(m, i);
    let target = if m.actuator_ctrlspec[i] == QUAT {
        quat_normalize([ctrl[u], ctrl[u + 1], ctrl[u + 2], ctrl[u + 3]])
    } else if states.len() == 3 {
        rotation(std::array::from_fn(|k| activation::activation_of_step(m, d, i, states.start + k)))
    } else {
        rotation(vector_at(ctrl, u))
    };
    let current = rotation(vector_at(&d.actuator_length, o));
    let error = quat_to_vel(quat_mul(quat_conj(current), target));
    let (kp, b) = (m.actuator_gainprm[10 * i], prm(&m.actuator_biasprm, i));
    std::array::from_fn(|k| kp * error[k] + b[0] + b[2] * d.actuator_velocity[o + k])
}

/// The quaternion of a rotation vector.
fn rotation(v: Vec3) -> Quat {
    let angle = norm(v);
    if angle < MINVAL { IDENTITY } else { quat_axis_angle(scale(v, 1.0 / angle), angle) }
}
