//! Line search: the exact minimum of the cost along a direction.
//!
//! Along a line the cost is convex and piecewise quadratic, so Newton steps on its derivative, kept inside
//! a bracket, end in a few evaluations.

use crate::math::MINVAL;

/// Cost along the line, relative to its start: value, first and second derivative.
#[derive(Clone, Copy, Debug)]
pub(super) struct Point {
    pub(super) alpha: f64,
    pub(super) cost: f64,
    pub(super) slope: f64,
    pub(super) curvature: f64,
}

impl Point {
    /// Where Newton's method goes from here.
    fn newton(&self) -> f64 {
        // M is positive definite, but a search direction may be so short that its square underflows.
        self.alpha - self.slope / self.curvature.max(f64::MIN_POSITIVE)
    }
}

/// The step that minimizes `eval` to |slope| < `gtol`, in at most `budget` evaluations. 0 when no step
/// lowers the cost.
pub(super) fn minimize(gtol: f64, budget: usize, mut eval: impl FnMut(f64) -> Point) -> f64 {
    let start = eval(0.0);
    let mut left = budget.saturating_sub(1);
    let mut p = eval(start.newton());
    if start.cost < p.cost {
        p = start;
    }
    if p.slope.abs() < gtol {
        return p.alpha;
    }

    // One-sided: Newton steps in the direction of descent until the slope changes sign.
    let direction = if p.slope < 0.0 { 1.0 } else { -1.0 };
    let mut behind = p;
    while p.slope * direction <= -gtol && left > 0 {
        behind = p;
        p = eval(p.newton());
        left -= 1;
        if p.slope.abs() < gtol {
            return p.alpha;
        }
    }
    if left == 0 {
        return p.alpha;
    }

    // Bracketed: slopes of opposite sign at both ends.
    let (mut low, mut high) = if behind.slope < p.slope { (behind, p) } else { (p, behind) };
    while left > 0 {
        let candidates = [low.newton(), high.newton(), 0.5 * (low.alpha + high.alpha)];
        let mut best: Option<Point> = None;
        let mut moved = false;
        for alpha in candidates {
            if left == 0 {
                break;
            }
            left -= 1;
            let c = eval(alpha);
            if c.slope.abs() < gtol && best.is_none_or(|b| c.cost < b.cost) {
                best = Some(c);
            }
            // Tighten the end on whose side the candidate lies.
            if c.slope < 0.0 && c.slope > low.slope {
                (low, moved) = (c, true);
            } else if c.slope > 0.0 && c.slope < high.slope {
                (high, moved) = (c, true);
            }
        }
        if let Some(b) = best {
            return b.alpha;
        }
        if !moved {
            break;
        }
    }
    // Rounding keeps the slope above the tolerance: the better end is as good as it gets.
    let best = if low.cost < high.cost { low } else { high };
    if best.cost < 0.0 || best.alpha.abs() < MINVAL { best.alpha } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Random sums of one-sided quadratics on top of a strictly convex one.
        #[test]
        fn finds_the_minimum(rows in prop::collection::vec((0.01f64..1e4, -2.0f64..2.0, -3.0f64..3.0), 0..12), b in -5.0f64..-0.01) {
            let eval = |alpha: f64| {
                let mut p = Point { alpha, cost: alpha * b + 0.5 * alpha * alpha, slope: b + alpha, curvature: 1.0 };
                for &(d, x, v) in &rows {
                    let (now, then) = (x + alpha * v, x);
                    p.cost -= if then < 0.0 { 0.5 * d * then * then } else { 0.0 };
                    if now < 0.0 {
                        p.cost += 0.5 * d * now * now;
                        p.slope += d * now * v;
                        p.curvature += d * v * v;
                    }
                }
                p
            };
            let alpha = minimize(1e-12, 100, eval);
            let p = eval(alpha);
            let scale: f64 = 1.0 + rows.iter().map(|r| r.0 * r.2 * r.2).sum::<f64>();
            prop_assert!(p.slope.abs() < 1e-9 * scale, "slope {} at {alpha}", p.slope);
        }
    }
}
