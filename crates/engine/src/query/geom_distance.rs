//! Signed distance of two geoms of a model (`mj_geomDistance`).

use crate::geometry::convex::Effort;
use crate::geometry::pair::PairSettings;
use crate::geometry::{Distance, Narrow, Shape, shape_distance};
use crate::kinds::disable;
use crate::model::{Fields, Model};

/// The distance of two geoms up to `most`, with the segment from the first to the second. Returns `None` if this
/// build cannot compute it.
pub fn geom_distance(
    m: &Model,
    d: &mut Fields,
    work: &mut Narrow,
    [geom1, geom2]: [usize; 2],
    most: f64,
) -> Option<Distance> {
    (work.convex.cost, work.convex.most) = (0, Some(d.meter.left()));
    let (a, b) = (Shape::geom(m, d, geom1), Shape::geom(m, d, geom2));
    let distance = shape_distance(&a, &b, most, &PairSettings::from_model(m), work);
    d.meter.add(100 + work.convex.cost);
    distance
}

/// Upper limit of `ccd_iterations`; more iterations do not improve the result.
const MOST_ITERATIONS: i32 = 10_000;

impl PairSettings {
    pub(crate) fn from_model(m: &Model) -> PairSettings {
        PairSettings {
            effort: Effort {
                tolerance: m.opt.ccd_tolerance,
                iterations: m.opt.ccd_iterations.clamp(0, MOST_ITERATIONS) as usize,
            },
            several: !m.opt.disabled(disable::MULTICCD),
        }
    }
}
