//! Line search: the minimum of the cost along a direction.
//!
//! Along a line the cost is convex, and quadratic between the points where a row changes its state. Its slope is
//! increasing and piecewise linear (slightly curved where a contact slides on an elliptic cone). The minimum is the
//! zero of the slope. Newton's method finds it in one step from any point on the same linear piece. A bracket, which
//! every evaluation narrows, prevents the iteration from alternating between two pieces (safeguarded steps: Nocedal,
//! Wright, Numerical Optimization, section 3.5).

/// Cost along the line, relative to its start: value, first and second derivative.
#[derive(Clone, Copy, Debug)]
pub(super) struct Point {
    pub(super) alpha: f64,
    pub(super) cost: f64,
    pub(super) slope: f64,
    pub(super) curvature: f64,
}

impl Point {
    /// The zero of the tangent of the slope.
    fn newton(&self) -> f64 {
        // M is positive definite, but a search direction may be so short that its square underflows.
        self.alpha - self.slope / self.curvature.max(f64::MIN_POSITIVE)
    }
}

/// The points nearest to the minimum on both sides: the slope is negative at the lower one, and not negative at the
/// upper one.
#[derive(Default)]
struct Bracket {
    falls: Option<Point>,
    rises: Option<Point>,
}

impl Bracket {
    fn narrow(&mut self, p: Point) {
        let end = if p.slope < 0.0 { &mut self.falls } else { &mut self.rises };
        *end = Some(p);
    }

    /// The next point to evaluate after `last`. Returns `None` if rounding leaves no point between the ends.
    fn next(&self, last: &Point, halve: bool) -> Option<f64> {
        let tangent = last.newton();
        let (Some(low), Some(high)) = (&self.falls, &self.rises) else { return Some(tangent) };
        let inside = |x: &f64| low.alpha < *x && *x < high.alpha;
        // Alternatives: the tangent at the other end, which is exact if the minimum is on its piece, and the chord
        // between both ends.
        let other = if last.slope < 0.0 { high.newton() } else { low.newton() };
        let chord = low.alpha - low.slope * (high.alpha - low.alpha) / (high.slope - low.slope);
        let middle = 0.5 * (low.alpha + high.alpha);
        let places = if halve { [middle; 3] } else { [tangent, other, chord] };
        places.into_iter().find(inside).or(Some(middle).filter(inside))
    }

    fn width(&self) -> f64 {
        match (&self.falls, &self.rises) {
            (Some(low), Some(high)) => high.alpha - low.alpha,
            _ => f64::INFINITY,
        }
    }

    /// The end with the lower cost.
    fn lower(&self) -> Option<Point> {
        let ends = self.falls.into_iter().chain(self.rises);
        ends.min_by(|a, b| a.cost.total_cmp(&b.cost))
    }
}

/// The step length that minimizes `eval` to |slope| < `gtol`, starting from an evaluated point. It uses at most
/// `budget` evaluations including the start, but at least two. Returns 0 if no step lowers the cost.
pub(super) fn minimize(gtol: f64, budget: usize, start: Point, mut eval: impl FnMut(f64) -> Point) -> f64 {
    let mut bracket = Bracket::default();
    let (mut last, mut halve) = (start, false);
    for _ in 1..budget.max(2) {
        bracket.narrow(last);
        // The search ends if the step is not finite, or too small to change α.
        let next = bracket.next(&last, halve).filter(|alpha| alpha.is_finite() && *alpha != last.alpha);
        let Some(alpha) = next else { break };
        let width = bracket.width();
        last = eval(alpha);
        if last.slope.abs() < gtol {
            return last.alpha;
        }
        // A step that leaves more than half of the bracket is followed by a bisection.
        let left = match (last.slope < 0.0, &bracket.falls, &bracket.rises) {
            (true, _, Some(high)) => high.alpha - last.alpha,
            (false, Some(low), _) => last.alpha - low.alpha,
            _ => f64::INFINITY,
        };
        halve = !halve && left > 0.5 * width && width.is_finite();
    }
    bracket.narrow(last);
    bracket.lower().filter(|p| p.cost < start.cost).map_or(0.0, |p| p.alpha)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The search also terminates with an unlimited budget.
    #[test]
    fn nan_ends_the_search() {
        for (slope, curvature) in [(f64::NAN, 1.0), (-1.0, f64::NAN), (-1.0, 0.0), (f64::NEG_INFINITY, 1.0)] {
            let mut n = 0;
            let mut eval = |alpha| {
                n += 1;
                assert!(n < 100);
                Point { alpha, cost: 0.0, slope, curvature }
            };
            let start = eval(0.0);
            assert_eq!(minimize(1e-12, usize::MAX, start, eval), 0.0);
        }
    }

    proptest! {
        /// Random sums of one-sided quadratic functions plus a strictly convex one.
        #[test]
        fn finds_the_minimum(rows in prop::collection::vec((0.01f64..1e4, -2.0f64..2.0, -3.0f64..3.0), 0..12), b in -5.0f64..-0.01) {
            let eval = |alpha: f64| {
                let mut p = Point { alpha, cost: alpha * b + 0.5 * alpha * alpha, slope: b + alpha, curvature: 1.0 };
                for &(d, x, v) in &rows {
                    let (current, then) = (x + alpha * v, x);
                    p.cost -= if then < 0.0 { 0.5 * d * then * then } else { 0.0 };
                    if current < 0.0 {
                        p.cost += 0.5 * d * current * current;
                        p.slope += d * current * v;
                        p.curvature += d * v * v;
                    }
                }
                p
            };
            let alpha = minimize(1e-12, 100, eval(0.0), eval);
            let p = eval(alpha);
            let scale: f64 = 1.0 + rows.iter().map(|r| r.0 * r.2 * r.2).sum::<f64>();
            prop_assert!(p.slope.abs() < 1e-9 * scale, "slope {} at {alpha}", p.slope);
        }
    }
}
