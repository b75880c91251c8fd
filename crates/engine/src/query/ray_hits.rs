//! A ray against all geoms of a model (`mj_ray`).

use crate::geometry::{Shape, ray_shape};
use crate::math::*;
use crate::model::{Fields, Model};

/// Selects the geoms that a ray can hit. Invisible geoms are never hit.
#[derive(Clone, Copy, Debug)]
pub struct RayFilter {
    /// The groups that can be hit, by `geom_group` from 0 to 5; all of them if `None`.
    pub groups: Option<[bool; 6]>,
    /// Whether geoms fixed to the world can be hit.
    pub statics: bool,
    /// A body whose geoms are not hit.
    pub exclude_body: Option<usize>,
}

impl Default for RayFilter {
    /// Admits all visible geoms.
    fn default() -> Self {
        RayFilter { groups: None, statics: true, exclude_body: None }
    }
}

impl RayFilter {
    /// Whether a geom can be hit. Geoms with zero opacity cannot.
    fn admits(&self, m: &Model, g: usize) -> bool {
        let body = m.geom_bodyid[g] as usize;
        let colour = match usize::try_from(m.geom_matid[g]) {
            Ok(material) => rows::<4>(&m.mat_rgba).get(material),
            Err(_) => rows::<4>(&m.geom_rgba).get(g),
        };
        let group = m.geom_group[g].clamp(0, 5) as usize;
        self.exclude_body != Some(body)
            && colour.is_none_or(|c| c[3] != 0.0)
            && (self.statics || m.body_weldid[body] != 0)
            && self.groups.is_none_or(|on| on[group])
    }
}

/// The nearest geom on a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayHit {
    /// x of the hit: the distance in multiples of the length of `along`; in m if `along` is a unit vector.
    pub distance: f64,
    /// The geom.
    pub geom: usize,
    /// Unit normal of its surface, world frame.
    pub normal: Vec3,
}

/// The nearest geom on the ray `from` + x `along`, x ≥ 0, world frame, m (`mj_ray`). A direction of length zero hits nothing.
pub fn ray(m: &Model, d: &Fields, from: Vec3, along: Vec3, filter: &RayFilter) -> Option<RayHit> {
    counted_ray(m, d, from, along, filter, &mut 0)
}

/// Like [`ray`]; the work units are added to `work`.
pub fn counted_ray(
    m: &Model,
    d: &Fields,
    from: Vec3,
    along: Vec3,
    filter: &RayFilter,
    work: &mut u64,
) -> Option<RayHit> {
    *work += 5 * m.ngeom as u64;
    if along == [0.0; 3] {
        return None;
    }
    let mut best: Option<RayHit> = None;
    for geom in (0..m.ngeom).filter(|&g| filter.admits(m, g)) {
        if let Some(hit) = ray_shape(&Shape::geom(m, d, geom), from, along, work)
            && best.is_none_or(|b| hit.distance < b.distance)
        {
            best = Some(RayHit { distance: hit.distance, geom, normal: hit.normal });
        }
    }
    best
}
