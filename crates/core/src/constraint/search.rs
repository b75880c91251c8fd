//! Line search: the exact minimum of the cost along a direction.
//!
//! Along a line the cost is convex and piecewise quadratic, so Newton steps on its derivative, kept inside
//! a bracket, end in a few evaluations.

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

/// One side of the minimum, and where Newton's method goes from there.
struct End {
    at: Point,
    next: Point,
}

impl End {
    /// Moves to the nearest of the candidates on the same side; `false` when there is none nearer.
    fn tighten(&mut self, candidates: &[Point; 3], eval: &mut impl FnMut(f64) -> Point) -> bool {
        let before = self.at.slope;
        for c in candidates {
            let nearer = self.at.slope.abs() > c.slope.abs() && c.slope != 0.0;
            if nearer && (c.slope < 0.0) == (before < 0.0) && before != 0.0 {
                self.at = *c;
            }
        }
        let moved = self.at.slope != before;
        if moved {
            self.next = eval(self.at.newton());
        }
        moved
    }
}

/// The step that minimizes `eval` to |slope| < `gtol`, in about `budget` evaluations: the search ends where it would
/// begin another round. 0 when no step lowers the cost.
pub(super) fn minimize(gtol: f64, budget: usize, mut eval: impl FnMut(f64) -> Point) -> f64 {
    let start = eval(0.0);
    let mut p = eval(start.newton());
    if p.slope.abs() < gtol {
        return p.alpha;
    }

    // One-sided: Newton steps in the direction of descent until the slope changes sign.
    let direction = if p.slope < 0.0 { 1.0 } else { -1.0 };
    let mut behind = start;
    let mut used = 2;
    while p.slope * direction <= -gtol && used < budget {
        behind = p;
        p = eval(p.newton());
        used += 1;
        if p.slope.abs() < gtol {
            return p.alpha;
        }
    }
    if used >= budget {
        return p.alpha;
    }

    // Bracketed: slopes of opposite sign at both ends. The one behind has been where its Newton step leads.
    let mut ends = [End { at: p, next: eval(p.newton()) }, End { at: behind, next: p }];
    used += 1;
    while used < budget {
        let middle = eval(0.5 * (ends[0].at.alpha + ends[1].at.alpha));
        used += 1;
        let candidates = [ends[0].next, ends[1].next, middle];
        let flat = candidates.iter().filter(|c| c.slope.abs() < gtol);
        if let Some(best) = flat.min_by(|a, b| a.cost.total_cmp(&b.cost)) {
            return best.alpha;
        }
        let moved = ends.each_mut().map(|end| usize::from(end.tighten(&candidates, &mut eval)));
        used += moved[0] + moved[1];
        if moved == [0, 0] {
            // Rounding keeps the slope above the tolerance.
            return middle.alpha;
        }
    }
    let best = if ends[0].at.cost <= ends[1].at.cost { ends[0].at } else { ends[1].at };
    if best.cost < start.cost { best.alpha } else { 0.0 }
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
