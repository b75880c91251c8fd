//! Spheres, capsules and cylinders: each comes down to two balls at the nearest points of their axes.

use super::Touch;
use crate::geometry::Shape;
use crate::math::*;

/// Centres nearer than this part of both radii are one point.
const COINCIDENT: f64 = MINVAL;
/// Squared sine of the angle up to which two axes are parallel.
const PARALLEL: f64 = 1e-12;

/// Two balls: the distance of their centres minus both radii. Coincident centres have no direction: the normal is taken across
/// two axes, or along x when these are parallel.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn two_balls(
    [a, b]: [Vec3; 2],
    [ra, rb]: [f64; 2],
    margin: f64,
    axes: impl FnOnce() -> [Vec3; 2],
) -> Option<Touch> {
    let between = sub(b, a);
    let reach = margin + ra + rb;
    if dot(between, between) > reach * reach {
        return None;
    }
    let (mut normal, length) = unit_vector(between);
    if length <= COINCIDENT * (ra + rb) {
        let [x, y] = axes();
        normal = normalize(cross(x, y)).0;
    }
    let dist = length - ra - rb;
    Some(Touch { dist, pos: add_scaled(a, normal, ra + 0.5 * dist), normal, tangent: [0.0; 3] })
}

/// Balls of two shapes, which have the direction of their z axes.
#[cfg_attr(not(feature = "small"), inline(always))]
fn balls(a: &Shape, at_a: Vec3, ra: f64, b: &Shape, at_b: Vec3, rb: f64, margin: f64) -> Option<Touch> {
    two_balls([at_a, at_b], [ra, rb], margin, || [a.axis(2), b.axis(2)])
}

pub(super) fn sphere_sphere(a: &Shape, b: &Shape, margin: f64, out: &mut Vec<Touch>) {
    out.extend(balls(a, a.pos, a.size[0], b, b.pos, b.size[0], margin));
}

pub(super) fn sphere_capsule(sphere: &Shape, capsule: &Shape, margin: f64, out: &mut Vec<Touch>) {
    let axis = capsule.axis(2);
    let half = capsule.size[1].max(0.0);
    let along = clamp(dot(axis, sub(sphere.pos, capsule.pos)), -half, half);
    let nearest = add(scale(axis, along), capsule.pos);
    out.extend(balls(sphere, sphere.pos, sphere.size[0], capsule, nearest, capsule.size[0], margin));
}

/// Side, cap or rim, whichever is nearest to the sphere's centre.
pub(super) fn sphere_cylinder(sphere: &Shape, cylinder: &Shape, margin: f64, out: &mut Vec<Touch>) {
    let [radius, half, _] = cylinder.size;
    let axis = cylinder.axis(2);
    let from_centre = sub(sphere.pos, cylinder.pos);
    let along = dot(axis, from_centre);
    let on_axis = scale(axis, along);
    let across = sub(from_centre, on_axis);
    let across2 = dot(across, across);

    let (mut beside, mut above) = (along.abs() < half, across2 < radius * radius);
    if beside && above {
        // The centre is inside: out by the shorter way.
        let through_cap = half - along.abs() < radius - across2.sqrt();
        (beside, above) = (!through_cap, through_cap);
    }
    let side = if along > 0.0 { 1.0 } else { -1.0 };
    let r = sphere.size[0];
    out.extend(if beside {
        balls(sphere, sphere.pos, r, cylinder, add(on_axis, cylinder.pos), radius, margin)
    } else if above {
        let up = scale(axis, side);
        let cap = add_scaled(cylinder.pos, axis, side * half);
        let height = dot(sub(sphere.pos, cap), up);
        let dist = height - r;
        let pos = add(sphere.pos, scale(up, -0.5 * dist - r));
        (height <= margin + r).then(|| Touch { dist, pos, normal: scale(up, -1.0), tangent: [0.0; 3] })
    } else {
        let out_to_rim = scale(across, radius / across2.sqrt());
        let rim = add(add(scale(axis, side * half), out_to_rim), cylinder.pos);
        balls(sphere, sphere.pos, r, cylinder, rim, 0.0, margin)
    });
}

/// The axes of two capsules, a.pos + x half_a and b.pos + y half_b with x and y from -1 to 1. Their squared distance is least
/// where [aa -ab; -ab bb] [x; y] = [u; v].
struct Axes<'a> {
    a: &'a Shape<'a>,
    b: &'a Shape<'a>,
    half_a: Vec3,
    half_b: Vec3,
    aa: f64,
    ab: f64,
    bb: f64,
    u: f64,
    v: f64,
}

impl<'a> Axes<'a> {
    #[cfg_attr(not(feature = "small"), inline(always))]
    fn new(a: &'a Shape, b: &'a Shape) -> Axes<'a> {
        let (half_a, half_b) = (scale(a.axis(2), a.size[1]), scale(b.axis(2), b.size[1]));
        let between = sub(a.pos, b.pos);
        let (aa, ab, bb) = (dot(half_a, half_a), -dot(half_a, half_b), dot(half_b, half_b));
        let (u, v) = (-dot(half_a, between), dot(half_b, between));
        Axes { a, b, half_a, half_b, aa, ab, bb, u, v }
    }

    /// The contact of the balls at two points.
    #[cfg_attr(not(feature = "small"), inline(always))]
    fn at(&self, x: f64, y: f64, margin: f64) -> Option<Touch> {
        let (a, b) = (self.a, self.b);
        let (on_a, on_b) = (add(scale(self.half_a, x), a.pos), add(scale(self.half_b, y), b.pos));
        balls(a, on_a, a.size[0], b, on_b, b.size[0], margin)
    }

    /// The place on the first axis that is nearest to y on the second, and the other way round.
    fn nearest_x(&self, y: f64) -> f64 {
        ((self.u - y * self.ab) / self.aa).clamp(-1.0, 1.0)
    }

    fn nearest_y(&self, x: f64) -> f64 {
        ((self.v - x * self.ab) / self.bb).clamp(-1.0, 1.0)
    }
}

/// The nearest points of both axes.
pub(super) fn capsule_capsule(a: &Shape, b: &Shape, margin: f64, out: &mut Vec<Touch>) {
    let axes = Axes::new(a, b);
    let Axes { aa, ab, bb, u, v, .. } = axes;
    let det = aa * bb - ab * ab;
    if det.abs() <= PARALLEL * (aa * bb) || det.is_nan() {
        return parallel(a, b, margin, out);
    }
    let (mut x, mut y) = ((bb * u - ab * v) / det, (aa * v - ab * u) / det);
    if x.abs() > 1.0 {
        x = x.signum();
        y = (v - x * ab) / bb;
    }
    if y.abs() > 1.0 {
        y = y.signum();
        x = axes.nearest_x(y);
    }
    if let Some(touch) = axes.at(x, y, margin) {
        out.push(touch);
    }
}

/// Parallel capsules: up to two pairs of nearest points, each from an end.
#[cfg_attr(not(feature = "small"), inline(never))]
fn parallel(a: &Shape, b: &Shape, margin: f64, out: &mut Vec<Touch>) {
    let axes = Axes::new(a, b);
    let ends_of_a = [1.0, -1.0].map(|x| axes.at(x, axes.nearest_y(x), margin));
    let ends_of_b = [1.0, -1.0].map(|y| axes.at(axes.nearest_x(y), y, margin));
    out.extend(ends_of_a.into_iter().chain(ends_of_b).flatten().take(2));
}
