//! Distance of convex bodies by the algorithm of Gilbert, Johnson and Keerthi (*A fast procedure for computing the
//! distance between complex objects in three-dimensional space*, IEEE Journal of Robotics and Automation 4, 1988) on
//! their Minkowski difference a - b, of which only support points are asked for.
//!
//! The nearest point x of the support points found so far is an upper bound. The support point w towards the origin
//! gives a lower one, x·w / |x|: the plane through w across x has all of the difference on its far side.

use super::difference::{Limits, ROUNDING, support};
use super::simplex::Corral;
use super::support::Body;
use crate::math::*;

/// What came out.
#[derive(Clone, Copy, Debug)]
pub(super) struct GjkResult {
    /// Distance, m; zero when the origin is in the difference, `None` when it is larger than asked.
    pub(super) dist: Option<f64>,
    /// The simplex that holds the nearest point.
    pub(super) corral: Corral,
    /// Support points that were asked for.
    pub(super) steps: usize,
}

/// Distance up to `cutoff`.
pub(super) fn distance(a: &mut Body, b: &mut Body, cutoff: f64, limits: Limits) -> GjkResult {
    let towards = unit_vector(sub(b.centre(), a.centre())).0;
    let first = support(a, b, towards);
    let mut found = GjkResult { dist: Some(0.0), corral: Corral::new(first), steps: 1 };
    let mut size = norm(first.point);
    let discrete = a.discrete() && b.discrete();
    while found.steps <= limits.iterations {
        let x = found.corral.point();
        let upper = norm(x);
        found.dist = Some(upper);
        if found.corral.holds_origin() || upper <= ROUNDING * size {
            found.dist = Some(0.0);
            break;
        }
        let new = support(a, b, scale(x, -1.0 / upper));
        found.steps += 1;
        size = size.max(norm(new.point));
        let lower = dot(x, new.point) / upper;
        if lower > cutoff.max(0.0) {
            found.dist = None;
            break;
        }
        // x is as near to the true nearest point as the root of this.
        let error2 = (upper - lower) * upper;
        let accuracy2 = if discrete { 0.0 } else { 0.5 * limits.tolerance * limits.tolerance };
        if error2 <= accuracy2.max(ROUNDING * size * upper) {
            break;
        }
        if discrete && found.corral.vertices().iter().any(|v| v.corners == new.corners) {
            break;
        }
        if !found.corral.admit(new) {
            break;
        }
    }
    found
}
