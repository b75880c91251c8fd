//! The cost of a setting: the work of its whole run as counted by the engine, which is the same on every machine and
//! decides; and the time of its steps, measured repeatedly in alternation with all other settings, so that disturbances of
//! the machine affect all of them.

use super::case::PrecisionCase;
use super::setting::Setting;
use labspec::interrupt;
use std::time::{Duration, Instant};

/// The cost of a simulated second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RunCost {
    /// The median of the repetitions, µs of run time; NaN if nothing was measured.
    pub median: f64,
    /// The first quartile of the repetitions.
    pub low: f64,
    /// The third quartile of the repetitions.
    pub high: f64,
    /// The work of the whole run as counted by the engine, including that of its integrator, in units of about a nanosecond. It
    /// is the same on every machine, and decides.
    pub work: f64,
}

impl RunCost {
    /// The cost with this work and without a measured time.
    pub(super) fn of_work(work: f64) -> RunCost {
        RunCost { median: f64::NAN, low: f64::NAN, high: f64::NAN, work }
    }
}

/// Limits on the repetitions of the whole run: the largest number, the smallest number if they take longer than `LONG` in
/// total, and the time after which there are no more repetitions.
const MOST_REPEATS: usize = 5;
const FEWEST_REPEATS: usize = 3;
const LONG: Duration = Duration::from_millis(100);
const TOO_LONG: Duration = Duration::from_secs(1);
/// A short run is repeated until one repetition takes this time. The first run warms the caches and does not count.
const LONG_ENOUGH: Duration = Duration::from_millis(2);
/// The maximum time of a repetition including the starts of its runs, which are not measured.
const WITH_STARTS: Duration = Duration::from_millis(10);

/// The median and the quartiles of the time of each setting's whole run, µs per simulated second; NaN if a
/// setting is not measured.
pub(super) fn measure(case: &PrecisionCase<'_>, settings: &[Option<Setting>]) -> Vec<[f64; 3]> {
    let mut times: Vec<Vec<f64>> = vec![Vec::new(); settings.len()];
    let mut spent = vec![Duration::ZERO; settings.len()];
    for k in 0..MOST_REPEATS {
        for ((setting, times), spent) in settings.iter().zip(&mut times).zip(&mut spent) {
            if interrupt::requested() {
                break;
            }
            if *spent > TOO_LONG || k >= FEWEST_REPEATS && *spent > LONG {
                continue;
            }
            let clock = Instant::now();
            if let Some(time) = setting.as_ref().and_then(|s| repeat(case, s)) {
                times.push(time);
            }
            *spent += clock.elapsed();
        }
    }
    let middle = |mut times: Vec<f64>| {
        times.sort_by(f64::total_cmp);
        let time_at = |i: usize| times.get(i).copied().unwrap_or(f64::NAN);
        let n = times.len();
        [time_at(n / 2), time_at(n / 4), time_at((3 * n) / 4)]
    };
    times.into_iter().map(middle).collect()
}

/// Performs one repetition.
fn repeat(case: &PrecisionCase<'_>, setting: &Setting) -> Option<f64> {
    let (first, steps) = whole_run(case, setting)?;
    let (mut time, mut made) = (first, steps);
    if first < LONG_ENOUGH {
        (time, made) = (Duration::ZERO, 0);
        let clock = Instant::now();
        while made == 0 || time < LONG_ENOUGH && clock.elapsed() < WITH_STARTS {
            let (more, steps) = whole_run(case, setting)?;
            (time, made) = (time + more, made + steps);
        }
    }
    Some(1e6 * time.as_secs_f64() / (made as f64 * setting.timestep))
}

/// The time of all steps of a run, and their number.
fn whole_run(case: &PrecisionCase<'_>, setting: &Setting) -> Option<(Duration, usize)> {
    let mut session = case.start(Some(setting)).ok()?;
    let mut pending = case.presses.as_slice();
    let sampling_plan = case.sampling_plan(setting.timestep);
    let steps = sampling_plan.count * sampling_plan.steps;
    let clock = Instant::now();
    let mut made = 0;
    while made < steps && session.ended().is_none() {
        session.press_due(&mut pending);
        session.step();
        made += 1;
    }
    (made > 0).then(|| (clock.elapsed(), made))
}
