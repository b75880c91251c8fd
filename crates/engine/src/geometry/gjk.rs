//! Distance of convex bodies by the algorithm of Gilbert, Johnson and Keerthi (*A fast procedure for computing the
//! distance between complex objects in three-dimensional space*, IEEE Journal of Robotics and Automation 4, 1988). It
//! uses only support points of the Minkowski difference a - b.
//!
//! The distance of the nearest point x in the hull of the support points found so far is an upper bound. The support
//! point w towards the origin gives a lower bound, x·w / |x|, because the whole difference is on the far side of the
//! plane through w normal to x.

use super::difference::{Limits, ROUNDING, support};
use super::simplex::Corral;
use super::support::ConvexBody;
use crate::math::*;

/// The result of the search.
#[derive(Clone, Copy, Debug)]
pub(super) struct GjkResult {
    /// Distance, m; zero if the difference contains the origin, `None` if the distance is larger than `cutoff`.
    pub(super) dist: Option<f64>,
    /// The simplex that contains the nearest point.
    pub(super) corral: Corral,
    /// Number of support points computed.
    pub(super) steps: usize,
}

/// The distance of the bodies, up to `cutoff`.
pub(super) fn distance(a: &mut ConvexBody, b: &mut ConvexBody, cutoff: f64, limits: Limits) -> GjkResult {
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
        // The square root of this bounds the distance between x and the true nearest point.
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
