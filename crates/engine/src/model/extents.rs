//! Extents of geoms.

use super::Model;
use crate::kinds::geom;
use crate::math::{Vec3, rows};

/// Half the extents of a geom along its own axes, m. Computed from its current size, which programs may have written; for meshes
/// and height fields, from the bounding box.
pub fn half_extents(m: &Model, g: usize) -> Vec3 {
    let size = rows::<3>(&m.geom_size).get(g).copied().unwrap_or([0.0; 3]);
    match m.geom_type.get(g).copied() {
        Some(geom::SPHERE) => [size[0]; 3],
        Some(geom::CAPSULE) => [size[0], size[0], size[0] + size[1]],
        Some(geom::CYLINDER) => [size[0], size[0], size[1]],
        Some(geom::ELLIPSOID | geom::BOX) => size,
        _ => rows::<6>(&m.geom_aabb).get(g).map_or([0.0; 3], |b| [b[3], b[4], b[5]]),
    }
}

/// The smallest extent of a geom, m. Infinite for planes, for height fields, and if there is no such geom.
pub fn thickness(m: &Model, g: usize) -> f64 {
    match m.geom_type.get(g).copied() {
        Some(geom::PLANE | geom::HFIELD) | None => f64::INFINITY,
        _ => 2.0 * half_extents(m, g).into_iter().fold(f64::INFINITY, f64::min),
    }
}

/// The half thickness of the thinner of two geoms, m. Only primitive shapes are considered: a mesh may be thinner than its
/// bounding box.
pub fn half_thickness_of_pair(m: &Model, pair: [usize; 2]) -> f64 {
    let sized =
        |g: &usize| m.geom_type.get(*g).is_some_and(|&kind| (geom::SPHERE..=geom::BOX).contains(&kind));
    pair.into_iter().filter(sized).map(|g| 0.5 * thickness(m, g)).fold(f64::INFINITY, f64::min)
}
