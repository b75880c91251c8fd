//! The closest points of two line segments.

use crate::math::*;

/// The points `centre` + t `half`, t from -1 to 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Segment {
    pub(super) centre: Vec3,
    pub(super) half: Vec3,
}

/// Squared sine of the angle up to which two segments are parallel.
const PARALLEL: f64 = 1e-12;

impl Segment {
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(super) fn at(&self, t: f64) -> Vec3 {
        add_scaled(self.centre, self.half, t)
    }

    /// The parameter of the point that is closest to another point. (That of a segment without length is its centre.)
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(super) fn closest_to(&self, point: Vec3) -> f64 {
        let length2 = dot(self.half, self.half);
        if length2 > 0.0 { clamp(dot(self.half, sub(point, self.centre)) / length2, -1.0, 1.0) } else { 0.0 }
    }

    /// Whether two segments have the same direction, or one of them none.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(super) fn is_parallel(&self, other: &Segment) -> bool {
        let (aa, ab, bb) = products(self, other);
        let parallel = aa * bb - ab * ab <= PARALLEL * (aa * bb);
        parallel || !(aa * bb).is_finite()
    }
}

#[cfg_attr(not(feature = "small"), inline(always))]
fn products(a: &Segment, b: &Segment) -> (f64, f64, f64) {
    (dot(a.half, a.half), dot(a.half, b.half), dot(b.half, b.half))
}

/// The parameters of the closest points of two segments.
///
/// The squared distance |d + x u - y v|², d = a - b, is a convex quadratic of x and y. Least over all y it is one of x alone, with
/// its minimum at x = (uv dv - vv du) / (uu vv - uv²); within the ends of the first segment the best x is that number clamped. If the
/// best y for it is beyond an end of the second segment, then y is that end, and x the best for it.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(super) fn closest_points(a: &Segment, b: &Segment) -> [f64; 2] {
    let (uu, uv, vv) = products(a, b);
    let d = sub(a.centre, b.centre);
    let (du, dv) = (dot(d, a.half), dot(d, b.half));
    let det = uu * vv - uv * uv;
    // Of parallel lines every x is as good.
    let x = if det > 0.0 { clamp((uv * dv - vv * du) / det, -1.0, 1.0) } else { 0.0 };
    let y = b.closest_to(a.at(x));
    [a.closest_to(b.at(y)), y]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::tests::Random;

    #[test]
    fn closest_points_are_stationary() {
        let mut random = Random(3);
        for case in 0..100_000 {
            let mut segment = || Segment { centre: random.vector(-2.0, 2.0), half: random.vector(-1.0, 1.0) };
            let (a, mut b) = (segment(), segment());
            match random.below(8) {
                0 => b.half = scale(a.half, random.within(-1.0, 1.0)),
                1 => b.half = add_scaled(a.half, random.vector(-1.0, 1.0), 1e-5),
                2 => b.half = [0.0; 3],
                _ => {}
            }
            let [x, y] = closest_points(&a, &b);
            let between = sub(b.at(y), a.at(x));
            // Half the derivatives of the squared distance: zero, or pointing out at an end.
            for (slope, at) in [(-dot(between, a.half), x), (dot(between, b.half), y)] {
                let out = at.abs() == 1.0 && slope * at <= 1e-9;
                assert!(at.abs() <= 1.0 && (slope.abs() < 1e-9 || out), "case {case}: {slope} at {at}");
            }
        }
    }
}
