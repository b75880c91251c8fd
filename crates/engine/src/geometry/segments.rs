//! The closest points of two line segments.

use crate::math::*;

/// The points `centre` + t `half` with t from -1 to 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Segment {
    pub(super) centre: Vec3,
    pub(super) half: Vec3,
}

/// Squared sine of the largest angle between two segments that count as parallel.
const PARALLEL: f64 = 1e-12;

impl Segment {
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(super) fn at(&self, t: f64) -> Vec3 {
        add_scaled(self.centre, self.half, t)
    }

    /// The parameter of the point of the segment that is closest to `point`. For a segment of length zero it is 0,
    /// the centre.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(super) fn closest_to(&self, point: Vec3) -> f64 {
        let length2 = dot(self.half, self.half);
        if length2 > 0.0 { clamp(dot(self.half, sub(point, self.centre)) / length2, -1.0, 1.0) } else { 0.0 }
    }

    /// Whether two segments are parallel. A segment of length zero is parallel to every segment.
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
/// The squared distance |d + x u - y v|², d = a - b, is a convex quadratic function of x and y. Its minimum over all
/// y is a function of x alone, with the minimum at x = (uv dv - vv du) / (uu vv - uv²). Within the ends of the first
/// segment, the best x is this value, clamped. If the best y for this x is beyond an end of the second segment, y is
/// that end, and x is the best value for this y.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(super) fn closest_points(a: &Segment, b: &Segment) -> [f64; 2] {
    let (uu, uv, vv) = products(a, b);
    let d = sub(a.centre, b.centre);
    let (du, dv) = (dot(d, a.half), dot(d, b.half));
    let det = uu * vv - uv * uv;
    // For parallel lines every x is equally good.
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
            // Half the derivatives of the squared distance: each is zero, or, at an end, it points outwards.
            for (slope, parameter) in [(-dot(between, a.half), x), (dot(between, b.half), y)] {
                let out = parameter.abs() == 1.0 && slope * parameter <= 1e-9;
                assert!(
                    parameter.abs() <= 1.0 && (slope.abs() < 1e-9 || out),
                    "case {case}: {slope} at {parameter}"
                );
            }
        }
    }
}
