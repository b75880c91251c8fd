//! The timesteps of a comparison, and the samples at which their runs are compared with the reference.

use super::case::PrecisionCase;
use super::report::PrecisionOptions;
use super::setting::{Setting, SolverVariation};
use labspec::run::{self, RunError};
use labspec::run::{INTEGRATORS, Integrator};
use labspec::spec::Lab;

/// The timesteps as multiples of the lab's own; each divides the first. Longer ones are tried while no visible error appears.
const STEPS: [f64; 6] = [4.0, 2.0, 1.0, 0.5, 0.25, 0.125];
/// The maximum number of samples of the reference.
const MOST_SAMPLES: usize = 40_000;
/// The minimum number of steps of a run.
const FEWEST: f64 = 8.0;

/// The timesteps of a lab.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ladder {
    /// The lab's own timestep and integrator.
    pub(super) timestep: f64,
    pub(super) integrator: Integrator,
    /// The longest of the steps that are always tried, as a multiple of the lab's own, and the number of such steps in the run.
    longest: f64,
    pub(super) count: usize,
    length: f64,
}

impl Ladder {
    /// Creates the timesteps for a run of some length, s, all of which divide the length. A short run
    /// begins with shorter steps.
    ///
    /// # Errors
    /// The run is too long, or the runs together are.
    pub(super) fn new(
        lab: &Lab,
        timestep: f64,
        integrator: Integrator,
        length: f64,
    ) -> Result<Ladder, RunError> {
        run::count_steps(lab, Some(length), None, timestep)?;
        let fits = |s: &f64| length >= FEWEST * timestep * s || *s == 1.0;
        let longest = STEPS.into_iter().find(fits).unwrap_or(1.0);
        let count = run::count_steps(lab, Some(length), None, timestep * longest)?.max(1);
        if count as f64 * (longest / STEPS[5]) > run::MAX_STEPS as f64 {
            return Err(RunError::new("the runs would take too many steps; shorten them with --until"));
        }
        Ok(Ladder { timestep, integrator, longest, count, length })
    }

    /// The longest step that is always tried, s.
    pub(super) fn coarse(&self) -> f64 {
        self.timestep * self.longest
    }

    /// The times between samples of the reference, and the numbers of samples.
    pub(super) fn samplings(&self) -> impl Iterator<Item = (f64, usize)> + use<> {
        samplings(self.count, self.longest, self.timestep)
    }

    /// Twice the step, if the run has enough of these steps and every press is between two of them.
    pub(super) fn longer(&self, step: f64, case: &PrecisionCase<'_>) -> Option<f64> {
        let next = 2.0 * step;
        let meets = |(_, time): &(usize, f64)| (time / next - (time / next).round()).abs() < 1e-6;
        (self.length >= FEWEST * next * (1.0 - 1e-9) && case.presses.iter().all(meets)).then_some(next)
    }

    /// Whether a setting is the lab's own.
    pub(super) fn is_own(&self, setting: &Setting) -> bool {
        setting.solver.is_none() && setting.integrator == self.integrator && setting.timestep == self.timestep
    }

    /// The settings to compare: each integrator with all timesteps, then the solver settings at the lab's own timestep.
    pub(super) fn settings(&self, options: &PrecisionOptions) -> Vec<Setting> {
        let named = match options.integrators.as_slice() {
            [] => INTEGRATORS.into_iter().filter(|i| i.shared).collect(),
            some => some.to_vec(),
        };
        let (timestep, longest) = (self.timestep, self.longest);
        let steps = |integrator: Integrator| {
            let steps = STEPS.into_iter().filter(move |s| *s <= longest);
            steps.map(move |s| Setting { integrator, timestep: s * timestep, solver: None })
        };
        let mut list: Vec<Setting> = named.into_iter().flat_map(steps).collect();
        let setting = Setting { integrator: self.integrator, timestep, solver: None };
        if !list.contains(&setting) {
            list.push(setting);
        }
        let solver = |s: SolverVariation| Setting { solver: Some(s), ..setting };
        list.extend(options.axes.iter().flat_map(|axis| axis.values()).map(solver));
        list
    }
}

/// The times between samples of the reference, s, and the numbers of samples. The first is the shortest timestep, so that each
/// run is compared after every step; longer ones follow, for labs that are too long, or whose reference needs too much work.
fn samplings(count: usize, longest: f64, timestep: f64) -> impl Iterator<Item = (f64, usize)> {
    let number = move |step: f64| count * (longest / step) as usize;
    let few = move |step: &f64| number(*step) <= MOST_SAMPLES || *step == longest;
    let mut steps: Vec<f64> = STEPS.into_iter().rev().filter(|s| *s <= longest).filter(few).collect();
    // The reference has at least one sample per step of the lab.
    let useful = steps.iter().filter(|s| **s <= 1.0).count().max(1);
    steps.truncate(useful);
    steps.into_iter().map(move |step| {
        let stride = number(step).div_ceil(MOST_SAMPLES).max(1);
        (timestep * step * stride as f64, number(step).div_ceil(stride))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// All steps of a comparison meet all samples of its reference, or all of their own samples.
        #[test]
        fn steps_meet_the_samples(count in 1usize..3_000_000, longest in prop::sample::select(&STEPS[..3]), timestep in 1e-5..0.1f64) {
            let mut before = 0.0;
            for (interval, number) in samplings(count, longest, timestep) {
                prop_assert!(interval > before && (1..=MOST_SAMPLES).contains(&number));
                prop_assert!(interval * number as f64 >= 0.999_999 * timestep * longest * count as f64);
                for step in STEPS.into_iter().filter(|s| *s <= longest) {
                    let ratio = (timestep * step / interval).max(interval / (timestep * step));
                    prop_assert!((ratio - ratio.round()).abs() < 1e-9, "{interval} {step}");
                }
                before = interval;
            }
            prop_assert!(before > 0.0);
        }
    }
}
