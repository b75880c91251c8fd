//! Shortcuts for the most common pairs, plane–sphere and sphere–sphere, without the construction of shapes. The
//! contacts are computed by the same functions of `geometry::pair` as for shapes.

use crate::geometry::pair::{ContactPoint, ball_on_plane, two_balls};
use crate::math::*;
use crate::model::{Fields, Model};

/// The contact of a plane and a sphere.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(super) fn plane_sphere(
    m: &Model,
    d: &Fields,
    plane: usize,
    sphere: usize,
    reach: f64,
) -> Option<ContactPoint> {
    let (pos, mat) = (rows::<3>(&d.geom_xpos), rows::<9>(&d.geom_xmat));
    let radius = rows::<3>(&m.geom_size)[sphere][0];
    ball_on_plane(pos[plane], column(&mat[plane], 2), pos[sphere], radius, reach)
}

/// The contact of two spheres.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(super) fn sphere_sphere(m: &Model, d: &Fields, g1: usize, g2: usize, reach: f64) -> Option<ContactPoint> {
    let (pos, mat) = (rows::<3>(&d.geom_xpos), rows::<9>(&d.geom_xmat));
    let radius = |g: usize| rows::<3>(&m.geom_size)[g][0];
    let axes = || [column(&mat[g1], 2), column(&mat[g2], 2)];
    two_balls([pos[g1], pos[g2]], [radius(g1), radius(g2)], reach, axes)
}
