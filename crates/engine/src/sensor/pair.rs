//! Sensors of two bodies or geoms: their distance, its direction, and the segment between the nearest points.
//!
//! If the distance exceeds the cutoff, the reported distance is the cutoff, and the other values are zero.

use super::{SensorScratch, put};
use crate::geometry::Shape;
use crate::kinds::geom;
use crate::math::*;
use crate::model::index::{element_range, object_index};
use crate::model::{Fields, Model, Obj};
use crate::query::geom_distance;

/// Work units of two geoms that are too far apart.
const DISTANT_PAIR_COST: u64 = 4;
/// Relative tolerance for rounding errors before a pair counts as too far apart.
const ROUNDING: f64 = 1e-9;

/// The geoms of a body, or a single geom.
pub(super) fn geoms(m: &Model, objtype: i32, id: i32) -> std::ops::Range<usize> {
    let id = object_index(id);
    if objtype != Obj::Body as i32 {
        return id..id + 1;
    }
    element_range(m.body_geomadr[id], m.body_geomnum[id])
}

/// The nearest pair among the geoms of both sides: signed distance, and the segment from the first to the second
/// geom.
fn nearest(m: &Model, d: &mut Fields, w: &mut SensorScratch, s: usize) -> (f64, [Vec3; 2]) {
    let cutoff = m.sensor_cutoff[s];
    let mut best = (cutoff, [[0.0; 3]; 2]);
    let others = geoms(m, m.sensor_reftype[s], m.sensor_refid[s]);
    // Computes the bounds of the second side once.
    w.bounds.clear();
    w.bounds.extend(others.clone().map(|g| (rows::<3>(&d.geom_xpos)[g], bound(m, d, g))));
    for g1 in geoms(m, m.sensor_objtype[s], m.sensor_objid[s]) {
        let (centre, radius) = (rows::<3>(&d.geom_xpos)[g1], bound(m, d, g1));
        for (i, g2) in others.clone().enumerate() {
            d.meter.add(DISTANT_PAIR_COST);
            if d.meter.over() {
                return best;
            }
            let (other, another) = w.bounds[i];
            let reach = (best.0.max(0.0) + radius + another) * (1.0 + ROUNDING);
            let offset = sub(other, centre);
            if dot(offset, offset) > reach * reach {
                continue;
            }
            // Models that need the general algorithm are refused when they are read by a build without it: see
            // `needs_search`.
            let Some(found) = geom_distance(m, d, &mut w.narrow, [g1, g2], best.0) else {
                return (f64::NAN, [[f64::NAN; 3]; 2]);
            };
            if found.dist < best.0 {
                best = (found.dist, found.fromto);
            }
        }
    }
    best
}

/// The radius of the bounding sphere of a geom, m. It is infinite for planes and height fields.
fn bound(m: &Model, d: &Fields, g: usize) -> f64 {
    match m.geom_type[g] {
        geom::PLANE | geom::HFIELD => f64::INFINITY,
        geom::MESH => m.geom_rbound[g],
        _ => Shape::geom(m, d, g).bounding_radius(),
    }
}

pub(super) fn distance(m: &Model, d: &mut Fields, w: &mut SensorScratch, s: usize, out: &mut [f64]) {
    put(out, [nearest(m, d, w, s).0]);
}

/// The direction from the first to the second geom. If they overlap, it points outwards from the deepest point.
pub(super) fn normal(m: &Model, d: &mut Fields, w: &mut SensorScratch, s: usize, out: &mut [f64]) {
    let (_, [from, to]) = nearest(m, d, w, s);
    let along = sub(to, from);
    put(out, if along == [0.0; 3] { along } else { normalize(along).0 });
}

pub(super) fn from_to(m: &Model, d: &mut Fields, w: &mut SensorScratch, s: usize, out: &mut [f64]) {
    let (_, [from, to]) = nearest(m, d, w, s);
    put(out, [from[0], from[1], from[2], to[0], to[1], to[2]]);
}
