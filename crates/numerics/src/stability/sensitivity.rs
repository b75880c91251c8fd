//! Sensitivity to the initial state: the growth factor of a small difference until the end of the window, whether it grows
//! exponentially, and how long the displayed digits remain the same for an indistinguishable start.
//!
//! A second run next to the first is repeatedly rescaled to its original distance, and the logarithms of the growth factors are
//! added up from the start (G. Benettin and others 1980, "Lyapunov characteristic exponents …", Meccanica 15). So the
//! difference stays small, and the result is that of an infinitesimal difference. Several directions give the spread. An
//! exponent is reported if the sum grows linearly: equally in both halves of the time, and in every direction.

use labspec::bind::Bound;
use labspec::run::{self, Play, Session, StepVariant};
use labspec::spec::Readout;
use labspec::stress::StressCase;
use labspec_core::{differentiate_pos, integrate_pos};
use std::ops::ControlFlow;

/// The distance of the second run from the first, in the units of the coordinates; the number of rescalings;
/// the number of directions.
const SEPARATION: f64 = 1e-7;
const TIMES: usize = 100;
const DIRECTIONS: u64 = 3;
/// Growth counts as exponential if the factor is at least `MIN_GROWTH`, a straight line explains at least `MIN_EXPLAINED`
/// of the variance of its logarithm, and the logarithm grows by at least `HALF` of its total in each half of the time.
const MIN_GROWTH: f64 = 100.0;
const MIN_EXPLAINED: f64 = 0.9;
const HALF: f64 = 0.3;
/// The distance of the indistinguishable start.
const PERTURBATION: f64 = 1e-9;
/// The maximum number of samples of displayed values.
const SAMPLES: usize = 4000;
/// The work limit.
const WORK: u64 = 3_000_000_000;

/// The largest Lyapunov exponent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exponent {
    /// The mean over the directions, 1/s.
    pub mean: f64,
    /// The smallest exponent.
    pub low: f64,
    /// The largest exponent.
    pub high: f64,
    /// The number of directions.
    pub directions: usize,
}

/// The growth factor of a small initial difference, over the tested directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DivergenceOfStarts {
    /// The smallest growth factor.
    pub low: f64,
    /// The largest growth factor.
    pub high: f64,
}

/// How long the displayed value of a readout is reliable.
#[derive(Clone, Debug, PartialEq)]
pub struct Horizon {
    /// Its label.
    pub label: String,
    /// The time at which its digits change, s; `None` if they do not.
    pub until: Option<f64>,
}

/// The sensitivity of a lab to its initial state.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensitivity {
    /// The length of the runs, s.
    pub length: f64,
    /// The distance of the other start.
    pub distance: f64,
    /// The growth factor; `None` if the lab has no degrees of freedom or a run does not reach its end.
    pub divergence: Option<DivergenceOfStarts>,
    /// The exponent; `None` if the difference does not grow exponentially.
    pub exponent: Option<Exponent>,
    /// The readouts.
    pub horizons: Vec<Horizon>,
}

/// Computes the sensitivity of a lab. The work is added to `work`.
pub(super) fn sensitivity(case: &StressCase<'_>, length: f64, work: &mut u64) -> Sensitivity {
    let all: Vec<Vec<(f64, f64)>> =
        (1..=DIRECTIONS).filter_map(|k| logarithms(case, length, k, work)).collect();
    let whole = all.len() as u64 == DIRECTIONS;
    let least = |list: &[f64]| list.iter().copied().fold(f64::INFINITY, f64::min);
    let most = |list: &[f64]| list.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let ends: Vec<f64> = all.iter().filter_map(|list| list.last()).map(|(_, sum)| *sum).collect();
    let divergence = (whole && !ends.is_empty())
        .then(|| DivergenceOfStarts { low: least(&ends).exp(), high: most(&ends).exp() });
    let slopes: Option<Vec<f64>> = all.iter().map(|list| slope(list)).collect();
    let exponent = slopes.filter(|_| whole).map(|list| Exponent {
        mean: list.iter().sum::<f64>() / list.len() as f64,
        low: least(&list),
        high: most(&list),
        directions: list.len(),
    });
    Sensitivity {
        length,
        distance: PERTURBATION,
        divergence,
        exponent,
        horizons: horizons(case, length, work),
    }
}

/// The slope of a logarithm that grows linearly from the start, 1/s.
fn slope(list: &[(f64, f64)]) -> Option<f64> {
    let (end, whole) = *list.last()?;
    let half = list.iter().find(|(t, _)| *t >= 0.5 * end).map(|(_, sum)| *sum)?;
    let least = HALF * whole;
    if whole < MIN_GROWTH.ln() || half < least || whole - half < least {
        return None;
    }
    let n = list.len() as f64;
    let mean = |function: &dyn Fn(&(f64, f64)) -> f64| list.iter().map(function).sum::<f64>() / n;
    let (t, y) = (mean(&|p| p.0), mean(&|p| p.1));
    let product = |function: &dyn Fn(&(f64, f64)) -> f64| list.iter().map(function).sum::<f64>();
    let tt = product(&|p| (p.0 - t) * (p.0 - t));
    let ty = product(&|p| (p.0 - t) * (p.1 - y));
    let yy = product(&|p| (p.1 - y) * (p.1 - y));
    (ty > 0.0 && ty * ty >= MIN_EXPLAINED * tt * yy).then(|| ty / tt)
}

/// Times, s, with the logarithm of the growth factor of a difference along one direction.
fn logarithms(case: &StressCase<'_>, length: f64, seed: u64, work: &mut u64) -> Option<Vec<(f64, f64)>> {
    let mut first = case.start(&case.base, WORK / 8);
    let nv = first.world.model.nv;
    let h = first.world.model.opt.timestep;
    let steps = case.steps(h, length);
    let each = (steps / TIMES).max(1);
    if nv == 0 || steps == 0 {
        return None;
    }
    let mut second = first.clone();
    separate_runs(&first, &mut second, &direction(seed, 2 * nv), SEPARATION)?;
    let (mut sum, mut made, mut list) = (0.0, 0, Vec::new());
    while made < steps {
        let some = each.min(steps - made);
        let done =
            [&mut first, &mut second].map(|s| run::play(s, &chunk(some), |_, _| ControlFlow::Continue(())));
        made += some;
        let offset = difference(&first, &second)?;
        let size = offset.iter().map(|x| x * x).sum::<f64>().sqrt();
        if done != [some; 2] || !(size.is_finite() && size > 0.0) || warned(&first) || warned(&second) {
            *work += first.spent() + second.spent();
            return None;
        }
        sum += (size / SEPARATION).ln();
        list.push((made as f64 * h, sum));
        let along: Vec<f64> = offset.iter().map(|x| x / size).collect();
        separate_runs(&first, &mut second, &along, SEPARATION)?;
    }
    *work += first.spent() + second.spent();
    Some(list)
}

fn chunk(steps: usize) -> Play<'static> {
    Play { every: steps, ..Play::steps(steps) }
}

fn warned(session: &Session<'_>) -> bool {
    session.warnings.iter().any(|w| w.number > 0)
}

/// A direction of length 1, reproducible for a seed.
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

/// The difference from the first state to the second: positions, then velocities.
fn difference(first: &Session<'_>, second: &Session<'_>) -> Option<Vec<f64>> {
    let m = &first.world.model;
    let [a, b] = [first, second].map(|s| s.world.data.fields());
    let mut list = differentiate_pos(m, 1.0, &a.qpos, &b.qpos).ok()?;
    list.extend(b.qvel.iter().zip(&a.qvel).map(|(b, a)| b - a));
    Some(list)
}

/// Moves the second run to some distance from the first.
fn separate_runs(first: &Session<'_>, second: &mut Session<'_>, along: &[f64], distance: f64) -> Option<()> {
    let from = first.world.data.fields();
    let nv = first.world.model.nv;
    let (places, speeds) = along.split_at_checked(nv)?;
    let mut qpos = from.qpos.to_vec();
    integrate_pos(&first.world.model, &mut qpos, places, distance).ok()?;
    let to = second.world.data.edit();
    to.qpos.copy_from_slice(&qpos);
    to.act.copy_from_slice(&from.act);
    to.qacc_warmstart.copy_from_slice(&from.qacc_warmstart);
    for ((to, from), along) in to.qvel.iter_mut().zip(&from.qvel).zip(speeds) {
        *to = from + distance * along;
    }
    Some(())
}

/// The time at which each readout of a run with a perturbed start differs.
fn horizons(case: &StressCase<'_>, length: f64, work: &mut u64) -> Vec<Horizon> {
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
    let mut sample_readouts = |perturbation: f64| {
        let mut session = case.start(&case.base, WORK / 4);
        if perturbation != 0.0 {
            session.perturb(StepVariant { perturbation, ..StepVariant::NOMINAL }, true);
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
    let (first, between) = sample_readouts(0.0);
    let (second, _) = sample_readouts(PERTURBATION);
    let horizon = |(k, (readout, _)): (usize, &(&Readout, &Bound))| {
        let lost = |(a, b): (&Vec<f64>, &Vec<f64>)| (a[k] - b[k]).abs() > 0.5 * unit(a[k], readout.digits());
        let index = first.iter().zip(&second).position(lost);
        Horizon { label: readout.label.value.clone(), until: index.map(|i| i as f64 * between) }
    };
    readouts.iter().enumerate().map(horizon).collect()
}

/// One unit of the last displayed digit.
fn unit(x: f64, digits: u32) -> f64 {
    let size = x.abs();
    if size > 0.0 && !(1e-3..1e5).contains(&size) {
        return 10f64.powf(size.log10().floor() - 2.0);
    }
    0.1f64.powi(digits as i32)
}
