//! The cost of a remedy: the error of the displayed values relative to the motion that the model describes, and the run time.
//!
//! The motion is computed by a method of order four with decreasing timesteps, until two runs agree. If nearby motions diverge
//! exponentially, the runs agree only up to some time, and errors are evaluated up to that time.

use labspec::interrupt;
use labspec::run::{self, Play, Session};
use labspec::stress::{Change, Interaction, StressCase};
use labspec_core::integrator;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

/// The number of samples of a run.
const SAMPLES: usize = 100;
/// Two runs agree if they differ by at most this part of a range.
const MAX_DIFFERENCE: f64 = 1e-3;
/// The divisor of the first shorter timestep, and the number of further reductions, each by [`REFINEMENT`].
const FIRST_DIVISOR: usize = 4;
const REFINEMENT: usize = 4;
const MAX_REFINEMENTS: usize = 3;
/// The work limit for one run.
const WORK: u64 = 500_000_000;
/// The number of repetitions of a time measurement, their minimum length, and the steps between two readings of the clock.
const REPEATS: usize = 5;
const LONG_ENOUGH: Duration = Duration::from_millis(3);
const CHUNK: usize = 32;

/// The displayed numbers of a lab at each sample.
type SampledRows = Vec<Vec<f64>>;

/// The motion that a model describes, for an interaction.
pub(super) struct ReferenceMotion<'h> {
    interaction: &'h Interaction,
    /// The timestep of the lab, s, and the number of steps between samples.
    timestep: f64,
    every: usize,
    rows: SampledRows,
    /// The largest minus the smallest value of each number.
    ranges: Vec<f64>,
}

/// The exact motion over this time, as far as it is known, or `None` if two runs differ from the start. The
/// work is added to `work`.
pub(super) fn truth<'h>(
    case: &StressCase<'_>,
    interaction: &'h Interaction,
    length: f64,
    work: &mut u64,
) -> Option<ReferenceMotion<'h>> {
    let timestep = case.start(interaction, WORK).world.model.opt.timestep;
    let every = (case.steps(timestep, length) / SAMPLES).max(1);
    let fine = |parts: usize, work: &mut u64| {
        let change = move |session: &mut Session<'_>| {
            let opt = session.world.model.edit().opt;
            (*opt.timestep, *opt.integrator) = (timestep / parts as f64, integrator::RK4);
        };
        rows(case, interaction, Some(&change), length, every as f64 * timestep, work)
    };
    let mut parts = FIRST_DIVISOR;
    let mut coarse = fine(parts, work);
    let mut best: Option<(SampledRows, usize)> = None;
    for _ in 0..MAX_REFINEMENTS {
        if interrupt::requested() {
            return None;
        }
        parts *= REFINEMENT;
        let current = fine(parts, work);
        let ranges = ranges(&current);
        let differ =
            |(a, b): (&Vec<f64>, &Vec<f64>)| largest(a, b, &ranges).is_none_or(|x| x > MAX_DIFFERENCE);
        let agreeing =
            coarse.iter().zip(&current).position(differ).unwrap_or(coarse.len().min(current.len()));
        let whole = agreeing == current.len();
        if best.as_ref().is_none_or(|(_, before)| agreeing > *before) {
            best = Some((current.clone(), agreeing));
        }
        if whole {
            break;
        }
        coarse = current;
    }
    let (mut rows, agreeing) = best?;
    rows.truncate(agreeing);
    (agreeing > 1).then(|| ReferenceMotion { interaction, timestep, every, ranges: ranges(&rows), rows })
}

/// The largest error of any displayed number with a change, relative to its range, or `None` if a number is NaN.
pub(super) fn error(
    case: &StressCase<'_>,
    truth: &ReferenceMotion<'_>,
    change: Change<'_>,
    work: &mut u64,
) -> Option<f64> {
    let between = truth.every as f64 * truth.timestep;
    let length = between * (truth.rows.len() - 1) as f64;
    let seen = rows(case, truth.interaction, Some(change), length, between, work);
    let errors = seen.iter().zip(&truth.rows).map(|(a, b)| largest(a, b, &truth.ranges));
    let all: Option<Vec<f64>> = errors.collect();
    all.filter(|_| seen.len() >= truth.rows.len()).map(|list| list.into_iter().fold(0.0, f64::max))
}

/// The displayed numbers, or the joint positions if none are displayed, at the start and after each
/// `between` seconds, up to a fault.
fn rows(
    case: &StressCase<'_>,
    interaction: &Interaction,
    change: Option<Change<'_>>,
    length: f64,
    between: f64,
    work: &mut u64,
) -> SampledRows {
    let mut session = case.start(interaction, WORK);
    if let Some(change) = change {
        change(&mut session);
        session.refresh();
    }
    let timestep = session.world.model.opt.timestep;
    let (steps, every) = (case.steps(timestep, length), (between / timestep).round().max(1.0) as usize);
    let presses: Vec<(usize, f64)> = interaction
        .actions
        .iter()
        .filter(|a| a.time > 0.0 && a.value.is_none())
        .map(|a| (a.control, a.time))
        .collect();
    let mut list: SampledRows = Vec::new();
    let played = Play { steps, stop: None, every, presses: &presses, watched: false };
    run::play(&mut session, &played, |session, made| {
        let late = (session.world.data.time() - made as f64 * timestep).abs() > 0.5 * timestep;
        if late || session.warnings.iter().any(|w| w.number > 0) {
            return ControlFlow::Break(());
        }
        if made.is_multiple_of(every) {
            list.push(displayed_numbers(case, session));
        }
        ControlFlow::Continue(())
    });
    *work += session.spent();
    list
}

fn displayed_numbers(case: &StressCase<'_>, session: &mut Session<'_>) -> Vec<f64> {
    let probes = case.programs.probes.iter().filter_map(|p| p.bound.as_ref());
    let values = probes.filter_map(|b| session.evaluate(&b.program, &b.text));
    let numbers: Vec<f64> = values.map(|v| v.to_number()).filter(|x| x.is_finite()).collect();
    if numbers.is_empty() { session.world.data.fields().qpos.to_vec() } else { numbers }
}

/// The largest minus the smallest value of each number.
fn ranges(rows: &SampledRows) -> Vec<f64> {
    let width = rows.first().map_or(0, Vec::len);
    let value_at = |k: usize| {
        let column = || rows.iter().filter_map(|row| row.get(k)).copied();
        column().fold(f64::NEG_INFINITY, f64::max) - column().fold(f64::INFINITY, f64::min)
    };
    (0..width).map(value_at).collect()
}

/// The largest difference of two rows relative to the ranges, or `None` if the rows have different lengths.
fn largest(a: &[f64], b: &[f64], ranges: &[f64]) -> Option<f64> {
    let part = |((a, b), range): ((&f64, &f64), &f64)| if *range > 0.0 { (a - b).abs() / range } else { 0.0 };
    let most = a.iter().zip(b).zip(ranges).map(part).fold(0.0, f64::max);
    (a.len() == ranges.len() && b.len() == ranges.len()).then_some(most)
}

/// The run time of a simulated second with a change, relative to that of the unchanged lab, measured in alternation.
pub(super) fn time(case: &StressCase<'_>, interaction: &Interaction, change: Change<'_>, length: f64) -> f64 {
    let mut ratios = Vec::new();
    while ratios.len() < REPEATS && !interrupt::requested() {
        let base = seconds(case, &case.base, &|_| {}, length);
        ratios.push(seconds(case, interaction, change, length) / base);
    }
    ratios.sort_by(f64::total_cmp);
    ratios.get(ratios.len() / 2).copied().unwrap_or(f64::NAN)
}

/// The run time of one simulated second in seconds.
fn seconds(case: &StressCase<'_>, interaction: &Interaction, change: Change<'_>, length: f64) -> f64 {
    let mut session = case.start(interaction, WORK);
    change(&mut session);
    session.refresh();
    let timestep = session.world.model.opt.timestep;
    let steps = case.steps(timestep, length);
    let (clock, mut made) = (Instant::now(), 0);
    while made < steps && (made == 0 || clock.elapsed() < LONG_ENOUGH) {
        let chunk = CHUNK.min(steps - made);
        (0..chunk).for_each(|_| session.step());
        made += chunk;
    }
    clock.elapsed().as_secs_f64() / (made as f64 * timestep)
}
