//! The Minkowski difference a - b of two bodies. The bodies overlap if it contains the origin. The distance of the
//! origin from its boundary is the separation or the penetration depth. Only support points of the difference are
//! computed.

use super::support::ConvexBody;
use crate::math::*;

/// A point of the Minkowski difference, and the two points of which it is the difference.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Vertex {
    pub(super) on_a: Vec3,
    pub(super) on_b: Vec3,
    /// a - b
    pub(super) point: Vec3,
    /// Corner indexes of the points, for bodies with corners.
    pub(super) corners: [i32; 2],
}

/// The support point of the difference in the direction of a unit vector.
pub(super) fn support(a: &mut ConvexBody, b: &mut ConvexBody, dir: Vec3) -> Vertex {
    let (on_a, on_b) = (a.support(dir), b.support(scale(dir, -1.0)));
    Vertex { on_a, on_b, point: sub(on_a, on_b), corners: [a.corner, b.corner] }
}

/// Accuracy and iteration limit.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limits {
    /// `opt.ccd_tolerance`, m.
    pub(crate) tolerance: f64,
    /// `opt.ccd_iterations`.
    pub(crate) iterations: usize,
}

/// Relative rounding error: lengths below this fraction of the size of the difference are treated as zero.
pub(super) const ROUNDING: f64 = 4.0 * f64::EPSILON;
