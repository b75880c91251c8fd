//! Signed distance of two convex bodies: GJK for separate bodies, an expanding polytope for overlapping ones.
//!
//! A sphere is a point with a radius, and a capsule is a segment with a radius. The signed distance equals that of
//! these cores minus the radii, whatever its sign. The nearest or deepest points of the bodies and those of the cores
//! lie on one line.

use super::difference::Limits;
use super::epa;
use super::gjk::{GjkResult, distance};
use super::polish::{Reach, minimize_reach};
use super::support::ConvexBody;
use crate::math::*;

pub(crate) use super::difference::Limits as Effort;
pub(crate) use super::epa::ConvexScratch;
pub(crate) use super::support::ConvexBody as Convex;

/// Where two bodies are nearest, or where they overlap most.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Nearest {
    /// Signed distance, m.
    pub(crate) dist: f64,
    /// Unit vector from the first body to the second.
    pub(crate) normal: Vec3,
    /// One point of each body: the nearest to the other body, or the deepest in it.
    pub(crate) witness: [Vec3; 2],
}

/// Work units of one step of GJK, without its support points.
const STEP: u64 = 60;

/// Signed distance up to `cutoff`. Returns `None` if the distance is larger, or if the direction between the bodies
/// is undefined.
pub(crate) fn nearest(
    a: &mut ConvexBody,
    b: &mut ConvexBody,
    cutoff: f64,
    limits: Limits,
    scratch: &mut ConvexScratch,
) -> Option<Nearest> {
    let radii = [a.radius(), b.radius()];
    let reach = radii[0] + radii[1];
    let core = nearest_of_cores(a, b, cutoff + reach, limits, scratch)?;
    let dist = core.dist - reach;
    let [on_a, on_b] = core.witness;
    (dist <= cutoff).then_some(Nearest {
        dist,
        normal: core.normal,
        witness: [add_scaled(on_a, core.normal, radii[0]), add_scaled(on_b, core.normal, -radii[1])],
    })
}

/// Signed distance of the cores, without radii. If both bodies are polyhedra, the searches are exact. Results for
/// round bodies are refined from the tolerance to rounding accuracy.
fn nearest_of_cores(
    a: &mut ConvexBody,
    b: &mut ConvexBody,
    cutoff: f64,
    limits: Limits,
    scratch: &mut ConvexScratch,
) -> Option<Nearest> {
    let before = a.work + b.work;
    let found = search(a, b, cutoff, limits, scratch);
    scratch.cost += a.work + b.work - before;
    found
}

/// The search for the nearest points of the cores. The bodies count the cost of their support points.
fn search(
    a: &mut ConvexBody,
    b: &mut ConvexBody,
    cutoff: f64,
    limits: Limits,
    scratch: &mut ConvexScratch,
) -> Option<Nearest> {
    let GjkResult { dist, corral, steps } = distance(a, b, cutoff, limits);
    scratch.cost += steps as u64 * STEP;
    let dist = dist?;
    // This close to touching, the direction between the bodies is more accurate when computed by the penetration
    // algorithm.
    let deep = if dist > limits.tolerance { None } else { epa::depth(&corral, a, b, limits, scratch) };
    let corners = a.discrete() && b.discrete();
    if let Some(Reach { normal, height, witness }) = deep {
        let dist = if corners && height < 0.0 { dist } else { -height };
        return Some(Nearest { dist, normal, witness });
    }
    let witness = [corral.mean(|v| v.on_a), corral.mean(|v| v.on_b)];
    let (normal, length) = unit_vector(sub(witness[1], witness[0]));
    if corners {
        return (length > 0.0).then_some(Nearest { dist, normal, witness });
    }
    let Reach { normal, height, witness } = minimize_reach(a, b, normal, limits);
    (length > 0.0).then_some(Nearest { dist: -height, normal, witness })
}
