//! Signed distance of two convex bodies: GJK where they are apart, an expanding polytope where they overlap.
//!
//! A sphere is a point and a capsule a segment with a radius around: the signed distance is that of these cores less the
//! radii, whatever the sign, and their nearest or deepest points lie on the same line.

use super::difference::Limits;
use super::epa;
use super::gjk::{GjkResult, distance};
use super::polish::{Reach, least_reach};
use super::support::Body;
use crate::math::*;

pub(crate) use super::difference::Limits as Effort;
pub(crate) use super::epa::Scratch as ConvexScratch;
pub(crate) use super::support::Body as Convex;

/// Where two bodies are nearest, or overlap most.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Nearest {
    /// Signed distance, m.
    pub(crate) dist: f64,
    /// From the first body to the second, unit length.
    pub(crate) normal: Vec3,
    /// A point of each body: the nearest to the other, or the deepest in it.
    pub(crate) witness: [Vec3; 2],
}

/// Work of a step of the search for the nearest point, besides its support points.
const STEP: u64 = 60;

/// Signed distance up to `cutoff`; `None` when it is larger, or when the bodies have no direction between them.
pub(crate) fn nearest(
    a: &mut Body,
    b: &mut Body,
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

/// The same without radii. Of bodies with corners alone the searches are exact; round ones are brought from their tolerance
/// to rounding.
fn nearest_of_cores(
    a: &mut Body,
    b: &mut Body,
    cutoff: f64,
    limits: Limits,
    scratch: &mut ConvexScratch,
) -> Option<Nearest> {
    let before = a.work + b.work;
    let found = search(a, b, cutoff, limits, scratch);
    scratch.cost += a.work + b.work - before;
    found
}

/// The search itself; what its support points cost is kept by the bodies.
fn search(
    a: &mut Body,
    b: &mut Body,
    cutoff: f64,
    limits: Limits,
    scratch: &mut ConvexScratch,
) -> Option<Nearest> {
    let GjkResult { dist, corral, steps } = distance(a, b, cutoff, limits);
    scratch.cost += steps as u64 * STEP;
    let dist = dist?;
    // So near to touching that the direction between them is best seen from the side that overlaps.
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
    let Reach { normal, height, witness } = least_reach(a, b, normal, limits);
    (length > 0.0).then_some(Nearest { dist: -height, normal, witness })
}
