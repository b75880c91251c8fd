//! Distance of convex bodies by the algorithm of Gilbert, Johnson and Keerthi (*A fast procedure for computing the
//! distance between complex objects in three-dimensional space*, IEEE Journal of Robotics and Automation 4, 1988) on
//! their Minkowski difference a - b, of which only support points are asked for.
//!
//! The nearest point x of the support points found so far is an upper bound. The support point w towards the origin
//! gives a lower one, x·w / |x|: the plane through w across x has all of the difference on its far side.

use super::simplex::Corral;
use super::support::Body;
use crate::math::*;

/// A point of the Minkowski difference and where it comes from.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Vertex {
    pub(super) on_a: Vec3,
    pub(super) on_b: Vec3,
    /// a - b
    pub(super) point: Vec3,
    /// Corners of bodies that have some.
    pub(super) corners: [i32; 2],
}

/// The support point of the difference in a direction of unit length.
pub(super) fn support(a: &mut Body, b: &mut Body, dir: Vec3) -> Vertex {
    let (on_a, on_b) = (a.support(dir), b.support(scale(dir, -1.0)));
    Vertex { on_a, on_b, point: sub(on_a, on_b), corners: [a.corner, b.corner] }
}

/// Accuracy and effort.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limits {
    /// `opt.ccd_tolerance`, m.
    pub(crate) tolerance: f64,
    /// `opt.ccd_iterations`.
    pub(crate) iterations: usize,
}

/// Lengths below this part of the size of the difference are rounding.
pub(super) const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// What came out.
#[derive(Clone, Copy, Debug)]
pub(super) struct Found {
    /// Distance, m; zero when the origin is in the difference, `None` when it is larger than asked.
    pub(super) dist: Option<f64>,
    /// The simplex that holds the nearest point.
    pub(super) corral: Corral,
    /// Support points that were asked for.
    pub(super) steps: usize,
}

/// Distance up to `cutoff`.
pub(super) fn distance(a: &mut Body, b: &mut Body, cutoff: f64, limits: Limits) -> Found {
    let towards = normalize(sub(b.centre(), a.centre())).0;
    let first = support(a, b, towards);
    let mut found = Found { dist: Some(0.0), corral: Corral::new(first), steps: 1 };
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
        let before = found.corral;
        if !found.corral.admit(new) {
            break;
        }
        if !found.corral.holds_origin() && norm(found.corral.point()) >= upper {
            found.corral = before;
            break;
        }
    }
    found
}
