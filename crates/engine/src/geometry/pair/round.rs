//! Spheres, capsules and cylinders. The closest feature is a point of an axis, a side, an end or a rim. Spheres and
//! capsules are treated as two balls at the closest points of their centres or axes.

use super::ContactPoint;
use crate::geometry::Shape;
use crate::geometry::segments::{Segment, closest_points};
use crate::math::*;

/// Centres closer than this fraction of the sum of both radii coincide.
const COINCIDENT: f64 = MINVAL;
/// The contact of two balls: the distance of their centres minus both radii. If the centres coincide, the normal is
/// perpendicular to two axes, or along x if these are parallel.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn two_balls(
    [a, b]: [Vec3; 2],
    [ra, rb]: [f64; 2],
    margin: f64,
    axes: impl FnOnce() -> [Vec3; 2],
) -> Option<ContactPoint> {
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
    Some(ContactPoint { dist, pos: add_scaled(a, normal, ra + 0.5 * dist), normal, tangent: [0.0; 3] })
}

/// The contact of two balls that are part of two shapes. If the centres coincide, the z axes of the shapes determine
/// the normal.
#[cfg_attr(not(feature = "small"), inline(always))]
fn balls(
    a: &Shape,
    at_a: Vec3,
    ra: f64,
    b: &Shape,
    at_b: Vec3,
    rb: f64,
    margin: f64,
) -> Option<ContactPoint> {
    two_balls([at_a, at_b], [ra, rb], margin, || [a.axis(2), b.axis(2)])
}

pub(super) fn sphere_sphere(a: &Shape, b: &Shape, margin: f64, out: &mut Vec<ContactPoint>) {
    out.extend(balls(a, a.pos, a.size[0], b, b.pos, b.size[0], margin));
}

/// The axis of a capsule.
#[cfg_attr(not(feature = "small"), inline(always))]
fn axis(capsule: &Shape) -> Segment {
    Segment { centre: capsule.pos, half: scale(capsule.axis(2), capsule.size[1]) }
}

pub(super) fn sphere_capsule(sphere: &Shape, capsule: &Shape, margin: f64, out: &mut Vec<ContactPoint>) {
    let line = axis(capsule);
    let nearest = line.at(line.closest_to(sphere.pos));
    out.extend(balls(sphere, sphere.pos, sphere.size[0], capsule, nearest, capsule.size[0], margin));
}

/// In the half plane that contains the axis of the cylinder and the centre of the sphere, the cylinder is a
/// rectangle. If the centre is beyond both its side and its end, the nearest point is the corner, which is on the
/// rim. Otherwise the nearest feature is the side or the end, whichever has the larger signed distance from the
/// centre.
pub(super) fn sphere_cylinder(sphere: &Shape, cylinder: &Shape, margin: f64, out: &mut Vec<ContactPoint>) {
    let ([radius, half, _], r) = (cylinder.size, sphere.size[0]);
    let axis = cylinder.axis(2);
    let from_centre = sub(sphere.pos, cylinder.pos);
    let along = dot(axis, from_centre);
    let (mut outwards, across) = unit_vector(add_scaled(from_centre, axis, -along));
    if across <= COINCIDENT * (r + radius) {
        // The centre is on the axis: any direction across the axis is equally good.
        let (direction, length) = normalize(cross(axis, sphere.axis(2)));
        outwards = if length < COINCIDENT { scale(cylinder.axis(0), -1.0) } else { direction };
    }
    let upwards = scale(axis, if along > 0.0 { 1.0 } else { -1.0 });
    let (side, end) = (across - radius, along.abs() - half);
    let (away, gap) = if side > 0.0 && end > 0.0 {
        unit_vector(add_scaled(scale(outwards, side), upwards, end))
    } else if end > side {
        (upwards, end)
    } else {
        (outwards, side)
    };
    let (dist, normal) = (gap - r, scale(away, -1.0));
    if dist <= margin {
        out.push(ContactPoint {
            dist,
            pos: add_scaled(sphere.pos, normal, r + 0.5 * dist),
            normal,
            tangent: [0.0; 3],
        });
    }
}

/// The contact of two balls at the closest points of both axes. For parallel axes the closest points are not unique.
/// There are then up to two contacts, each at an end of one axis and the closest point of the other. Ends of the
/// first axis come first.
pub(super) fn capsule_capsule(a: &Shape, b: &Shape, margin: f64, out: &mut Vec<ContactPoint>) {
    let (on_a, on_b) = (axis(a), axis(b));
    let contact = |[x, y]: [f64; 2]| balls(a, on_a.at(x), a.size[0], b, on_b.at(y), b.size[0], margin);
    if on_a.is_parallel(&on_b) {
        let ends_of_a = [1.0, -1.0].map(|x| contact([x, on_b.closest_to(on_a.at(x))]));
        let ends_of_b = [1.0, -1.0].map(|y| contact([on_a.closest_to(on_b.at(y)), y]));
        out.extend(ends_of_a.into_iter().chain(ends_of_b).flatten().take(2));
    } else {
        out.extend(contact(closest_points(&on_a, &on_b)));
    }
}
