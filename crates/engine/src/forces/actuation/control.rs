//! Controls as applied: delayed, clamped, and all zero if one of them is a bad number.

use crate::forces::history;
use crate::kinds::{disable, gaintype};
use crate::math::*;
use crate::model::{Fields, Model, Warning};
use std::ops::Range;

/// Addresses of the controls of actuator `i`.
fn controls(m: &Model, i: usize) -> Range<usize> {
    let first = m.actuator_ctrladr[i] as usize;
    first..first + m.actuator_ctrlnum[i] as usize
}

/// The address of the history of actuator `i`, and its number of samples, or `None` if it has no history.
fn buffer(m: &Model, i: usize) -> Option<(Range<usize>, usize)> {
    let n = usize::try_from(m.actuator_history[2 * i]).ok().filter(|&n| n > 0)?;
    let address = usize::try_from(m.actuator_historyadr[i]).ok()?;
    Some((address..address + history::size(n, m.actuator_ctrlnum[i] as usize), n))
}

/// Fills `ctrl` with the controls that are applied at the current time.
pub(super) fn effective(m: &Model, d: &mut Fields, ctrl: &mut [f64]) {
    ctrl.copy_from_slice(&d.ctrl);
    if m.nhistory > 0 {
        for i in (0..m.nactuator).filter(|&i| m.actuator_delay[i] != 0.0) {
            let Some((range, n)) = buffer(m, i) else { continue };
            let out = &mut ctrl[controls(m, i)];
            let time = d.time - m.actuator_delay[i];
            history::read(&d.history[range], n, out.len(), time, m.actuator_history[2 * i + 1], out);
        }
    }
    if !m.opt.disabled(disable::CLAMPCTRL) {
        for ((u, &limited), range) in
            ctrl.iter_mut().zip(&m.actuator_ctrllimited).zip(rows::<2>(&m.actuator_ctrlrange))
        {
            if limited {
                *u = clip(*u, *range);
            }
        }
    }
    if let Some(i) = ctrl.iter().position(|&u| bad(u)) {
        d.warn(Warning::BadCtrl, i);
        ctrl.fill(0.0);
    }
}

/// Stores the current controls, for actuators with a history.
pub(crate) fn record(m: &Model, d: &mut Fields) {
    for i in 0..m.nactuator {
        let Some((range, n)) = buffer(m, i) else { continue };
        let controls = controls(m, i);
        let slot = history::insert(&mut d.history[range], n, controls.len(), d.time);
        if slot.len() == controls.len() {
            slot.copy_from_slice(&d.ctrl[controls]);
        }
    }
}

/// Sets neutral controls, at the current and all past times: zero, and the identity for quaternions.
pub(crate) fn reset(m: &Model, d: &mut Fields) {
    let h = m.opt.timestep;
    for i in 0..m.nactuator {
        let controls = controls(m, i);
        let identity = m.actuator_gaintype[i] == gaintype::SO3 && controls.len() == 4;
        if identity {
            d.ctrl[controls.start] = 1.0;
        }
        let Some((range, n)) = buffer(m, i) else { continue };
        let buf = &mut d.history[range];
        history::init(buf, n, 0.0, |i| -((n - i) as f64) * h);
        if identity {
            for value in rows_mut::<4>(&mut buf[2 + n..]) {
                *value = IDENTITY;
            }
        }
    }
}
