//! Signed distance of two shapes, by the method for their types.

use super::Shape;
use super::convex::{Convex, nearest};
use super::pair::{self, CONVEX, Method, PairSettings};
use crate::math::*;

/// Distance and nearest points of two geoms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distance {
    /// Signed distance, m, at most the requested distance. Penetration is negative.
    pub dist: f64,
    /// A point on the surface of each geom, m, world frame; zero if the distance is not below the requested one.
    pub fromto: [Vec3; 2],
}

/// The distance of two shapes up to `most`. Returns `None` if the pair needs the general convex algorithm and this
/// build does not contain it.
pub(crate) fn shape_distance(
    a: &Shape,
    b: &Shape,
    most: f64,
    settings: &PairSettings,
    work: &mut Narrow,
) -> Option<Distance> {
    let mut best = Distance { dist: most, fromto: [[0.0; 3]; 2] };
    let flip = a.kind > b.kind;
    let (first, second) = if flip { (b, a) } else { (a, b) };
    let Some(method) = pair::method(first.kind, second.kind) else { return Some(best) };
    let searched = pair::is_searched(first.kind, second.kind, true);
    if searched && !CONVEX {
        return None;
    }
    if CONVEX && matches!(method, Method::Field) {
        let found = pair::field_distance(first, second, most, settings, &mut work.convex);
        return Some(found.map_or(best, |n| {
            let [p, q] = n.witness;
            Distance { dist: n.dist, fromto: if flip { [q, p] } else { [p, q] } }
        }));
    }
    if CONVEX && searched {
        let (mut u, mut v) = (Convex::new(a), Convex::new(b));
        let found = nearest(&mut u, &mut v, most, settings.effort, &mut work.convex);
        return Some(found.map_or(best, |n| Distance { dist: n.dist, fromto: n.witness }));
    }
    work.touches.clear();
    pair::contacts(method, first, second, most, || *settings, &mut work.convex, &mut work.touches);
    for t in &work.touches {
        if t.dist < best.dist {
            let half = scale(t.normal, 0.5 * t.dist);
            let (on_first, on_second) = (sub(t.pos, half), add(t.pos, half));
            best = Distance {
                dist: t.dist,
                fromto: if flip { [on_second, on_first] } else { [on_first, on_second] },
            };
        }
    }
    Some(best)
}

/// Scratch memory for the contacts of one pair. It is reused, so that steps do not allocate.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Narrow {
    pub(crate) convex: super::convex::ConvexScratch,
    pub(crate) touches: Vec<pair::ContactPoint>,
}
