//! The conserved energy and momentum of a scene, and how much of them a run loses or gains.

use super::run_record::SampledRun;

/// A quantity counts as conserved if the reference changes it by less than this part of its size.
const CONSERVED: f64 = 1e-7;

/// The quantities that the reference conserves, with their sizes.
pub(super) struct Conserved {
    pub(super) energy: Option<f64>,
    pub(super) momentum: [Option<f64>; 2],
}

impl Conserved {
    pub(super) fn measure(run: &SampledRun, part: f64) -> Conserved {
        let moves = run.kinetic > 0.0;
        let energy = (moves && change(&run.energy, part) <= CONSERVED * run.kinetic).then_some(run.kinetic);
        let none = Conserved { energy: None, momentum: [None; 2] };
        let momentum = [0, 1].map(|k| {
            let size = run.momentum.iter().map(|p| length(&p[3 * k..3 * k + 3])).fold(0.0, f64::max);
            (size > 1e-9 && none.change(run, k, part) <= CONSERVED * size).then_some(size)
        });
        Conserved { energy, momentum }
    }

    /// The largest change of momentum since the start: linear (0) or angular (1).
    pub(super) fn change(&self, run: &SampledRun, k: usize, part: f64) -> f64 {
        let Some(start) = run.momentum.first() else { return f64::NAN };
        let change = |p: &[f64; 6]| {
            let d: [f64; 3] = std::array::from_fn(|i| p[3 * k + i] - start[3 * k + i]);
            length(&d)
        };
        largest(run.momentum.iter().take(samples_in_part(run.momentum.len(), part)).map(change))
    }
}

fn length(v: &[f64]) -> f64 {
    v.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// The largest change of a quantity since the start; NaN if it is unknown.
pub(super) fn change(values: &[f64], part: f64) -> f64 {
    let early = values.iter().take(samples_in_part(values.len(), part));
    values.first().map_or(f64::NAN, |start| largest(early.map(|x| (x - start).abs())))
}

/// The maximum; NaN if any value is NaN.
fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |a: f64, x| if x.is_nan() || a.is_nan() { f64::NAN } else { a.max(x) })
}

/// The number of samples in the first part of a run.
fn samples_in_part(all: usize, part: f64) -> usize {
    (all.saturating_sub(1) as f64 * part) as usize + 1
}
