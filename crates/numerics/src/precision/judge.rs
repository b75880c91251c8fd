//! The errors of a run relative to the reference.

use super::agreement::ReferenceSolution;
use super::case::{ComparedNumber, DisplayPrecision, PrecisionCase};
use super::numbers::range;
use super::run_record::{RunStatus, SampledRun};
use labspec::run::printed;

/// The errors of a number in a run, in the unit of the trace.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Errors {
    /// The largest error.
    pub largest: f64,
    /// The time of the largest error, s.
    pub time: f64,
    /// The root mean square error.
    pub rms: f64,
    /// The error at the last sample that is compared.
    pub end: f64,
    /// Whether the error is not larger than the uncertainty of the reference, so that nothing more is known about it.
    pub below: bool,
    /// The observed order: the number of times the error halves when the timestep is halved.
    pub order: Option<f64>,
    /// The largest and the smallest error that a student may see at any sample, given the uncertainty of the reference, in
    /// multiples of the smallest visible error. The value is above one if a readout displays other digits than the truth.
    pub seen: [f64; 2],
    /// The number of samples that are compared.
    pub samples: usize,
    /// The number of samples at which the error is visible.
    pub wrong: usize,
}

impl Errors {
    /// No information.
    const NONE: Errors = Errors {
        largest: f64::NAN,
        time: f64::NAN,
        rms: f64::NAN,
        end: f64::NAN,
        below: false,
        order: None,
        seen: [f64::INFINITY; 2],
        samples: 0,
        wrong: 0,
    };
}

/// The truth of one of the lab's numbers, and what is visible of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Compared {
    /// Its label.
    pub label: String,
    /// Its unit, if known.
    pub unit: Option<String>,
    /// Whether it has a closed form.
    pub closed: bool,
    /// The uncertainty of the reference, where it is used.
    pub uncertain: f64,
    /// The same without rounding errors.
    pub uncertainty: f64,
    /// The largest minus the smallest value in the reference; in the lab's own run if the reference is constant.
    pub range: f64,
    /// The largest invisible error: half a unit of the last digit, or half a pixel of the plot.
    pub invisible_error: f64,
    /// Whether it is a readout.
    pub readout: bool,
    /// The number of decimals of a readout.
    pub(super) digits: u32,
    /// The time until which the two families of the reference agree within a hundredth of the range, s,
    /// if that is before the end.
    pub until: Option<f64>,
    /// The largest magnitude.
    pub(super) size: f64,
    /// Whether it is NaN from the start to the end, so that nothing is compared.
    pub blank: bool,
    /// The number of samples of the reference that are compared.
    pub(super) samples: usize,
}

impl Compared {
    /// Whether anything is compared.
    pub fn is_compared(&self) -> bool {
        self.samples > 1
    }

    /// The largest and the smallest visible error at one sample, if the truth is within `uncertainty` of `exact`, in multiples of
    /// the smallest visible error.
    fn visible_errors(&self, displayed: f64, exact: f64, uncertainty: f64) -> [f64; 2] {
        let error = (displayed - exact).abs();
        let parts = |unit: f64| {
            [error + uncertainty, error - uncertainty]
                .map(|e| if e <= 0.0 { 0.0 } else { e / unit.max(f64::MIN_POSITIVE) })
        };
        if !self.readout {
            return parts(self.invisible_error);
        }
        // Digits: a number within its uncertainty of a rounding boundary may be displayed as either neighbour.
        let slack = uncertainty + DIGITS_ROUND * self.size;
        let print = |x: f64| printed(x, self.digits);
        let (low, current, high) = (print(exact - slack), print(displayed), print(exact + slack));
        let unit = 2.0 * self.invisible_error;
        let [most, least] = parts(unit);
        if !(low..=high).contains(&current) {
            return [1.0 + most, 1.0 + least];
        }
        [
            if uncertainty <= self.invisible_error * MAX_EXACT_UNCERTAINTY { most.min(1.0) } else { most },
            least.min(1.0),
        ]
    }
}

/// A reference counts as known while its uncertainty, which is twice the difference of its families, is below this part of the
/// range, or below `INVISIBLE_FRACTION` times the smallest visible error.
const KNOWN: f64 = 0.02;
const INVISIBLE_FRACTION: f64 = 0.2;
/// A reference with an uncertainty below this part of the smallest visible error counts as exact.
const MAX_EXACT_UNCERTAINTY: f64 = 0.2;
/// The relative rounding error of a number after a run of many steps, and of one that is rounded again for display.
const ROUNDING: f64 = 1e-13;
const DIGITS_ROUND: f64 = 1e-12;
/// A number that changes by less than this part of its size counts as constant.
const CONSTANT: f64 = 1e-6;

/// Determines the truth of all targets of a case; `own_run` is the run with the lab's own setting.
pub(super) fn compared(
    case: &PrecisionCase<'_>,
    reference: &ReferenceSolution,
    own_run: &SampledRun,
) -> Vec<Compared> {
    let one = |(i, target): (usize, &ComparedNumber<'_>)| {
        let closed = target.exact.is_some();
        let values = if closed { &reference.run.exact[i] } else { &reference.values[i] };
        let uncertain = &reference.uncertain[i];
        let whole = values.iter().filter(|x| x.is_finite()).fold(0.0f64, |a, x| a.max(x.abs()));
        // The range of a run that fails is no measure of what is visible in a plot; the range of a run whose
        // number should be constant is.
        let mut range_of = range(values);
        if range_of <= CONSTANT * whole {
            let range_of_run =
                if own_run.status == RunStatus::Good { range(&own_run.values[i]) } else { 0.0 };
            range_of = range_of.max(if range_of_run > 0.0 { range_of_run } else { whole });
        }
        let invisible_error = target.display.invisible_error(range_of);
        let enough = (KNOWN * range_of).max(INVISIBLE_FRACTION * invisible_error).max(ROUNDING);
        let certain = uncertain.partition_point(|u| *u <= enough);
        let blank = values.first().is_none_or(|x| !x.is_finite());
        let samples = match (blank, closed) {
            (true, _) => 0,
            (false, true) => values.len(),
            (false, false) => certain,
        };
        let cut = samples < values.len() && !blank;
        let size = values.iter().take(samples).fold(0.0f64, |a, x| a.max(x.abs()));
        let most = if closed || samples == 0 { 0.0 } else { uncertain[samples - 1] };
        let digits =
            if let DisplayPrecision::Decimals(digits) = target.display { Some(digits) } else { None };
        Compared {
            label: target.label.clone(),
            unit: target.unit.clone(),
            closed,
            size,
            uncertain: most.max(ROUNDING * size),
            uncertainty: most,
            range: range_of,
            invisible_error,
            readout: digits.is_some(),
            digits: digits.unwrap_or(0),
            blank,
            until: cut.then(|| samples.saturating_sub(1) as f64 * case.interval),
            samples,
        }
    };
    case.targets.iter().enumerate().map(one).collect()
}

/// The errors of a run with some timestep, for each target.
pub(super) fn errors(
    case: &PrecisionCase<'_>,
    reference: &ReferenceSolution,
    targets: &[Compared],
    run: &SampledRun,
    timestep: f64,
) -> Vec<Errors> {
    // The time is a sum of this many steps, each of which is rounded.
    let rounding = f64::EPSILON * case.count as f64 * case.interval / timestep;
    let stride = case.sampling_plan(timestep).stride;
    let one = |(i, target): (usize, &Compared)| {
        let (truth, step) = if target.closed { (&run.exact[i], 1) } else { (&reference.values[i], stride) };
        let compared = target.samples.div_ceil(stride).min(run.values[i].len());
        let both = run.values[i].iter().zip(truth.iter().step_by(step)).take(compared);
        let mut e =
            Errors { largest: 0.0, time: 0.0, rms: 0.0, samples: compared, seen: [0.0; 2], ..Errors::NONE };
        for (k, (&displayed, &exact)) in both.enumerate() {
            let d = (displayed - exact).abs();
            if d.is_nan() {
                return Errors::NONE;
            }
            if d > e.largest {
                (e.largest, e.time) = (d, (k * stride) as f64 * case.interval);
            }
            e.rms += d * d;
            e.end = d;
            let uncertainty = match target.closed {
                true => 0.0,
                false => reference.uncertain[i].get(k * stride).copied().unwrap_or(target.uncertainty),
            };
            let [most, least] = target.visible_errors(displayed, exact, uncertainty);
            e.seen = [e.seen[0].max(most), e.seen[1].max(least)];
            e.wrong += usize::from(least > 1.0);
        }
        e.rms = (e.rms / compared.max(1) as f64).sqrt();
        e.below = e.largest <= target.uncertain.max(rounding * target.size);
        // If there is no sample after the start, nothing is known.
        if compared > 1 { e } else { Errors::NONE }
    };
    targets.iter().enumerate().map(one).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn readout(digits: u32, size: f64) -> Compared {
        Compared {
            label: "x".into(),
            unit: None,
            closed: false,
            uncertain: 0.0,
            uncertainty: 0.0,
            range: size,
            invisible_error: 0.5 * 0.1f64.powi(digits as i32),
            readout: true,
            digits,
            until: None,
            size,
            blank: false,
            samples: 2,
        }
    }

    #[test]
    fn digits_decide_at_every_sample() {
        let x = readout(1, 20.0);
        // A difference below half a unit, but other digits.
        assert!(x.visible_errors(16.051, 16.049, 1e-9)[1] > 1.0);
        // A larger difference, but the same digits.
        assert!(x.visible_errors(16.149, 16.051, 1e-9)[0] <= 1.0);
        // Next to a rounding boundary, the digits cannot be distinguished.
        assert!(x.visible_errors(16.05 + 1e-12, 16.05 - 1e-12, 1e-9)[0] <= 1.0);
        // The uncertainty of the reference is larger than one digit.
        let [most, least] = x.visible_errors(16.2, 16.0, 0.3);
        assert!(most > 1.0 && least <= 1.0, "{most} {least}");
    }

    #[test]
    fn a_curve_hides_half_a_pixel() {
        let x = Compared { readout: false, ..readout(1, 20.0) };
        assert_eq!(x.visible_errors(1.0, 1.1, 0.0).map(|p| (p * 10.0).round()), [20.0, 20.0]);
        assert_eq!(x.visible_errors(1.0, 1.01, 0.02)[1], 0.0);
    }
}
