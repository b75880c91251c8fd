//! Running state of a curve from sample to sample: its zeros, its area, and its regression line.

/// Running state of a curve from sample to sample.
#[derive(Debug)]
pub(super) struct CurveTrail {
    /// Time and value at the previous sample; NaN before the first one.
    time: f64,
    value: f64,
    /// Whether the last nonzero value was negative.
    below: bool,
    /// The time at which the curve reached zero exactly from below.
    reached: Option<f64>,
    /// First and last time of an upward zero crossing, and the number of crossings.
    first: f64,
    last: f64,
    pub(super) count: usize,
    /// Area under the curve, and the time that it covers.
    pub(super) area: f64,
    covered: f64,
    /// Sign of the last nonzero value; zero when it is unknown.
    side: f64,
    pub(super) line: FittedLine,
}

/// The least-squares line through points: its sums, about the means of the points so far (Welford 1962).
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct FittedLine {
    count: f64,
    mean: [f64; 2],
    /// Sums of (t - t̄)² and (t - t̄)(x - x̄).
    squares: f64,
    products: f64,
}

impl FittedLine {
    pub(super) fn add(&mut self, t: f64, x: f64) {
        self.count += 1.0;
        let [dt, dx] = [t - self.mean[0], x - self.mean[1]];
        self.mean[0] += dt / self.count;
        self.mean[1] += dx / self.count;
        self.squares += dt * (t - self.mean[0]);
        self.products += dt * (x - self.mean[1]);
    }

    pub(super) fn slope(&self) -> f64 {
        if self.squares > 0.0 { self.products / self.squares } else { f64::NAN }
    }
}

impl CurveTrail {
    pub(super) const START: CurveTrail = CurveTrail {
        time: f64::NAN,
        value: f64::NAN,
        below: false,
        reached: None,
        first: f64::NAN,
        last: f64::NAN,
        count: 0,
        area: 0.0,
        covered: 0.0,
        side: 0.0,
        line: FittedLine { count: 0.0, mean: [0.0; 2], squares: 0.0, products: 0.0 },
    };

    /// The time at which the straight line from the previous sample to this one is zero. For a sample of value zero, this
    /// is the time of the sample.
    pub(super) fn zero(&self, time: f64, value: f64) -> Option<f64> {
        if value == 0.0 {
            return Some(time);
        }
        // A reset moves time backwards; there is no crossing across it.
        let passes = self.time < time && self.value * value < 0.0;
        passes.then(|| self.time + (time - self.time) * (self.value / (self.value - value)))
    }

    /// Processes a sample of an oscillation.
    pub(super) fn oscillate(&mut self, time: f64, value: f64) {
        let goes_on = self.time < time;
        if !goes_on || value.is_nan() {
            // The state before a gap or a reset is unknown.
            (self.below, self.reached) = (false, None);
        }
        let zero = self.zero(time, value);
        if value == 0.0 && self.below {
            self.reached = self.reached.or(zero);
        } else if value > 0.0 && self.below {
            if let Some(crossing) = self.reached.or(zero) {
                self.first = if self.count == 0 { crossing } else { self.first };
                (self.last, self.count) = (crossing, self.count + 1);
            }
            (self.below, self.reached) = (false, None);
        } else if value < 0.0 {
            (self.below, self.reached) = (true, None);
        }
        self.remember(time, value);
    }

    /// Counts crossings in both directions. A curve that touches zero and returns does not cross it.
    pub(super) fn pass(&mut self, time: f64, value: f64) {
        if value.is_nan() || self.time > time {
            self.side = 0.0;
        } else if value != 0.0 {
            self.count += usize::from(self.side * value < 0.0);
            self.side = value.signum();
        }
        self.remember(time, value);
    }

    /// Adds the area between the previous sample and this one.
    pub(super) fn add_area(&mut self, time: f64, value: f64) {
        if self.time < time {
            self.area += 0.5 * (self.value + value) * (time - self.time);
            self.covered += time - self.time;
        }
        self.remember(time, value);
    }

    pub(super) fn remember(&mut self, time: f64, value: f64) {
        (self.time, self.value) = (time, value);
    }

    /// Mean time between upward crossings; NaN with fewer than two.
    pub(super) fn period(&self) -> f64 {
        if self.count < 2 { f64::NAN } else { (self.last - self.first) / (self.count - 1) as f64 }
    }

    /// The mean over time; the value itself if there is one sample.
    pub(super) fn mean(&self) -> f64 {
        if self.covered > 0.0 { self.area / self.covered } else { self.value }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn crossing(samples: &[(f64, f64)]) -> f64 {
        let mut trail = CurveTrail::START;
        for &(time, value) in samples {
            if let Some(zero) = trail.zero(time, value) {
                return zero;
            }
            trail.remember(time, value);
        }
        f64::NAN
    }

    fn period(samples: &[(f64, f64)]) -> f64 {
        let mut trail = CurveTrail::START;
        samples.iter().for_each(|&(t, x)| trail.oscillate(t, x));
        trail.period()
    }

    fn mean(samples: &[(f64, f64)]) -> f64 {
        let mut trail = CurveTrail::START;
        samples.iter().for_each(|&(t, x)| trail.add_area(t, x));
        trail.mean()
    }

    #[test]
    fn a_crossing_lies_between_two_samples() {
        assert_eq!(crossing(&[(0.0, 1.0), (1.0, -3.0)]), 0.25);
        assert_eq!(crossing(&[(0.0, -3.0), (1.0, 1.0)]), 0.75);
        // A sample of value zero is a crossing, also at the start.
        assert_eq!(crossing(&[(0.0, 1.0), (1.0, 0.0), (2.0, 1.0)]), 1.0);
        assert_eq!(crossing(&[(0.0, 0.0), (1.0, 1.0)]), 0.0);
        for never in [&[(0.0, 1.0), (1.0, 2.0)][..], &[(0.0, 1.0), (1.0, f64::NAN), (2.0, -1.0)], &[]] {
            assert!(crossing(never).is_nan(), "{never:?}");
        }
        // A reset moves time backwards; there is no crossing between the two samples.
        assert!(crossing(&[(5.0, 1.0), (0.0, -1.0)]).is_nan());
    }

    #[test]
    fn a_period_is_from_upward_passage_to_upward_passage() {
        let saw = |n: usize| -> Vec<(f64, f64)> {
            (0..n).map(|i| (i as f64, [-1.0, 1.0, 1.0, -1.0][i % 4])).collect()
        };
        assert_eq!(period(&saw(9)), 4.0);
        assert!(period(&saw(5)).is_nan());
        // Consecutive zeros count as one crossing, and a touch from below does not count.
        assert_eq!(period(&[(0.0, -1.0), (1.0, 0.0), (2.0, 0.0), (3.0, 1.0), (4.0, -1.0), (5.0, 1.0)]), 3.5);
        assert!(period(&[(0.0, -1.0), (1.0, 0.0), (2.0, -1.0), (3.0, 0.0), (4.0, -1.0)]).is_nan());
        // The state before a gap is unknown.
        assert!(period(&[(0.0, -1.0), (1.0, 1.0), (2.0, -1.0), (3.0, f64::NAN), (4.0, 1.0)]).is_nan());
    }

    #[test]
    fn a_mean_is_over_time() {
        assert_eq!(mean(&[(0.0, 0.0), (1.0, 1.0), (3.0, 1.0)]), 2.5 / 3.0);
        assert_eq!(mean(&[(0.0, 7.0)]), 7.0);
        assert!(mean(&[(0.0, f64::NAN), (1.0, 1.0)]).is_nan() && mean(&[]).is_nan());
    }

    proptest! {
        /// Interpolation locates a zero between two samples with an error of O(h^2); without it the error is h.
        #[test]
        fn the_period_of_a_sine_is_found_between_samples(omega in 1.0f64..20.0, phase in 0.0f64..6.2, h in 1e-4f64..5e-3) {
            let true_period = 2.0 * std::f64::consts::PI / omega;
            let n = (5.2 * true_period / h) as usize;
            let samples: Vec<_> = (0..n).map(|i| i as f64 * h).map(|t| (t, (omega * t + phase).sin())).collect();
            let found = period(&samples);
            // A chord locates a zero of a sine with an error below (omega h)^3 / 15 rad.
            let bound = (omega * h).powi(3) / omega + 1e-12;
            prop_assert!((found - true_period).abs() <= bound, "{} and not {}", found, true_period);
            let first = crossing(&samples);
            let exact = (std::f64::consts::PI - phase).rem_euclid(std::f64::consts::PI) / omega;
            prop_assert!((first - exact).abs() <= bound || (first - exact).abs() > true_period / 2.0 - bound, "{} and not {}", first, exact);
        }
    }
}
