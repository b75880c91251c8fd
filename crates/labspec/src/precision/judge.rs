//! Errors of a run against the reference, and the orders that they show.

use super::case::{Case, Run};
use super::reference::{Reference, range};

/// How far a run is from the truth, in the unit of the trace.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Errors {
    /// The largest error, and when, s.
    pub largest: f64,
    /// When that was.
    pub at: f64,
    /// Root of the mean square.
    pub rms: f64,
    /// At the last sample that is compared.
    pub end: f64,
    /// It is not above what the reference itself may be off: nothing more is known of it.
    pub below: bool,
    /// Observed order: how many times the error halves when the timestep halves.
    pub order: Option<f64>,
}

impl Errors {
    /// Nothing is known.
    const NONE: Errors =
        Errors { largest: f64::NAN, at: f64::NAN, rms: f64::NAN, end: f64::NAN, below: false, order: None };
}

/// What one of the lab's numbers is held against.
#[derive(Clone, Debug, PartialEq)]
pub struct Compared {
    /// Its label.
    pub label: String,
    /// It has a closed form.
    pub closed: bool,
    /// How far the reference may be off, where it is used.
    pub uncertain: f64,
    /// The same for the error that counts: of digits, at the end.
    pub doubt: f64,
    /// Largest value less smallest, in the reference or as the lab has it, whichever is more.
    pub range: f64,
    /// The largest error that nobody sees: half a unit of the last digit, half a pixel of the plot.
    pub unseen: f64,
    /// Whether it is a readout.
    pub readout: bool,
    /// Until when the two families of the reference agree to a hundredth of the range, s, where that is not the end.
    pub until: Option<f64>,
    /// The largest value.
    pub(super) size: f64,
    /// It is no number at the start, nor anywhere: nothing is compared.
    pub blank: bool,
    /// The samples of the truth that are compared.
    pub(super) samples: usize,
}

impl Compared {
    /// The error that counts: of a curve the largest, of digits that of the end, when they stand still to be read.
    pub fn counts(&self, errors: &Errors) -> f64 {
        if self.readout { errors.end } else { errors.largest }
    }

    /// Whether anything is compared.
    pub fn is_compared(&self) -> bool {
        self.samples > 1
    }

    /// The largest and the smallest that the error may be, as the reference itself is in doubt; in times of what nobody sees. A
    /// number that is not there where the reference has one is wrong beyond all bounds.
    pub(super) fn in_sight(&self, errors: &Errors) -> [f64; 2] {
        let error = self.counts(errors);
        if error.is_nan() {
            return [f64::INFINITY; 2];
        }
        // A number that does not change is shown rightly by all.
        [error + self.doubt, error - self.doubt]
            .map(|e| if e <= 0.0 { 0.0 } else { e / self.unseen.max(f64::MIN_POSITIVE) })
    }
}

/// The two families of a reference have to agree to this part of the range, or of what nobody sees.
const KNOWN: f64 = 0.01;
const UNSEEN: f64 = 0.1;
/// The last part of the samples: an nth.
const LATE: usize = 10;
/// What rounding leaves of a number in a run of many steps.
const ROUNDING: f64 = 1e-13;

/// What the targets of a case are held against; `own` is the run as the lab has it.
pub(super) fn compared(case: &Case<'_>, reference: &Reference, own: &Run) -> Vec<Compared> {
    let one = |(i, target): (usize, &super::case::Target<'_>)| {
        let closed = target.exact.is_some();
        let values = if closed { &reference.run.exact[i] } else { &reference.values[i] };
        let uncertain = &reference.uncertain[i];
        let range = range(values).max(range(&own.values[i]));
        let unseen = target.shown.unseen(range);
        let enough = (KNOWN * range).max(UNSEEN * unseen).max(ROUNDING);
        let known = uncertain.partition_point(|u| *u <= enough);
        let blank = values.first().is_none_or(|x| !x.is_finite());
        let samples = if blank {
            0
        } else if closed {
            values.len()
        } else {
            known
        };
        let cut = samples < values.len() && !blank;
        let size = values.iter().take(samples).fold(0.0f64, |a, x| a.max(x.abs()));
        let readout = matches!(target.shown, super::case::Shown::Decimals(_));
        let most = if closed || samples == 0 { 0.0 } else { uncertain[samples - 1] };
        // Families that meet at the last sample by chance do not meet for so long.
        let late = samples - samples.div_ceil(LATE);
        let at_end = reference.apart[i][late..samples].iter().fold(0.0, |a: f64, x| a.max(*x));
        Compared {
            label: target.label.clone(),
            closed,
            size,
            uncertain: most.max(ROUNDING * size),
            doubt: if closed {
                0.0
            } else if readout {
                at_end
            } else {
                most
            },
            range,
            unseen,
            readout,
            blank,
            until: cut.then(|| samples.saturating_sub(1) as f64 * case.interval),
            samples,
        }
    };
    case.targets.iter().enumerate().map(one).collect()
}

/// The errors of a run with some timestep, target by target.
pub(super) fn errors(
    case: &Case<'_>,
    reference: &Reference,
    targets: &[Compared],
    run: &Run,
    timestep: f64,
) -> Vec<Errors> {
    // Time itself is a sum of so many steps, each rounded.
    let rounding = f64::EPSILON * case.count as f64 * case.interval / timestep;
    let stride = case.rhythm(timestep).stride;
    let one = |(i, target): (usize, &Compared)| {
        let (truth, apart) = if target.closed { (&run.exact[i], 1) } else { (&reference.values[i], stride) };
        let compared = target.samples.div_ceil(stride);
        let both = run.values[i].iter().zip(truth.iter().step_by(apart)).take(compared);
        let differences = both.map(|(a, b)| (a - b).abs());
        let mut e = Errors { largest: 0.0, at: 0.0, rms: 0.0, end: f64::NAN, below: false, order: None };
        for (k, d) in differences.enumerate() {
            if d.is_nan() {
                return Errors::NONE;
            }
            if d > e.largest {
                (e.largest, e.at) = (d, (k * stride) as f64 * case.interval);
            }
            e.rms += d * d;
            e.end = d;
        }
        e.rms = (e.rms / compared.max(1) as f64).sqrt();
        e.below = e.largest <= (2.0 * target.uncertain).max(rounding * target.size);
        // Of a run that is looked at only after that nothing is known.
        if compared > 1 { e } else { Errors::NONE }
    };
    targets.iter().enumerate().map(one).collect()
}

/// The observed order of a run with a shorter timestep than another: there is none where the doubt of the reference is a part of
/// the error.
pub(super) fn order(coarse: &Errors, fine: &Errors, ratio: f64, doubt: f64) -> Option<f64> {
    let order = (coarse.largest / fine.largest).log2() / ratio.log2();
    (!coarse.below && !fine.below && fine.largest > 10.0 * doubt && order.is_finite()).then_some(order)
}
