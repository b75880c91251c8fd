//! Rays against primitive shapes: the first intersection of a half line with a surface, from outside or inside.
//!
//! A line p + x v intersects a convex body in an interval of x, and the intersection of two bodies in the
//! intersection of their intervals. A box is the intersection of three slabs |pᵢ| ≤ sᵢ (Kay, Kajiya, *Ray tracing
//! complex scenes*, SIGGRAPH 1986). A cylinder is the intersection of a tube and a slab. A capsule is the union of a
//! cylinder and two balls with overlapping intervals. Balls, tubes and ellipsoids are given by |q|² ≤ 1 in
//! coordinates divided by their radii, which is a quadratic inequality in x. The ray hits the surface where the
//! interval begins, or where it ends if the ray starts inside.
//!
//! Rays that are tangent to a surface to within rounding miss it. Rounding thresholds are relative to the lengths
//! involved, never absolute, because scenes may have any size, and directions of rays any length.

use crate::math::*;

/// The intersection of a ray with a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Hit {
    /// Distance as a multiple of the length of the ray's direction, not negative.
    pub distance: f64,
    /// Outward unit normal of the surface, in the frame of the ray.
    pub normal: Vec3,
}

/// A ray in the frame of a shape.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ray {
    pub(super) from: Vec3,
    pub(super) along: Vec3,
}

impl Ray {
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(super) fn at(&self, x: f64) -> Vec3 {
        add_scaled(self.from, self.along, x)
    }

    /// The ray with its coordinates divided by those of `by`.
    fn divided(&self, by: Vec3) -> Ray {
        let divide = |v: Vec3| std::array::from_fn(|i| v[i] / by[i]);
        Ray { from: divide(self.from), along: divide(self.along) }
    }
}

/// Replaces the best hit if the new one is nearer; of equal distances the first is kept.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(super) fn nearer(best: &mut Option<Hit>, distance: f64, normal: impl FnOnce() -> Vec3) {
    if distance >= 0.0 && best.is_none_or(|b| distance < b.distance) {
        *best = Some(Hit { distance, normal: normal() });
    }
}

/// A component of a unit direction below this counts as zero.
pub(super) const PARALLEL: f64 = MINVAL;

/// The parameters x for which a line is inside a body: lower and upper end.
type Interval = [f64; 2];

/// The intersection of two intervals; `None` if it is empty or contains NaN.
fn both([a, b]: Interval, [c, d]: Interval) -> Option<Interval> {
    let (from, to) = (a.max(c), b.min(d));
    (from <= to).then_some([from, to])
}

/// The first finite end of an interval at or after the start of the ray.
fn first([from, to]: Interval) -> Option<f64> {
    [from, to].into_iter().find(|x| (0.0..f64::INFINITY).contains(x))
}

/// The interval where |p + x v| ≤ `half` for one coordinate. If the coordinate is constant, this is all of x or an
/// empty interval.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(super) fn slab(p: f64, v: f64, half: f64) -> Interval {
    if v == 0.0 {
        let everywhere = [f64::NEG_INFINITY, f64::INFINITY];
        return if p.abs() <= half { everywhere } else { [f64::INFINITY, f64::NEG_INFINITY] };
    }
    let reach = half.copysign(v);
    [(-reach - p) / v, (reach - p) / v]
}

/// The interval where |p + x v| ≤ 1 over the first N coordinates: a x² + 2 b x + c ≤ 0. Returns `None` if the
/// interval is empty, or is a single point to within rounding.
fn unit_ball<const N: usize>(ray: &Ray) -> Option<Interval> {
    let product = |u: Vec3, w: Vec3| (0..N).map(|i| u[i] * w[i]).sum::<f64>();
    let Ray { from: p, along: v } = *ray;
    let (a, b, far2) = (product(v, v), product(v, p), product(p, p));
    let det = b * b - a * (far2 - 1.0);
    let rounding = f64::EPSILON * (b * b + a * (far2 + 1.0));
    if a == 0.0 && far2 <= 1.0 {
        return Some([f64::NEG_INFINITY, f64::INFINITY]);
    }
    (det > rounding).then(|| [(-b - det.sqrt()) / a, (-b + det.sqrt()) / a])
}

pub(super) fn plane(size: Vec3, ray: &Ray) -> Option<Hit> {
    let Ray { from: p, along: v } = *ray;
    if v[2] > -PARALLEL * norm(v) {
        return None;
    }
    let x = -p[2] / v[2];
    let on = ray.at(x);
    let within = |i: usize| size[i] <= 0.0 || on[i].abs() <= size[i];
    (x >= 0.0 && within(0) && within(1)).then_some(Hit { distance: x, normal: [0.0, 0.0, 1.0] })
}

pub(super) fn sphere(radius: f64, ray: &Ray) -> Option<Hit> {
    let distance = first(unit_ball::<3>(&ray.divided([radius; 3]))?)?;
    Some(Hit { distance, normal: unit_vector(ray.at(distance)).0 })
}

pub(super) fn ellipsoid(size: Vec3, ray: &Ray) -> Option<Hit> {
    let scaled = ray.divided(size);
    let distance = first(unit_ball::<3>(&scaled)?)?;
    // The normal is the gradient of Σ (qᵢ / sᵢ)².
    let on = scaled.at(distance);
    Some(Hit { distance, normal: unit_vector(std::array::from_fn(|i| on[i] / size[i])).0 })
}

pub(super) fn cylinder([radius, half, _]: Vec3, ray: &Ray) -> Option<Hit> {
    let round = unit_ball::<2>(&ray.divided([radius; 3]))?;
    let flat = slab(ray.from[2], ray.along[2], half);
    let distance = first(both(round, flat)?)?;
    let [x, y, z] = ray.at(distance);
    let through_end = flat.contains(&distance);
    let normal = if through_end { [0.0, 0.0, 1f64.copysign(z)] } else { unit_vector([x, y, 0.0]).0 };
    Some(Hit { distance, normal })
}

pub(super) fn capsule([radius, half, _]: Vec3, ray: &Ray) -> Option<Hit> {
    let end =
        |z: f64| unit_ball::<3>(&Ray { from: sub(ray.from, [0.0, 0.0, z]), ..*ray }.divided([radius; 3]));
    let round = unit_ball::<2>(&ray.divided([radius; 3]));
    let middle = round.and_then(|round| both(round, slab(ray.from[2], ray.along[2], half)));
    let parts = [middle, end(half), end(-half)].into_iter().flatten();
    let whole = parts.reduce(|[a, b], [c, d]| [a.min(c), b.max(d)])?;
    let distance = first(whole)?;
    let [x, y, z] = ray.at(distance);
    Some(Hit { distance, normal: unit_vector([x, y, z - clamp(z, -half, half)]).0 })
}

pub(super) fn cuboid(size: Vec3, ray: &Ray) -> Option<Hit> {
    let crossing = crossings(size, ray)?.into_iter().find(|c| c.distance >= 0.0)?;
    Some(Hit { distance: crossing.distance, normal: crossing.normal() })
}

/// The intersection of a line with the surface of a box.
#[derive(Clone, Copy, Debug)]
pub(super) struct Crossing {
    pub(super) distance: f64,
    /// The axis normal to the face, and -1 or 1 for its lower or upper side.
    pub(super) axis: usize,
    pub(super) side: f64,
}

impl Crossing {
    pub(super) fn normal(&self) -> Vec3 {
        let mut normal = [0.0; 3];
        normal[self.axis] = self.side;
        normal
    }
}

/// The points where a line enters and leaves a box centred at the origin.
pub(super) fn crossings(size: Vec3, ray: &Ray) -> Option<[Crossing; 2]> {
    let nowhere = Crossing { distance: f64::NEG_INFINITY, axis: 0, side: 0.0 };
    let (mut enters, mut leaves) = (nowhere, Crossing { distance: f64::INFINITY, ..nowhere });
    for axis in 0..3 {
        let (p, v) = (ray.from[axis], ray.along[axis]);
        let [from, to] = slab(p, v, size[axis]);
        let side = 1f64.copysign(v);
        if from > enters.distance {
            enters = Crossing { distance: from, axis, side: -side };
        }
        if to < leaves.distance {
            leaves = Crossing { distance: to, axis, side };
        }
    }
    (enters.distance <= leaves.distance && leaves.distance < f64::INFINITY).then_some([enters, leaves])
}
