//! Rays against primitive shapes: the first point of a half line on a surface, from outside or inside.
//!
//! Along the ray p + x v the surface of a round shape is a quadratic a x² + 2 b x + c = 0. Rays that graze a
//! surface to rounding miss it. What counts as rounding is a part of the lengths at hand, never a length: a scene may be of
//! any size, and the direction of a ray of any length.

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

/// The coefficients of a x² + 2 b x + c = 0, and the sum of what c is the difference of.
#[derive(Clone, Copy)]
struct Quadratic {
    a: f64,
    b: f64,
    c: f64,
    size: f64,
}

/// Both solutions, ascending for a > 0; none when they are one to rounding.
#[inline]
fn roots(Quadratic { a, b, c, size }: Quadratic) -> Option<[f64; 2]> {
    let det = b * b - a * c;
    let rounding = f64::EPSILON * (b * b + a * size);
    if det.is_nan() || det <= rounding {
        return None;
    }
    let det = det.sqrt();
    Some([(-b - det) / a, (-b + det) / a])
}

/// The first solution that is not negative.
#[inline]
fn first_root(equation: Quadratic) -> Option<f64> {
    let [near, far] = roots(equation)?;
    [near, far].into_iter().find(|&x| x >= 0.0)
}

/// |p + x v|² = r²
#[inline]
fn ball(radius2: f64, ray: &Ray) -> Quadratic {
    let Ray { from: p, along: v } = *ray;
    let far2 = dot(p, p);
    Quadratic { a: dot(v, v), b: dot(v, p), c: far2 - radius2, size: far2 + radius2 }
}

/// Whether the ray meets a sphere about the origin.
#[inline]
pub(super) fn meets_sphere(radius2: f64, ray: &Ray) -> bool {
    first_root(ball(radius2, ray)).is_some()
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
    let distance = first_root(ball(radius * radius, ray))?;
    Some(Hit { distance, normal: unit_vector(ray.at(distance)).0 })
}

/// (p + x v)ᵀ S⁻² (p + x v) = 1
pub(super) fn ellipsoid(size: Vec3, ray: &Ray) -> Option<Hit> {
    let Ray { from: p, along: v } = *ray;
    let s = size.map(|s| 1.0 / (s * s));
    let form = |u: Vec3, w: Vec3| s[0] * u[0] * w[0] + s[1] * u[1] * w[1] + s[2] * u[2] * w[2];
    let far2 = form(p, p);
    let distance = first_root(Quadratic { a: form(v, v), b: form(v, p), c: far2 - 1.0, size: far2 + 1.0 })?;
    let on = ray.at(distance);
    let normal = unit_vector(std::array::from_fn(|i| s[i] * on[i])).0;
    Some(Hit { distance, normal })
}

/// The first point on the round side x² + y² = r², |z| ≤ half.
fn tube(radius: f64, half: f64, ray: &Ray) -> Option<Hit> {
    let Ray { from: p, along: v } = *ray;
    let a = v[0] * v[0] + v[1] * v[1];
    let b = v[0] * p[0] + v[1] * p[1];
    let (far2, radius2) = (p[0] * p[0] + p[1] * p[1], radius * radius);
    let distance = first_root(Quadratic { a, b, c: far2 - radius2, size: far2 + radius2 })?;
    let [x, y, z] = ray.at(distance);
    (z.abs() <= half).then(|| Hit { distance, normal: unit_vector([x, y, 0.0]).0 })
}

pub(super) fn capsule([radius, half, _]: Vec3, ray: &Ray) -> Option<Hit> {
    if !meets_sphere((radius + half) * (radius + half), ray) {
        return None;
    }
    let mut best = tube(radius, half, ray);
    for side in [1.0, -1.0] {
        // The half of the end sphere that is beyond the tube.
        let centre = [0.0, 0.0, side * half];
        let equation = ball(radius * radius, &Ray { from: sub(ray.from, centre), ..*ray });
        for x in roots(equation).into_iter().flatten() {
            let on = ray.at(x);
            if side * on[2] >= half {
                nearer(&mut best, x, || unit_vector(sub(on, centre)).0);
            }
        }
    }
    best
}

pub(super) fn cylinder([radius, half, _]: Vec3, ray: &Ray) -> Option<Hit> {
    if !meets_sphere(radius * radius + half * half, ray) {
        return None;
    }
    let Ray { from: p, along: v } = *ray;
    let mut best = None;
    if v[2].abs() > PARALLEL * norm(v) {
        for side in [-1.0, 1.0] {
            let x = (side * half - p[2]) / v[2];
            let on = ray.at(x);
            if on[0] * on[0] + on[1] * on[1] <= radius * radius {
                nearer(&mut best, x, || [0.0, 0.0, side]);
            }
        }
    }
    if let Some(side) = tube(radius, half, ray) {
        nearer(&mut best, side.distance, || side.normal);
    }
    best
}

pub(super) fn cuboid(size: Vec3, ray: &Ray) -> Option<Hit> {
    let mut best = None;
    for (i, hits) in box_faces(size, ray).into_iter().enumerate() {
        for (hit, side) in hits.into_iter().zip([-1.0, 1.0]) {
            let normal = std::array::from_fn(|k| if k == i { side } else { 0.0 });
            nearer(&mut best, hit, || normal);
        }
    }
    best
}

/// Where the ray meets each face of a box about the origin: by axis, lower and upper face; -1 where it does not.
pub(super) fn box_faces(size: Vec3, ray: &Ray) -> [[f64; 2]; 3] {
    let mut all = [[-1.0; 2]; 3];
    if !meets_sphere(dot(size, size), ray) {
        return all;
    }
    let Ray { from: p, along: v } = *ray;
    let parallel = PARALLEL * norm(v);
    for i in 0..3 {
        if v[i].abs() <= parallel {
            continue;
        }
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        for (hit, side) in all[i].iter_mut().zip([-1.0, 1.0]) {
            let x = (side * size[i] - p[i]) / v[i];
            let on = ray.at(x);
            if x >= 0.0 && on[j].abs() <= size[j] && on[k].abs() <= size[k] {
                *hit = x;
            }
        }
    }
    all
}
