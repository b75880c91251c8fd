//! A plane, which is the surface of a half space, against the other types. The contact normal is the normal of the
//! plane.

use super::ContactPoint;
use super::polygon::{Corners, largest_quadrilateral};
use crate::geometry::Shape;
use crate::geometry::support::{ConvexBody, climb, search};
use crate::math::*;

/// A contact at a point of the other shape, moved by half its distance towards the plane.
fn touch(normal: Vec3, dist: f64, point: Vec3) -> ContactPoint {
    ContactPoint { dist, pos: add_scaled(point, normal, -0.5 * dist), normal, tangent: [0.0; 3] }
}

/// The contact of a ball and a plane through `point`. Its distance is the height of the centre minus the
/// radius. Its position is halfway between the lowest point of the ball and the plane.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn ball_on_plane(
    point: Vec3,
    normal: Vec3,
    centre: Vec3,
    radius: f64,
    margin: f64,
) -> Option<ContactPoint> {
    let dist = dot(sub(centre, point), normal) - radius;
    if dist > margin {
        return None;
    }
    Some(ContactPoint {
        dist,
        pos: add_scaled(centre, normal, -(radius + 0.5 * dist)),
        normal,
        tangent: [0.0; 3],
    })
}

/// The contact of a plane and a ball that is part of another shape.
fn ball(plane: &Shape, centre: Vec3, radius: f64, margin: f64) -> Option<ContactPoint> {
    ball_on_plane(plane.pos, plane.axis(2), centre, radius, margin)
}

pub(super) fn sphere(plane: &Shape, sphere: &Shape, margin: f64, out: &mut Vec<ContactPoint>) {
    out.extend(ball(plane, sphere.pos, sphere.size[0], margin));
}

/// The contacts of the balls at both ends of a capsule, with the first tangent along its axis.
pub(super) fn capsule(plane: &Shape, capsule: &Shape, margin: f64, out: &mut Vec<ContactPoint>) {
    let axis = capsule.axis(2);
    let half = scale(axis, capsule.size[1]);
    for end in [add(capsule.pos, half), sub(capsule.pos, half)] {
        out.extend(ball(plane, end, capsule.size[0], margin).map(|t| ContactPoint { tangent: axis, ..t }));
    }
}

/// Contacts at the lowest points of both rims of a cylinder, and at two more points of the lower rim. A cylinder that
/// lies on its side is supported by the two lowest points. A cylinder that stands upright is supported by three
/// points of the lower rim: the lowest one and two at 120° from it.
///
/// Heights are sums of scalars, so that a cylinder placed exactly on a plane has a distance of exactly zero.
pub(super) fn cylinder(plane: &Shape, cylinder: &Shape, margin: f64, out: &mut Vec<ContactPoint>) {
    let [radius, half, _] = cylinder.size;
    let (normal, axis) = (plane.axis(2), cylinder.axis(2));
    let height = dot(sub(cylinder.pos, plane.pos), normal);
    // The axis in the downward direction, and the steepest downward direction across it: -normal without its
    // component along the axis.
    let slope = dot(normal, axis);
    let downwards = scale(axis, if slope > 0.0 { -1.0 } else { 1.0 });
    let end = scale(downwards, half);
    let (mut down, mut steepness) = unit_vector(add_scaled(scale(normal, -1.0), axis, slope));
    if steepness < MINVAL {
        // The axis is vertical: all directions across it are horizontal.
        (down, steepness) = (cylinder.axis(0), 0.0);
    }
    let down = scale(down, radius);
    // Height of the centre of the lower end relative to the centre of the cylinder, and height of the lowest point of
    // a rim relative to its centre.
    let (to_end, to_rim) = (-half * slope.abs(), -radius * steepness);
    let mut add_contact = |offset: Vec3, dist: f64| {
        if dist <= margin {
            out.push(touch(normal, dist, add(cylinder.pos, offset)));
        }
        dist <= margin
    };
    if !add_contact(add(down, end), height + to_end + to_rim) {
        return;
    }
    add_contact(sub(down, end), height - to_end + to_rim);
    // A third of a turn to either side: cos 120° = -1/2, sin 120° = √3/2.
    let sideways = scale(cross(down, downwards), 0.75f64.sqrt());
    let behind = add_scaled(end, down, -0.5);
    for side in [sideways, scale(sideways, -1.0)] {
        add_contact(add(behind, side), height + to_end - 0.5 * to_rim);
    }
}

/// The contacts of a box: the lower end of each of its four space diagonals. They are ordered by the signs of x, y
/// and z, where the sign of x changes fastest.
pub(super) fn cuboid(plane: &Shape, cuboid: &Shape, margin: f64, out: &mut Vec<ContactPoint>) {
    let normal = plane.axis(2);
    let height = dot(sub(cuboid.pos, plane.pos), normal);
    let [x, y, z] = [0, 1, 2].map(|i| scale(cuboid.axis(i), cuboid.size[i]));
    // The four corners of a face normal to z, relative to the centre of this face.
    let sides = [scale(add(x, y), -1.0), sub(x, y), sub(y, x), add(x, y)];
    let corners = sides.map(|side| sub(side, z)).into_iter().chain(sides.map(|side| add(side, z)));
    let low = corners.filter_map(|corner| {
        let rise = dot(normal, corner);
        (rise <= 0.0 && height + rise <= margin)
            .then(|| touch(normal, height + rise, add(corner, cuboid.pos)))
    });
    out.extend(low.take(4));
}

/// The contact at the lowest point of an ellipsoid.
pub(super) fn ellipsoid(plane: &Shape, ellipsoid: &Shape, margin: f64, out: &mut Vec<ContactPoint>) {
    let normal = plane.axis(2);
    let lowest = ConvexBody::new(ellipsoid).support(scale(normal, -1.0));
    let dist = dot(sub(lowest, plane.pos), normal);
    if dist <= margin {
        out.push(touch(normal, dist, lowest));
    }
}

/// The contacts of a mesh. Of the hull faces at the lowest corner, the one that most directly faces the plane is
/// chosen. Its corners are listed starting with the lowest; of more than four, those that span the largest area are
/// selected. Corners within the margin and not above the centre become contacts.
pub(super) fn mesh(plane: &Shape, other: &Shape, margin: f64, out: &mut Vec<ContactPoint>) {
    let normal = plane.axis(2);
    let mesh = &other.mesh();
    let down = scale(mat_t_mul_vec(&other.mat, normal), -1.0);
    let contact_at = |v: usize| {
        let point = other.world(mesh.vertex(v));
        touch(normal, dot(sub(point, plane.pos), normal), point)
    };
    let lowest = match &mesh.hull {
        Some(hull) => hull.vertex[climb(mesh, hull, down, 0).0] as usize,
        None => search(mesh, down, None),
    };
    let first = contact_at(lowest);
    if first.dist > margin {
        return;
    }
    let side = mesh.hull_faces.and_then(|hull_faces| {
        let here = (0..hull_faces.len()).filter(|&s| hull_faces.vertices(s).contains(&(lowest as u32)));
        let steeper = |&a: &usize, &b: &usize| {
            dot(hull_faces.normal(a), down).total_cmp(&dot(hull_faces.normal(b), down))
        };
        here.max_by(steeper).map(|s| hull_faces.vertices(s))
    });
    let Some(side) = side else { return out.push(first) };
    let start = side.iter().position(|&v| v as usize == lowest).unwrap_or(0);
    let mut corners = Corners::new();
    for k in 0..side.len() {
        let v = side[(start + k) % side.len()] as usize;
        corners.push(mesh.vertex(v));
    }
    let mut add = |local: Vec3| {
        let point = other.world(local);
        let dist = dot(sub(point, plane.pos), normal);
        if dist <= margin && dot(down, local) >= 0.0 {
            out.push(touch(normal, dist, point));
        }
    };
    match corners.all() {
        few if few.len() <= 4 => few.iter().for_each(|&p| add(p)),
        many => largest_quadrilateral(many).into_iter().for_each(add),
    }
}
