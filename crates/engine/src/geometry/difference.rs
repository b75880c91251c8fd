//! The Minkowski difference a - b of two bodies: they overlap when it holds the origin, and its point nearest to the origin
//! says how far they are apart, or how deep they overlap. Only its support points are ever asked for.

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
