//! The short way of the commonest pairs: spheres on planes and on each other, without looking at them as shapes.

use crate::geometry::pair::Touch;
use crate::math::*;
use crate::model::{Fields, Model};

/// Signed distance of the sphere's centre from the plane, minus the radius.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(super) fn plane_sphere(m: &Model, d: &Fields, plane: usize, sphere: usize, reach: f64) -> Option<Touch> {
    let (pos, mat) = (rows::<3>(&d.geom_xpos), rows::<9>(&d.geom_xmat));
    let normal = column(&mat[plane], 2);
    let radius = rows::<3>(&m.geom_size)[sphere][0];
    let height = dot(sub(pos[sphere], pos[plane]), normal);
    let dist = height - radius;
    if dist > reach {
        return None;
    }
    // The point of the sphere below its centre, moved half the way to the plane.
    let pos = add_scaled(pos[sphere], normal, -(radius + 0.5 * dist));
    Some(Touch { dist, pos, normal, tangent: [0.0; 3] })
}

/// Distance of the centres minus both radii. Coincident centres have no direction: the normal is taken
/// across the two z axes, or along x when these are parallel.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(super) fn sphere_sphere(m: &Model, d: &Fields, g1: usize, g2: usize, reach: f64) -> Option<Touch> {
    let (pos, size) = (rows::<3>(&d.geom_xpos), rows::<3>(&m.geom_size));
    let (r1, r2) = (size[g1][0], size[g2][0]);
    let between = sub(pos[g2], pos[g1]);
    let apart = dot(between, between);
    let limit = reach + r1 + r2;
    if apart > limit * limit {
        return None;
    }
    let (mut normal, length) = normalize(between);
    if length < MINVAL {
        let mat = rows::<9>(&d.geom_xmat);
        normal = normalize(cross(column(&mat[g1], 2), column(&mat[g2], 2))).0;
    }
    let dist = length - r1 - r2;
    let pos = add_scaled(pos[g1], normal, r1 + 0.5 * dist);
    Some(Touch { dist, pos, normal, tangent: [0.0; 3] })
}
