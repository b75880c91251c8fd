//! How much a lab depends on its start: the largest Lyapunov exponent over the window, and until when the digits that are shown would
//! be the same for a start that nobody could tell apart.
//!
//! The exponent is that of G. Benettin and others 1980 ("Lyapunov characteristic exponents …", Meccanica 15): a second run beside the
//! first, brought back to its distance again and again, and the mean of the logarithms by which they parted. Several directions give
//! its spread.

use super::case::Case;
use crate::run::{self, Numerics, Play, Session};
use labspec_core::{differentiate_pos, integrate_pos};
use std::ops::ControlFlow;

/// How far the second run is from the first, in the units of the coordinates; how often it is brought back; directions.
const APART: f64 = 1e-7;
const TIMES: usize = 100;
const DIRECTIONS: u64 = 3;
/// The part of the run in which a direction turns into that of the fastest growth, and that does not count.
const TURNS: f64 = 0.2;
/// The start that nobody could tell apart.
const NUDGE: f64 = 1e-9;
/// Samples of what is shown, at most.
const SAMPLES: usize = 4000;
/// Work for all of it.
const WORK: u64 = 3_000_000_000;

/// The largest Lyapunov exponent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exponent {
    /// The mean of the directions, 1/s.
    pub mean: f64,
    /// The smallest of them.
    pub low: f64,
    /// The largest.
    pub high: f64,
}

/// Until when a readout shows the same.
#[derive(Clone, Debug, PartialEq)]
pub struct Horizon {
    /// Its label.
    pub label: String,
    /// When its digits are lost, s; `None` where they are not.
    pub until: Option<f64>,
}

/// How much a lab depends on its start.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensitivity {
    /// Over how long, s.
    pub length: f64,
    /// How far the other start is off.
    pub apart: f64,
    /// The exponent; `None` where the lab has no degrees of freedom or does not come to its end.
    pub exponent: Option<Exponent>,
    /// The readouts.
    pub horizons: Vec<Horizon>,
}

/// The sensitivity of a lab as it stands. Work is added to `work`.
pub(super) fn sensitivity(case: &Case<'_>, length: f64, work: &mut u64) -> Sensitivity {
    let exponents: Vec<f64> = (1..=DIRECTIONS).filter_map(|k| exponent(case, length, k, work)).collect();
    let all = exponents.len() as u64 == DIRECTIONS;
    let exponent = all.then(|| Exponent {
        mean: exponents.iter().sum::<f64>() / exponents.len() as f64,
        low: exponents.iter().copied().fold(f64::INFINITY, f64::min),
        high: exponents.iter().copied().fold(f64::NEG_INFINITY, f64::max),
    });
    Sensitivity { length, apart: NUDGE, exponent, horizons: horizons(case, length, work) }
}

/// The exponent that one direction gives.
fn exponent(case: &Case<'_>, length: f64, seed: u64, work: &mut u64) -> Option<f64> {
    let mut first = case.start(&case.base, WORK / 8);
    let nv = first.world.model.nv;
    let h = first.world.model.opt.timestep;
    let steps = case.steps(h, length);
    let each = (steps / TIMES).max(1);
    if nv == 0 || steps == 0 {
        return None;
    }
    let mut second = first.clone();
    move_apart(&first, &mut second, &direction(seed, 2 * nv), APART)?;
    let (mut sum, mut made, mut counted) = (0.0, 0, 0);
    while made < steps {
        let some = each.min(steps - made);
        let done =
            [&mut first, &mut second].map(|s| run::play(s, &chunk(some), |_, _| ControlFlow::Continue(())));
        made += some;
        let apart = difference(&first, &second)?;
        let size = apart.iter().map(|x| x * x).sum::<f64>().sqrt();
        if done != [some; 2] || !(size.is_finite() && size > 0.0) || warned(&first) || warned(&second) {
            *work += first.spent() + second.spent();
            return None;
        }
        if made as f64 > TURNS * steps as f64 {
            sum += (size / APART).ln();
            counted += some;
        }
        let along: Vec<f64> = apart.iter().map(|x| x / size).collect();
        move_apart(&first, &mut second, &along, APART)?;
    }
    *work += first.spent() + second.spent();
    (counted > 0).then(|| sum / (counted as f64 * h))
}

fn chunk(steps: usize) -> Play<'static> {
    Play { every: steps, ..Play::steps(steps) }
}

fn warned(session: &Session<'_>) -> bool {
    session.warnings.iter().any(|w| w.number > 0)
}

/// A direction of length 1, the same for the same seed.
fn direction(seed: u64, n: usize) -> Vec<f64> {
    let mut bits = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    let mut next = || {
        // xorshift64
        bits ^= bits << 13;
        bits ^= bits >> 7;
        bits ^= bits << 17;
        (bits >> 11) as f64 / (1u64 << 53) as f64 - 0.5
    };
    let list: Vec<f64> = (0..n).map(|_| next()).collect();
    let size = list.iter().map(|x| x * x).sum::<f64>().sqrt();
    list.into_iter().map(|x| x / size).collect()
}

/// From the state of the first to that of the second: of places, then of speeds.
fn difference(first: &Session<'_>, second: &Session<'_>) -> Option<Vec<f64>> {
    let m = &first.world.model;
    let [a, b] = [first, second].map(|s| s.world.data.fields());
    let mut list = differentiate_pos(m, 1.0, &a.qpos, &b.qpos).ok()?;
    list.extend(b.qvel.iter().zip(&a.qvel).map(|(b, a)| b - a));
    Some(list)
}

/// Puts the second at some distance from the first.
fn move_apart(first: &Session<'_>, second: &mut Session<'_>, along: &[f64], apart: f64) -> Option<()> {
    let from = first.world.data.fields();
    let nv = first.world.model.nv;
    let (places, speeds) = along.split_at_checked(nv)?;
    let mut qpos = from.qpos.to_vec();
    integrate_pos(&first.world.model, &mut qpos, places, apart).ok()?;
    let to = second.world.data.edit();
    to.qpos.copy_from_slice(&qpos);
    to.act.copy_from_slice(&from.act);
    to.qacc_warmstart.copy_from_slice(&from.qacc_warmstart);
    for ((to, from), along) in to.qvel.iter_mut().zip(&from.qvel).zip(speeds) {
        *to = from + apart * along;
    }
    Some(())
}

/// When each readout of a run that begins a little off shows something else.
fn horizons(case: &Case<'_>, length: f64, work: &mut u64) -> Vec<Horizon> {
    let skipped: usize = case.lab.plots.iter().map(|p| p.traces.len()).sum();
    let readouts: Vec<_> = case
        .lab
        .readouts
        .iter()
        .zip(case.programs.probes.iter().skip(skipped))
        .filter_map(|(readout, probe)| Some((readout, probe.bound.as_ref()?)))
        .collect();
    if readouts.is_empty() {
        return Vec::new();
    }
    let mut shown = |nudge: f64| {
        let mut session = case.start(&case.base, WORK / 4);
        if nudge != 0.0 {
            session.perturb(Numerics { nudge, ..Numerics::NOMINAL }, true);
        }
        let h = session.world.model.opt.timestep;
        let steps = case.steps(h, length);
        let every = steps.div_ceil(SAMPLES).max(1);
        let mut rows: Vec<Vec<f64>> = Vec::new();
        run::play(&mut session, &Play { every, ..Play::steps(steps) }, |session, _| {
            let mut value =
                |text, program| session.evaluate(program, text).map_or(f64::NAN, |v| v.to_number());
            rows.push(readouts.iter().map(|(_, b)| value(&b.text, &b.program)).collect());
            ControlFlow::Continue(())
        });
        *work += session.spent();
        (rows, every as f64 * h)
    };
    let (first, between) = shown(0.0);
    let (second, _) = shown(NUDGE);
    let horizon = |(k, (readout, _)): (usize, &(&crate::spec::Readout, &crate::bind::Bound))| {
        let lost = |(a, b): (&Vec<f64>, &Vec<f64>)| (a[k] - b[k]).abs() > 0.5 * unit(a[k], readout.digits());
        let at = first.iter().zip(&second).position(lost);
        Horizon { label: readout.label.value.clone(), until: at.map(|i| i as f64 * between) }
    };
    readouts.iter().enumerate().map(horizon).collect()
}

/// One unit of the last digit that is shown.
fn unit(x: f64, digits: u32) -> f64 {
    let size = x.abs();
    if size > 0.0 && !(1e-3..1e5).contains(&size) {
        return 10f64.powf(size.log10().floor() - 2.0);
    }
    0.1f64.powi(digits as i32)
}
