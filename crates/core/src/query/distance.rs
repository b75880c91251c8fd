//! Signed distance of two geoms of a model (`mj_geomDistance`).

use crate::geometry::convex::Effort;
use crate::geometry::pair::Settings;
use crate::geometry::{Distance, Shape, shape_distance};
use crate::kinds::disable;
use crate::{Data, Model};

/// The distance of two geoms up to `most`, with the segment from the first to the second (`mj_geomDistance`).
///
/// Shapes with closed forms use those, at their deepest contact; two planes or height fields have no distance.
pub fn geom_distance(m: &Model, d: &mut Data, geom1: usize, geom2: usize, most: f64) -> Distance {
    let mut work = std::mem::take(&mut d.work.narrow);
    work.room.cost = 0;
    let (a, b) = (Shape::geom(m, d, geom1), Shape::geom(m, d, geom2));
    let distance = shape_distance(&a, &b, most, &Settings::of(m), &mut work);
    d.work.meter.add(100 + work.room.cost);
    d.work.narrow = work;
    distance
}

/// Iterations beyond this cost more than they can give.
const MOST_ITERATIONS: i32 = 10_000;

impl Settings {
    pub(crate) fn of(m: &Model) -> Settings {
        Settings {
            effort: Effort {
                tolerance: m.opt.ccd_tolerance,
                iterations: m.opt.ccd_iterations.clamp(0, MOST_ITERATIONS) as usize,
            },
            several: !m.opt.disabled(disable::MULTICCD),
        }
    }
}
