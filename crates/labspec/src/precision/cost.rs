//! What a setting costs: the time of its steps alone, measured again and again in turn with all others, so that what else the
//! machine does meets them all.

use super::case::Case;
use super::setting::Setting;
use crate::interrupt;
use std::time::{Duration, Instant};

/// Microseconds per simulated second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cost {
    /// The middle of the repeats; NaN where nothing was measured.
    pub median: f64,
    /// A quarter of the repeats is quicker than this,
    pub low: f64,
    /// and a quarter slower than this.
    pub high: f64,
    /// The same work as the engine counts it, in units of about a nanosecond: the same on every machine.
    pub work: f64,
}

const REPEATS: usize = 5;
/// A repeat ends after this time.
const LONG_ENOUGH: Duration = Duration::from_millis(4);
/// Steps between two looks at the clock.
const CHUNK: usize = 32;

/// Median and quartiles of the time of each setting, µs per simulated second; NaN where a setting is not to be measured.
pub(super) fn measure(case: &Case<'_>, settings: &[Option<Setting>]) -> Vec<[f64; 3]> {
    let mut times: Vec<Vec<f64>> = vec![Vec::new(); settings.len()];
    for _ in 0..REPEATS {
        for (setting, times) in settings.iter().zip(&mut times) {
            if interrupt::requested() {
                break;
            }
            if let Some(time) = setting.as_ref().and_then(|s| repeat(case, s)) {
                times.push(time);
            }
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

fn repeat(case: &Case<'_>, setting: &Setting) -> Option<f64> {
    let mut session = case.start(Some(setting)).ok()?;
    let mut pending = case.presses.as_slice();
    let rhythm = case.rhythm(setting.timestep);
    let steps = rhythm.count * rhythm.steps;
    let (clock, mut made) = (Instant::now(), 0);
    while made < steps && (made == 0 || clock.elapsed() < LONG_ENOUGH) {
        let chunk = CHUNK.min(steps - made);
        for _ in 0..chunk {
            session.press_due(&mut pending);
            session.step();
        }
        made += chunk;
    }
    let time = clock.elapsed().as_secs_f64();
    (made > 0).then(|| 1e6 * time / (made as f64 * setting.timestep))
}
