//! Tests whether a point is strictly inside a shape.

use super::Shape;
use crate::kinds::geom;
use crate::math::*;

/// Whether a point (world frame, m) is inside a primitive shape, or below a plane. Meshes and height fields are
/// treated as having no inside.
pub(crate) fn inside_shape(shape: &Shape, point: Vec3) -> bool {
    let [x, y, z] = shape.local(point);
    let [a, b, c] = shape.size;
    match shape.kind {
        geom::PLANE => z < 0.0,
        geom::SPHERE => {
            let from_centre = sub(point, shape.pos);
            dot(from_centre, from_centre) < a * a
        }
        geom::CAPSULE => {
            let above = z - clamp(z, -b.max(0.0), b.max(0.0));
            x * x + y * y + above * above < a * a
        }
        geom::ELLIPSOID => x * x / (a * a) + y * y / (b * b) + z * z / (c * c) < 1.0,
        geom::CYLINDER => z.abs() < b && x * x + y * y < a * a,
        geom::BOX => x.abs() < a && y.abs() < b && z.abs() < c,
        _ => false,
    }
}
