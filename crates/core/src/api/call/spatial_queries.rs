//! Geometric queries: rays, distances, volumes, and the pairs of geoms that can touch.

use super::{Data, Error, Model, Scope, exists};
use crate::geometry::Distance;
use crate::math::Vec3;
use crate::model::extents;
use crate::model::reflect::data;
use crate::query::{self, RayFilter, RayHit};

/// The nearest geom on the ray `from` + x `along`, x ≥ 0, world frame, m (`mj_ray`). A direction of zero length hits nothing.
pub fn ray<S: Scope>(
    m: &Model,
    d: &Data<S>,
    from: Vec3,
    along: Vec3,
    filter: &RayFilter,
) -> Result<Option<RayHit>, Error> {
    d.belongs_to(m)?;
    d.has(&[data::geom_xpos, data::geom_xmat])?;
    Ok(query::ray(m, &d.fields, from, along, filter))
}

/// The distance of two geoms, m, with the segment from the first to the second (`mj_geomDistance`). The distance is searched up
/// to `most`, m.
///
/// Pairs of shapes with closed forms use them and return the distance at their deepest contact. A pair of planes or height fields
/// has no distance.
pub fn geom_distance<S: Scope>(
    m: &Model,
    d: &mut Data<S>,
    geom1: usize,
    geom2: usize,
    most: f64,
) -> Result<Distance, Error> {
    d.has(&[data::geom_xpos, data::geom_xmat])?;
    exists("geom", geom1, m.ngeom)?;
    exists("geom", geom2, m.ngeom)?;
    let (d, s) = d.engine(m)?;
    let found = query::geom_distance(m, d, &mut s.sensor.narrow, [geom1, geom2], most);
    found.ok_or(Error::NoConvex { geom1, geom2 })
}

/// Whether a point (world, m) is inside the volume of a site (`mj_insideSite`).
pub fn inside_site<S: Scope>(m: &Model, d: &Data<S>, site: usize, point: Vec3) -> Result<bool, Error> {
    d.belongs_to(m)?;
    d.has(&[data::site_xpos, data::site_xmat])?;
    exists("site", site, m.nsite)?;
    Ok(query::inside_site(m, &d.fields, site, point))
}

/// Half the extents of a geom along its own axes, m: from its size, or, for meshes and height fields, from its bounding box.
/// Zeros if there is no such geom.
pub fn geom_half_extents(m: &Model, geom: usize) -> Vec3 {
    extents::half_extents(m, geom)
}

/// The smallest extent of a geom, m. Infinite for planes, for height fields, and if there is no such geom.
pub fn geom_thickness(m: &Model, geom: usize) -> f64 {
    extents::thickness(m, geom)
}

/// The half thickness of the thinner of two geoms, m. Only spheres, capsules, cylinders, ellipsoids and boxes are considered (a
/// mesh may be thinner than its bounding box). Infinite if neither geom is of such a type.
pub fn half_thickness_of_pair(m: &Model, pair: [usize; 2]) -> f64 {
    extents::half_thickness_of_pair(m, pair)
}

/// Whether the contact bits of two geoms permit a contact. Programs may write these bits during a run.
pub fn can_collide(m: &Model, geom1: usize, geom2: usize) -> Result<bool, Error> {
    exists("geom", geom1, m.ngeom)?;
    exists("geom", geom2, m.ngeom)?;
    Ok(crate::collision::can_collide(m, geom1, geom2))
}

/// Whether two geoms can make contacts: their contact bits, their bodies, and the pairs and exclusions of the model permit it.
pub fn may_touch(m: &Model, geom1: usize, geom2: usize) -> Result<bool, Error> {
    exists("geom", geom1, m.ngeom)?;
    exists("geom", geom2, m.ngeom)?;
    Ok(crate::collision::may_touch(m, geom1, geom2))
}

/// The number of pairs of geoms that can touch and whose bounding volumes are within reach of each other at the current poses.
/// Each other pair costs one comparison.
pub fn pairs_in_reach<S: Scope>(m: &Model, d: &Data<S>) -> Result<usize, Error> {
    d.belongs_to(m)?;
    Ok(crate::collision::in_reach(m, &d.fields, &d.scratch.collision))
}
