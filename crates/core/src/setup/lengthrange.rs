//! The range of lengths that an actuator can reach, found by simulation (`mj_setLengthRange`).
//!
//! The force of a muscle is specified for its operating range, which depends on the mechanism around it. As in MuJoCo's
//! documentation, "Modeling: Length range", the actuator is pulled to either end by a force that would accelerate the mechanism
//! by a given amount. Gravity, springs, dampers, contacts and friction are off, limits and equality constraints are on, and the
//! motion is damped. The extreme lengths during the last part of the simulation are the range.

use crate::dynamics::mass;
use crate::dynamics::reflected::target;
use crate::forces::transmission::row;
use crate::kinds::{biastype, disable, gaintype, joint, trntype};
use crate::math::*;
use crate::model::{Fields, Model};
use crate::step::workspace::StepScratch;
use crate::step::{self, reset};

/// The actuators whose range is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Mode {
    Nothing,
    Muscles,
    All,
}

/// The parameters of the search.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RangeSearch {
    pub(crate) mode: Mode,
    /// Whether an existing range is kept.
    pub(crate) useexisting: bool,
    /// Whether the limits of the joint or tendon are used as the range.
    pub(crate) uselimit: bool,
    /// Acceleration, and the largest force (0 for no limit).
    pub(crate) accel: f64,
    pub(crate) maxforce: f64,
    /// Time constant of the damping of the motion, s.
    pub(crate) timeconst: f64,
    /// Timestep, total time, and the length of its last part, in which the length must have settled, s.
    pub(crate) timestep: f64,
    pub(crate) inttotal: f64,
    pub(crate) interval: f64,
    /// The largest variation of the length in the last part, as a fraction of the range.
    pub(crate) tolrange: f64,
}

impl Default for RangeSearch {
    fn default() -> Self {
        RangeSearch {
            mode: Mode::Muscles,
            useexisting: true,
            uselimit: false,
            accel: 20.0,
            maxforce: 0.0,
            timeconst: 1.0,
            timestep: 0.01,
            inttotal: 10.0,
            interval: 2.0,
            tolrange: 0.05,
        }
    }
}

/// The reason why no range was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum RangeError {
    /// The length at the upper end does not exceed the length at the lower end.
    NoRange([f64; 2]),
    /// The length at one end has not settled; it varies between these lengths.
    NotSettled([f64; 2]),
}

impl RangeSearch {
    /// Number of steps for both ends.
    pub(crate) fn steps(&self, m: &Model) -> f64 {
        2.0 * (self.inttotal / self.step(m)).max(0.0)
    }

    fn step(&self, m: &Model) -> f64 {
        if self.timestep > 0.0 { self.timestep } else { m.opt.timestep }
    }

    /// Whether the range of actuator `i` must be found by simulation.
    pub(crate) fn needs_search(&self, m: &Model, i: usize) -> bool {
        let muscle = m.actuator_gaintype[i] == gaintype::MUSCLE || m.actuator_biastype[i] == biastype::MUSCLE;
        let [lower, upper] = rows::<2>(&m.actuator_lengthrange)[m.actuator_outadr[i] as usize];
        let asked = match self.mode {
            Mode::Nothing => false,
            Mode::Muscles => muscle,
            Mode::All => true,
        };
        asked && !(self.useexisting && lower < upper)
    }

    /// The limits of the target of actuator `i`.
    ///
    /// MuJoCo 3.14.0 indexes the list of all target ids, with two ids per actuator, by `i`. For odd `i`, that id is usually
    /// absent. Here the ids of actuator `i` are used.
    pub(crate) fn limits(&self, m: &Model, i: usize) -> Option<[f64; 2]> {
        let id = usize::try_from(*m.actuator_trnid.get(i)?).ok()?;
        let (limited, ranges) = match m.actuator_trntype[i] {
            trntype::JOINT | trntype::JOINTINPARENT => {
                let scalar = matches!(m.jnt_type.get(id), Some(&(joint::SLIDE | joint::HINGE)));
                (scalar && *m.jnt_limited.get(id)?, &m.jnt_range)
            }
            trntype::TENDON => (*m.tendon_limited.get(id)?, &m.tendon_range),
            _ => (false, &m.jnt_range),
        };
        rows::<2>(ranges).get(id).copied().filter(|_| self.uselimit && limited)
    }
}

/// Computes `actuator_lengthrange` of actuator `i`, with `d` and `s` as workspace.
pub(crate) fn length_range(
    m: &mut Model,
    d: &mut Fields,
    s: &mut StepScratch,
    i: usize,
    search: &RangeSearch,
) -> Result<(), RangeError> {
    let o = m.actuator_outadr[i] as usize;
    if let Some(range) = search.limits(m, i) {
        rows_mut::<2>(&mut m.actuator_lengthrange)[o] = range;
        return Ok(());
    }
    let options = m.opt.clone();
    m.opt.timestep = search.step(m);
    // Limits are active here, whatever the model itself disables.
    m.opt.disableflags = disable::FRICTIONLOSS
        | disable::CONTACT
        | disable::SPRING
        | disable::DAMPER
        | disable::GRAVITY
        | disable::ACTUATION;
    let ends = [-1.0, 1.0].map(|sign| simulate_pull(m, d, s, o, sign, search));
    m.opt = options;
    let range = [ends[0][0], ends[1][1]];
    if range[0] >= range[1] || range.iter().any(|x| !x.is_finite()) {
        return Err(RangeError::NoRange(range));
    }
    let settled = |end: &[f64; 2]| end[1] - end[0] <= search.tolrange * (range[1] - range[0]);
    if let Some(end) = ends.into_iter().find(|end| !settled(end)) {
        return Err(RangeError::NotSettled(end));
    }
    rows_mut::<2>(&mut m.actuator_lengthrange)[o] = range;
    Ok(())
}

/// Smallest and largest length of output `o` in the last part of the simulation, pulled in one direction.
fn simulate_pull(
    m: &Model,
    d: &mut Fields,
    s: &mut StepScratch,
    o: usize,
    sign: f64,
    search: &RangeSearch,
) -> [f64; 2] {
    let damping = libm::exp(-m.opt.timestep / search.timeconst.max(0.01));
    let mut lengths: Option<[f64; 2]> = None;
    let mut acceleration = vec![0.0; m.nv];
    // The number of steps is limited too, because a bad state resets the time.
    let mut steps = search.steps(m) + 2.0;
    reset::reset_data(m, d, s);
    while d.time < search.inttotal && steps > 0.0 {
        step::step1(m, d, s);
        force(m, d, o, sign, search, &mut acceleration);
        step::step2(m, d, s);
        for v in &mut d.qvel {
            *v *= damping;
        }
        let length = d.actuator_length[o];
        if d.time > search.inttotal - search.interval {
            let [lower, upper] = lengths.unwrap_or([length; 2]);
            lengths = Some([lower.min(length), upper.max(length)]);
        }
        steps -= 1.0;
    }
    lengths.unwrap_or([0.0; 2])
}

/// Applies a force along the moment of output `o` that would accelerate the mechanism by |M⁻¹ f| = `accel`.
fn force(m: &Model, d: &mut Fields, o: usize, sign: f64, search: &RangeSearch, acceleration: &mut [f64]) {
    acceleration.fill(0.0);
    d.qfrc_applied.fill(0.0);
    for index in row(d, o) {
        let (k, x) = (d.moment_colind[index] as usize, d.actuator_moment[index]);
        acceleration[k] = x;
        d.qfrc_applied[k] = x;
    }
    mass::solve(m, &d.qLD, &d.qLDiagInv, acceleration, 0..m.nv);
    let length = |v: &[f64]| dot_slice(v, v).sqrt();
    let mut factor = sign * search.accel / length(acceleration).max(MINVAL);
    let force = length(&d.qfrc_applied) * factor.abs();
    if search.maxforce > 0.0 && force > search.maxforce {
        factor *= search.maxforce / force;
    }
    d.qfrc_applied.iter_mut().for_each(|f| *f *= factor);
}

/// Whether the length of an actuator can change.
pub(crate) fn has_length(m: &Model, i: usize) -> bool {
    match (m.actuator_trntype[i], target(m, i)) {
        (trntype::BODY, _) | (trntype::SITE, (_, None)) => false,
        (trntype::JOINT | trntype::JOINTINPARENT, (j, _)) => m.jnt_type[j] != joint::FREE,
        _ => true,
    }
}

#[cfg(test)]
mod tests {
    use crate::mjcf::compile;

    /// The length ranges of an arm, with these compiler settings, options, attributes of the joint and actuators.
    fn arm(lengthrange: &str, option: &str, joint: &str, actuators: &str) -> Result<Vec<f64>, String> {
        let model = format!(
            "<mujoco><compiler><lengthrange {lengthrange}/></compiler><option {option}/><worldbody><body>
             <joint name='a' axis='0 1 0' {joint}/><geom type='capsule' fromto='0 0 0 .3 0 0' size='.02'/></body>
             </worldbody><actuator>{actuators}</actuator></mujoco>"
        );
        compile(&model).map(|m| m.actuator_lengthrange).map_err(|e| e[0].message.clone())
    }

    /// Compares with the ranges that MuJoCo 3.14.0 finds.
    #[test]
    fn ranges_are_those_of_mujoco() {
        let limit = "range='-60 60'";
        let muscle = "<muscle joint='a'/>";
        let motor = "<motor joint='a'/>";
        let two = "<motor joint='a' gear='3'/><motor joint='a' gear='3'/>";
        let found = 1.0477674895499682;
        let cases: [(&str, &str, &str, &[f64]); 10] = [
            ("mode='all'", "", motor, &[found]),
            ("", "integrator='RK4'", muscle, &[found]),
            ("", "integrator='implicit'", muscle, &[found]),
            ("", "integrator='discrete'", muscle, &[found]),
            ("", "", motor, &[0.0]),
            ("mode='muscleuser'", "", motor, &[0.0]),
            ("mode='none'", "", muscle, &[0.0]),
            ("timestep='0'", "", muscle, &[1.0477674895498892]),
            ("mode='all'", "", "<motor joint='a' lengthrange='-.1 .1'/>", &[0.1]),
            ("mode='all' uselimit='true'", "", two, &[1.0471975511965976, 3.143302468649905]),
        ];
        for (lengthrange, option, actuators, expected) in cases {
            let got = arm(lengthrange, option, limit, actuators).unwrap();
            let expected: Vec<f64> = expected.iter().flat_map(|x| [-x, *x]).collect();
            let difference = got.iter().zip(&expected).fold(0.0f64, |s, (a, b)| s.max((a - b).abs()));
            assert!(
                got.len() == expected.len() && difference < 2e-12,
                "{lengthrange} {option}: {got:?}, not {expected:?}"
            );
        }
    }

    /// If MuJoCo finds no range, this code finds none. A search without end is not started.
    #[test]
    fn an_actuator_without_a_range_is_an_error() {
        let limit = "range='-60 60'";
        let motor = "<motor joint='a'/>";
        let cases = [
            ("", "", "<muscle joint='a'/>", "still moves between -181.00"),
            ("inttotal='1' interval='3'", limit, "<muscle joint='a'/>", "still moves between -1.0695"),
            ("accel='-20'", limit, "<muscle joint='a'/>", "pulling it either way gives 1.0478 and -1.0478"),
            (
                "mode='all'",
                limit,
                "<motor joint='a' gear='0'/>",
                "pulling it either way gives 0.0000 and 0.0000",
            ),
            ("mode='all' inttotal='1e300'", limit, motor, "too many steps"),
            ("mode='all' timestep='1e-300'", limit, motor, "too many steps"),
            ("mode='all' accel='1e300'", limit, motor, "no length range"),
            ("mode='all' timeconst='-1' interval='-5'", limit, motor, "no length range"),
        ];
        for (lengthrange, joint, actuators, expected) in cases {
            let message = arm(lengthrange, "", joint, actuators).unwrap_err();
            assert!(message.contains(expected), "{lengthrange}: {message}");
        }
    }
}
