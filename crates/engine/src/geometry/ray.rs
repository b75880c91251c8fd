//! Rays against primitive shapes: the first point of a half line on a surface, from outside or inside.
//!
//! A line p + x v is within a convex body along an interval of x, and within the intersection of two bodies along the intersection
//! of their intervals. A box is the intersection of three slabs |pᵢ| ≤ sᵢ (Kay, Kajiya, *Ray tracing complex scenes*, SIGGRAPH 1986),
//! a cylinder that of a tube and a slab, and a capsule is a cylinder and two balls, whose intervals overlap. Balls, tubes and
//! ellipsoids are |q|² ≤ 1 of coordinates divided by their radii, which is a quadratic of x. The ray hits where the
//! interval begins or, when it starts inside, where it ends.
//!
//! Rays that graze a surface to rounding miss it. What counts as rounding is a part of the lengths at hand, never a length: a scene may
//! be of any size, and the direction of a ray of any length.

use crate::math::*;

/// Where a ray meets a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Hit {
    /// Distance in lengths of the ray's direction, not negative.
    pub distance: f64,
    /// Unit normal of the surface, out of the shape, in the frame of the ray.
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

    /// The same ray with its coordinates divided.
    fn divided(&self, by: Vec3) -> Ray {
        let divide = |v: Vec3| std::array::from_fn(|i| v[i] / by[i]);
        Ray { from: divide(self.from), along: divide(self.along) }
    }
}

/// Keeps the nearer of two hits, the first one when they are equal.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(super) fn nearer(best: &mut Option<Hit>, distance: f64, normal: impl FnOnce() -> Vec3) {
    if distance >= 0.0 && best.is_none_or(|b| distance < b.distance) {
        *best = Some(Hit { distance, normal: normal() });
    }
}

/// A component of a direction of unit length below this is zero.
pub(super) const PARALLEL: f64 = MINVAL;

/// Where a line is inside: from the first number to the second.
type Interval = [f64; 2];

/// Where both are; `None` where that is nowhere, or a number is none.
fn both([a, b]: Interval, [c, d]: Interval) -> Option<Interval> {
    let (from, to) = (a.max(c), b.min(d));
    (from <= to).then_some([from, to])
}

/// The first end of an interval that is not behind the start of the ray.
fn first([from, to]: Interval) -> Option<f64> {
    [from, to].into_iter().find(|x| (0.0..f64::INFINITY).contains(x))
}

/// Where |p + x v| ≤ `half`, of one coordinate: of a coordinate that does not change everywhere or nowhere.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(super) fn slab(p: f64, v: f64, half: f64) -> Interval {
    if v == 0.0 {
        let everywhere = [f64::NEG_INFINITY, f64::INFINITY];
        return if p.abs() <= half { everywhere } else { [f64::INFINITY, f64::NEG_INFINITY] };
    }
    let reach = half.copysign(v);
    [(-reach - p) / v, (reach - p) / v]
}

/// Where |p + x v| ≤ 1 over the first N coordinates: a x² + 2 b x + c ≤ 0. Nowhere when both ends are one to rounding.
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
    // The gradient of Σ (qᵢ / sᵢ)².
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

/// Where a line crosses the surface of a box.
#[derive(Clone, Copy, Debug)]
pub(super) struct Crossing {
    pub(super) distance: f64,
    /// The axis across the face, and -1 or 1 for its lower or upper side.
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

/// Where a line goes into a box about the origin, and where it comes out.
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
