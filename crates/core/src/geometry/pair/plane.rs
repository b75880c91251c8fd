//! A plane (the half space below it) against everything else. The normal is the plane's.

use super::Touch;
use crate::geometry::Shape;
use crate::geometry::support::{Body, climb, search};
use crate::math::*;

/// A contact at a point of the other shape, moved half the way to the plane.
#[inline]
fn touch(normal: Vec3, dist: f64, point: Vec3) -> Touch {
    Touch { dist, pos: add_scaled(point, normal, -0.5 * dist), normal, tangent: [0.0; 3] }
}

/// The lowest point of a ball.
#[inline]
fn ball(plane: &Shape, centre: Vec3, radius: f64, margin: f64) -> Option<Touch> {
    let normal = plane.axis(2);
    let height = dot(sub(centre, plane.pos), normal);
    if height > margin + radius {
        return None;
    }
    let dist = height - radius;
    Some(Touch { dist, pos: add_scaled(centre, normal, -0.5 * dist - radius), normal, tangent: [0.0; 3] })
}

pub(super) fn sphere(plane: &Shape, sphere: &Shape, margin: f64, out: &mut Vec<Touch>) {
    out.extend(ball(plane, sphere.pos, sphere.size[0], margin));
}

/// Both ends, with the first tangent along the axis.
pub(super) fn capsule(plane: &Shape, capsule: &Shape, margin: f64, out: &mut Vec<Touch>) {
    let axis = capsule.axis(2);
    let half = scale(axis, capsule.size[1]);
    for end in [add(capsule.pos, half), sub(capsule.pos, half)] {
        out.extend(ball(plane, end, capsule.size[0], margin).map(|t| Touch { tangent: axis, ..t }));
    }
}

/// The deepest point of the rim, the point above it on the other rim, and two that make an equilateral triangle
/// with the first.
pub(super) fn cylinder(plane: &Shape, cylinder: &Shape, margin: f64, out: &mut Vec<Touch>) {
    let [radius, half, _] = cylinder.size;
    let normal = plane.axis(2);
    let mut axis = cylinder.axis(2);
    let mut slope = dot(normal, axis);
    if slope > 0.0 {
        (axis, slope) = (scale(axis, -1.0), -slope);
    }
    let height = dot(sub(cylinder.pos, plane.pos), normal);

    // Down the slope of the end: -normal without its part along the axis.
    let down = sub(scale(axis, slope), normal);
    let length2 = dot(down, down);
    let down = if length2 >= MINVAL * MINVAL {
        scale(down, radius / length2.sqrt())
    } else {
        scale(cylinder.axis(0), radius)
    };
    let fall = dot(down, normal);
    let (end, rise) = (scale(axis, half), slope * half);

    let lowest = height + rise + fall;
    if lowest > margin {
        return;
    }
    out.push(touch(normal, lowest, add(add(cylinder.pos, down), end)));
    let opposite = height - rise + fall;
    if opposite <= margin {
        out.push(touch(normal, opposite, sub(add(cylinder.pos, down), end)));
    }
    let behind = height + rise - 0.5 * fall;
    if behind <= margin {
        let side = scale(normalize(cross(down, end)).0, radius * 3f64.sqrt() / 2.0);
        for point in [add(cylinder.pos, side), sub(cylinder.pos, side)] {
            out.push(touch(normal, behind, add_scaled(add(point, end), down, -0.5)));
        }
    }
}

/// Up to four of the corners that are below the centre.
pub(super) fn cuboid(plane: &Shape, cuboid: &Shape, margin: f64, out: &mut Vec<Touch>) {
    let normal = plane.axis(2);
    let height = dot(sub(cuboid.pos, plane.pos), normal);
    let corner = |i: usize| {
        let side = |k: usize| if i >> k & 1 == 1 { cuboid.size[k] } else { -cuboid.size[k] };
        mat_mul_vec(&cuboid.mat, [side(0), side(1), side(2)])
    };
    let low = (0..8).map(corner).filter_map(|corner| {
        let below = dot(normal, corner);
        (height + below <= margin && below <= 0.0)
            .then(|| touch(normal, height + below, add(corner, cuboid.pos)))
    });
    out.extend(low.take(4));
}

/// Most contacts of a plane and a mesh.
const MESH_CONTACTS: usize = 3;
/// Corners of a mesh nearer to the lowest one than this, in bounding radii, are not worth a contact.
const MESH_SPREAD: f64 = 0.3;

/// The lowest point of an ellipsoid.
pub(super) fn ellipsoid(plane: &Shape, ellipsoid: &Shape, margin: f64, out: &mut Vec<Touch>) {
    let normal = plane.axis(2);
    let lowest = Body::new(ellipsoid, 0.0).support(scale(normal, -1.0));
    let dist = dot(sub(lowest, plane.pos), normal);
    if dist <= margin {
        out.push(touch(normal, dist, lowest));
    }
}

/// The lowest corner, and neighbours of it within the margin.
pub(super) fn mesh(plane: &Shape, other: &Shape, margin: f64, out: &mut Vec<Touch>) {
    let normal = plane.axis(2);
    let mesh = &other.mesh;
    let down = scale(mat_t_mul_vec(&other.mat, normal), -1.0);
    let vertex = |v: usize| {
        mesh.vert.get(v).map(|&local| {
            let point = other.world(local);
            touch(normal, dot(sub(point, plane.pos), normal), point)
        })
    };
    let lowest = match &mesh.hull {
        Some(hull) => climb(mesh, hull, down, 0),
        None => search(mesh, down, None),
    };
    let index = mesh.hull.map_or(lowest, |hull| hull.vertex[lowest] as usize);
    let Some(first) = vertex(index).filter(|t| t.dist <= margin) else { return };
    out.push(first);

    // Where the mesh is within the margin of the plane, seen from its own frame.
    let centre = dot(normal, sub(other.pos, plane.pos)) - margin;
    let apart = MESH_SPREAD * norm(other.size);
    let mut count = 1;
    let mut near = |v: usize| {
        let within = count < MESH_CONTACTS && dot(down, mesh.vert[v]) > centre;
        if let Some(t) = vertex(v).filter(|_| within)
            && norm(sub(add_scaled(t.pos, normal, 0.5 * t.dist), first.pos)) >= apart
        {
            out.push(t);
            count += 1;
        }
    };
    match mesh.hull {
        Some(hull) => hull.neighbours(lowest).for_each(|v| near(hull.vertex[v] as usize)),
        None => (0..mesh.vert.len()).filter(|&v| v != lowest).for_each(near),
    }
}
