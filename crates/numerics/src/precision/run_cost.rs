//! What a setting costs: the work of its whole run as the engine counts it, which is the same everywhere and decides; and the time of
//! its steps, measured again and again in turn with all others, so that what else the machine does meets them all.

use super::case::PrecisionCase;
use super::setting::Setting;
use labspec::interrupt;
use std::time::{Duration, Instant};

/// What a simulated second costs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RunCost {
    /// The middle of the repeats, µs of run time; NaN where nothing was measured.
    pub median: f64,
    /// A quarter of the repeats is quicker than this,
    pub low: f64,
    /// and a quarter slower than this.
    pub high: f64,
    /// The work of the whole run as the engine counts it, with what its integrator adds, in units of about a nanosecond: the same on
    /// every machine. It decides.
    pub work: f64,
}

impl RunCost {
    /// Work whose time is not measured.
    pub(super) fn of_work(work: f64) -> RunCost {
        RunCost { median: f64::NAN, low: f64::NAN, high: f64::NAN, work }
    }
}

/// Repeats of the whole run: so many, fewer where they take longer than this in all, and not another one where they took that long.
const MOST_REPEATS: usize = 5;
const FEWEST_REPEATS: usize = 3;
const LONG: Duration = Duration::from_millis(100);
const TOO_LONG: Duration = Duration::from_secs(1);
/// A short run is made again until the runs of a repeat took this time; the first, in which nothing is at hand yet, does not count.
const LONG_ENOUGH: Duration = Duration::from_millis(2);
/// With the starts of these runs, which are not measured, a repeat takes no longer than this.
const WITH_STARTS: Duration = Duration::from_millis(10);

/// Median and quartiles of the time of each setting's whole run, µs per simulated second; NaN where a setting is not to be measured.
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
        let at = |i: usize| times.get(i).copied().unwrap_or(f64::NAN);
        let n = times.len();
        [at(n / 2), at(n / 4), at((3 * n) / 4)]
    };
    times.into_iter().map(middle).collect()
}

/// One repeat.
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
    let rhythm = case.rhythm(setting.timestep);
    let steps = rhythm.count * rhythm.steps;
    let clock = Instant::now();
    let mut made = 0;
    while made < steps && session.ended().is_none() {
        session.press_due(&mut pending);
        session.step();
        made += 1;
    }
    (made > 0).then(|| (clock.elapsed(), made))
}
