//! Limits: detects joints that are far outside their range.
//!
//! A limit acts like a spring with a time constant T. A joint that arrives with the speed v exceeds it by about v T / e,
//! and a joint under a load stays a little beyond it. Both are normal for soft limits and are not reported. Two cases are
//! reported:
//!
//! * a joint that is beyond its limit by a large part of its range, either because one step moved it there before any force
//!   could act, or because it stays there: the load is stronger than the limit;
//! * a joint that is beyond its limit by more than half of its range, for however short a time.

use labspec_core::math::rows;
use labspec_core::{Data, Model, Scope, disable, joint};

/// A limit does not hold a joint that is beyond it by this fraction of its range.
const FAR_BEYOND: f64 = 0.5;
/// A limit does not hold a joint that is beyond it by the fraction `MIN_EXCESS` of its range, if one step longer than that
/// moved it there, or if it stays there for `MIN_DURATION` seconds and `STEPS` steps.
const MIN_EXCESS: f64 = 0.2;
const MIN_DURATION: f64 = 0.25;
const STEPS: u32 = 32;
/// The smallest excess that is reported: an angle, rad, and a length as a fraction of the extent of the scene.
const ANGLE: f64 = 0.1;
const LENGTH: f64 = 0.02;
/// The range of a slide joint counts as at most this many times the extent of the scene.
const MAX_RANGE_EXTENTS: f64 = 10.0;

/// A joint beyond its limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExceededLimit {
    /// Time at which it exceeded the limit, s.
    pub time: f64,
    /// Id of the joint.
    pub joint: usize,
    /// Distance beyond the limit, m or rad.
    pub beyond: f64,
    /// Width of the range of the joint, m or rad.
    pub range: f64,
    /// Displacement of the step that moved the joint beyond its limit, m or rad; `None` when a load presses it there.
    pub step: Option<f64>,
}

/// A joint with limits.
#[derive(Clone, Copy, Debug)]
struct Limited {
    joint: usize,
    qpos: usize,
    /// Its range, and the wider interval within which nothing is evaluated.
    range: [f64; 2],
    pass: [f64; 2],
    /// Reference size for the thresholds, m or rad.
    size: f64,
    /// Position before the step.
    before: f64,
    /// Whether the joint started beyond its limit and has not returned yet.
    outside: bool,
    /// Number of steps for which it has been beyond the limit, and the time of the first.
    lasted: u32,
    since: f64,
}

/// The monitored joints.
#[derive(Clone, Debug)]
pub struct LimitMonitor {
    joints: Vec<Limited>,
}

/// Starts monitoring the joint limits of a model, in a run in state `d`.
pub fn watch<S: Scope>(m: &Model, d: &Data<S>) -> LimitMonitor {
    let on = !m.opt.disabled(disable::LIMIT) && !m.opt.disabled(disable::CONSTRAINT);
    let limited = |j: usize| {
        let turns = match m.jnt_type[j] {
            joint::HINGE => true,
            joint::SLIDE => false,
            _ => return None,
        };
        let [low, high] = *rows::<2>(&m.jnt_range).get(j)?;
        let (most, least) = if turns {
            (2.0 * std::f64::consts::PI, ANGLE)
        } else {
            (MAX_RANGE_EXTENTS * m.stat.extent, LENGTH * m.stat.extent)
        };
        let size = (high - low).min(most).max(least / MIN_EXCESS);
        let slack = MIN_EXCESS * size;
        let range = [low, high];
        let qpos = m.jnt_qposadr[j] as usize;
        let before = *d.fields().qpos.get(qpos)?;
        let pass = [low - slack, high + slack];
        (on && m.jnt_limited[j]).then_some(Limited {
            joint: j,
            qpos,
            range,
            pass,
            size,
            before,
            outside: before < pass[0] || before > pass[1],
            lasted: 0,
            since: 0.0,
        })
    };
    LimitMonitor { joints: (0..m.njnt).filter_map(limited).collect() }
}

/// Call after each step.
#[inline]
pub fn observe<S: Scope>(w: &mut LimitMonitor, d: &Data<S>) -> Option<ExceededLimit> {
    let qpos = &d.fields().qpos;
    w.joints.iter_mut().find_map(|j| {
        let q = qpos.get(j.qpos)?;
        let before = std::mem::replace(&mut j.before, *q);
        if *q >= j.pass[0] && *q <= j.pass[1] {
            (j.lasted, j.outside) = (0, false);
            return None;
        }
        report_far_beyond(j, d.time(), [before, *q])
    })
}

/// The report about a joint that is far beyond its limit, if it has to be reported.
#[cold]
fn report_far_beyond(j: &mut Limited, time: f64, [before, q]: [f64; 2]) -> Option<ExceededLimit> {
    let step = q - before;
    let beyond = |q: f64| (j.range[0] - q).max(q - j.range[1]);
    if j.lasted == 0 {
        j.since = time;
    }
    j.lasted += 1;
    // A step towards the range did not move the joint beyond the limit.
    let outward = if q > j.range[1] { step } else { -step };
    let jumped = outward > MIN_EXCESS * j.size && beyond(before) < MIN_EXCESS * j.size && step.is_finite();
    let stays = j.lasted >= STEPS && time - j.since >= MIN_DURATION;
    let step = jumped.then_some(step.abs());
    let range = j.range[1] - j.range[0];
    let pressed = !j.outside && beyond(q) > FAR_BEYOND * j.size;
    (jumped || stays || pressed).then(|| ExceededLimit {
        time: j.since,
        joint: j.joint,
        beyond: beyond(q),
        range,
        step,
    })
}

#[cfg(test)]
#[allow(clippy::unwrap_used)] // a panic is the report of a failed test
mod tests {
    use super::*;
    use labspec_core::{step, xml};

    fn run(joint: &str, rest: &str, speed: f64) -> Option<ExceededLimit> {
        let text = format!(
            "<mujoco><option gravity=\"0 0 0\"/><worldbody><body><joint name=\"j\" axis=\"0 1 0\" {joint}/>\
             <geom size=\".1\" pos=\".5 0 0\" mass=\"1\"/></body></worldbody>{rest}</mujoco>"
        );
        let m = xml::compile(&text).unwrap();
        let mut d = Data::new(&m);
        d.edit().qvel[0] = speed;
        let mut w = watch(&m, &d);
        (0..500).find_map(|_| {
            step(&m, &mut d).unwrap();
            observe(&mut w, &d)
        })
    }

    #[test]
    fn a_step_past_a_limit_is_reported_and_a_soft_limit_is_not() {
        let found = run("range=\"-45 45\"", "", 1000.0).unwrap();
        assert!(found.joint == 0 && found.time < 0.003 && found.step.unwrap() > 1.9, "{found:?}");
        assert!(found.beyond > 1.1 && (found.range - std::f64::consts::FRAC_PI_2).abs() < 1e-9, "{found:?}");
        for speed in [0.0, 10.0, 50.0, 100.0] {
            assert_eq!(run("range=\"-45 45\"", "", speed), None, "{speed} rad/s");
        }
        // RK4 evaluates the limit in its stages, so the velocity at the end of a step differs from the velocity of the
        // motion.
        let rk4 = run("range=\"-45 45\"", "<option integrator=\"RK4\"/>", 1e4).unwrap();
        assert!(rk4.time < 0.003 && rk4.step.unwrap() > 10.0, "{rk4:?}");
        // Without a limit nothing is reported.
        assert_eq!(run("", "", 1000.0), None);
    }

    #[test]
    fn a_motor_that_holds_a_joint_beyond_its_limit_is_reported() {
        let motor = |force: f64| {
            let rest = format!(
                "<actuator><position joint=\"j\" kp=\"{force}\" kv=\"{}\"/></actuator>",
                force / 50.0
            );
            run("range=\"10 40\" ref=\"0\" damping=\"1\"", &rest, 0.0)
        };
        // It starts 10 degrees outside its range, and a servo of 1e5 N m/rad keeps it there.
        assert_eq!(motor(1.0), None);
        let found = motor(1e5).unwrap();
        assert!(found.step.is_none() && found.beyond > 0.13, "{found:?}");
    }

    #[test]
    fn a_start_outside_that_returns_is_not_reported() {
        let text = "<mujoco><worldbody><body><joint type=\"slide\" range=\"0 .1\"/><geom size=\".1\" mass=\"1\"/></body></worldbody></mujoco>";
        let m = xml::compile(text).unwrap();
        let mut d = Data::new(&m);
        d.edit().qpos[0] = 0.3;
        let mut w = watch(&m, &d);
        for _ in 0..500 {
            step(&m, &mut d).unwrap();
            assert_eq!(observe(&mut w, &d), None);
        }
    }
}
