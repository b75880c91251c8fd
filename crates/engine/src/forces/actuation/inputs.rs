//! The inputs of controllers: a position, a velocity, a feedforward, a voltage.

use crate::model::Model;

/// Inputs of controllers: bits of `actuator_ctrlspec`, in the order of the controls.
const POS: i32 = 1;
const VEL: i32 = 2;
const FF: i32 = 4;
const VOLTAGE: i32 = 8;
/// No inputs.
const NONE: i32 = 16;
/// Whether some input is one of a motion controller, not only a voltage of the winding.
pub(super) fn controls_motion(spec: i32) -> bool {
    spec & NONE == 0 && spec & (POS | VEL | FF) != 0
}

/// The inputs of a servo.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ServoInputs {
    pub(super) pos: Option<f64>,
    pub(super) vel: f64,
    pub(super) ff: f64,
    pub(super) voltage: f64,
    /// Whether there is an input other than a voltage.
    pub(super) controller: bool,
}

impl ServoInputs {
    pub(super) fn new(m: &Model, i: usize, ctrl: &[f64]) -> ServoInputs {
        let spec = m.actuator_ctrlspec[i];
        let mut address = m.actuator_ctrladr[i] as usize;
        let end = address + m.actuator_ctrlnum[i] as usize;
        let mut take = |bit: i32| {
            let here = (spec & bit != 0 && address < end).then(|| ctrl[address]);
            address += usize::from(here.is_some());
            here
        };
        let (pos, vel, ff, voltage) = (take(POS), take(VEL), take(FF), take(VOLTAGE));
        ServoInputs {
            pos,
            vel: vel.unwrap_or(0.0),
            ff: ff.unwrap_or(0.0),
            voltage: voltage.unwrap_or(0.0),
            controller: spec & NONE == 0 && (pos.is_some() || vel.is_some() || ff.is_some()),
        }
    }
}

/// The rate of an integral x that is limited to ±limit. A limit of 0 means no limit.
pub(super) fn anti_windup_rate(rate: f64, x: f64, limit: f64) -> f64 {
    if limit > 0.0 && x >= limit {
        rate.min(0.0)
    } else if limit > 0.0 && x <= -limit {
        rate.max(0.0)
    } else {
        rate
    }
}
