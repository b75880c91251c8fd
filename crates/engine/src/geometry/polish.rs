//! Refines the direction between two convex bodies to rounding accuracy with Newton's method on the support function
//! of their Minkowski difference.
//!
//! For every unit vector n, h(n) = max n·(a - b) is an upper bound of the penetration depth, and the depth is the
//! minimum of h. For separate bodies, -h(n) is the separation along n, and the distance is its maximum. Where the
//! bodies are round, h has a gradient, which is the support point w(n), and a Hessian H(n), which contains the radii
//! of curvature. On the unit sphere, a step δ normal to n solves (H - h) δ = -w. Where a body has an edge or a face,
//! h has a kink, and the minimum is often in a kink. In this case n is constrained to the plane normal to the edge.

use super::difference::{Limits, support};
use super::gjk::distance;
use super::support::ConvexBody;
use crate::math::*;

/// Sine of the largest angle of a kink from the start direction for which the kink is examined as a possible minimum
/// of h.
const NEAR: f64 = 0.03;
/// Maximum number of steps. Near the minimum each step doubles the number of correct digits.
const MOST_STEPS: usize = 20;
/// Step length, rad, below which a further step would change nothing.
const MIN_STEP: f64 = 1e-11;
/// Sine of the largest angle for which a direction counts as normal to an edge.
const NORMAL_TO_EDGE: f64 = 1e-6;
/// A support point counts as parallel to a direction if its deviation is at most this fraction of its length.
const PARALLEL: f64 = 1e-8;
/// Largest rotation of the direction in one step, rad.
const MAX_ROTATION: f64 = 0.3;
/// Sine of the largest angle for which a direction might be normal to an edge; between [`NORMAL_TO_EDGE`] and this, the
/// classification is unclear.
const UNCERTAIN_NORMAL: f64 = 1e-3;
/// Tilt angle that makes the ends of an edge support points, rad.
const TILT: f64 = 1e-4;
/// Directions of edges of both bodies.
type Kinks = super::list::List<Vec3, 4>;

/// A unit direction, and the extent of the difference along it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reach {
    pub(super) normal: Vec3,
    /// Extent, m; negative if the bodies are separate.
    pub(super) height: f64,
    /// The nearest or deepest point of each body.
    pub(super) witness: [Vec3; 2],
}

/// The direction near `start` along which the extent of the difference is smallest.
pub(super) fn minimize_reach(a: &mut ConvexBody, b: &mut ConvexBody, start: Vec3, limits: Limits) -> Reach {
    let mut kinks = Kinks::new();
    let of_a = a.kinks(start, NEAR);
    let of_b = b.kinks(scale(start, -1.0), NEAR);
    of_a.all().iter().chain(of_b.all()).for_each(|&k| kinks.push(k));
    // The result is never above the value at the start.
    let (mut best, is_flat) = free(a, b, start);
    let mut consider = |found: (Vec3, f64)| {
        if found.1 < best.1 {
            best = found;
        }
    };
    // If a smooth minimum was found, no kink nearby is lower.
    let list = if is_flat { &[] } else { kinks.all() };
    for (i, &edge) in list.iter().enumerate() {
        consider(minimize_across_edge(a, b, start, edge));
        for &other in list.get(i + 1..).unwrap_or(&[]) {
            let (n, sine) = normalize(cross(edge, other));
            if sine > NEAR {
                consider(height(a, b, if dot(n, start) < 0.0 { scale(n, -1.0) } else { n }));
            }
        }
    }
    let (normal, height) = best;
    Reach { normal, height, witness: witness(a, b, normal, height, limits) }
}

/// The extent of the difference along a direction.
fn height(a: &mut ConvexBody, b: &mut ConvexBody, n: Vec3) -> (Vec3, f64) {
    (n, dot(n, support(a, b, n).point))
}

/// Minimizes the extent over all directions. Also returns whether a smooth minimum was found, where the support point
/// is parallel to the direction.
fn free(a: &mut ConvexBody, b: &mut ConvexBody, start: Vec3) -> ((Vec3, f64), bool) {
    let (n, w, h) = descend(a, b, start, |n, w, h, hessian| {
        let f = frame(n);
        let (s, t) = ([f[3], f[4], f[5]], [f[6], f[7], f[8]]);
        let [ss, st, tt] = hessian(n, s, t);
        let (ss, tt) = (ss - h, tt - h);
        // The two principal directions: a rotation that diagonalizes the matrix.
        let (sin, cos) = libm::sincos(0.5 * libm::atan2(2.0 * st, ss - tt));
        let (both, mixed) = (cos * cos * ss + sin * sin * tt, 2.0 * sin * cos * st);
        let first = downhill(cos * dot(s, w) + sin * dot(t, w), both + mixed);
        let second = downhill(cos * dot(t, w) - sin * dot(s, w), ss + tt - both - mixed);
        add(scale(s, cos * first - sin * second), scale(t, sin * first + cos * second))
    });
    ((n, h), norm(sub(w, scale(n, h))) <= PARALLEL * norm(w))
}

/// Minimizes the extent over the directions normal to an edge.
fn minimize_across_edge(a: &mut ConvexBody, b: &mut ConvexBody, start: Vec3, edge: Vec3) -> (Vec3, f64) {
    let start = normalize(add_scaled(start, edge, -dot(start, edge))).0;
    let (n, _, h) = descend(a, b, start, |n, w, h, hessian| {
        let t = cross(edge, n);
        scale(t, downhill(dot(t, w), hessian(n, t, t)[0] - h))
    });
    (n, h)
}

/// The Newton step along one direction. If the curvature is negative, the step has the length of the Newton step, but
/// leads away from the maximum.
fn downhill(slope: f64, curvature: f64) -> f64 {
    if slope == 0.0 { 0.0 } else { (-slope / curvature.abs()).clamp(-MAX_ROTATION, MAX_ROTATION) }
}

/// Takes steps as long as the extent decreases. A step that does not decrease it is shortened to a quarter. `step`
/// gets a direction n, its support point, the extent, and a function that returns the Hessian for two tangents: ss,
/// st, tt. Returns the final direction, support point and extent.
fn descend(
    a: &mut ConvexBody,
    b: &mut ConvexBody,
    start: Vec3,
    step: impl Fn(Vec3, Vec3, f64, &dyn Fn(Vec3, Vec3, Vec3) -> Vec3) -> Vec3,
) -> (Vec3, Vec3, f64) {
    let mut current = (start, support(a, b, start).point);
    let mut h = dot(current.0, current.1);
    let mut part = 1.0;
    let next_step = |a: &ConvexBody, b: &ConvexBody, (n, w): (Vec3, Vec3), h: f64| {
        step(n, w, h, &|n, s, t| add(a.support_hessian(n, s, t), b.support_hessian(n, s, t)))
    };
    let mut delta = next_step(a, b, current, h);
    for _ in 0..MOST_STEPS {
        let n = normalize(add_scaled(current.0, delta, part)).0;
        let w = support(a, b, n).point;
        let (height, moved) = (dot(n, w), part * norm(delta));
        if height < h {
            (current, h, part) = ((n, w), height, 1.0);
            delta = next_step(a, b, current, h);
        } else {
            part *= 0.25;
        }
        if moved.is_nan() || moved < MIN_STEP {
            break;
        }
    }
    (current.0, current.1, h)
}

/// The nearest or deepest points of both bodies along the direction n of least extent. On an edge normal to n, the
/// support point is arbitrary. It is then moved opposite to the support point of the other body. For two crossing
/// edges, the points at the crossing are taken, and for two parallel edges, the midpoint of their common part. For
/// faces, and for features that might be faces, the bodies are moved until they touch, and a common point is taken.
fn witness(a: &mut ConvexBody, b: &mut ConvexBody, n: Vec3, h: f64, limits: Limits) -> [Vec3; 2] {
    let v = support(a, b, n);
    let offset = scale(n, h);
    if norm(sub(v.point, offset)) <= MIN_STEP * (norm(v.on_a) + norm(v.on_b)) {
        return [v.on_a, v.on_b];
    }
    let mut edges = |angle: f64| [a.kinks(n, angle), b.kinks(scale(n, -1.0), angle)];
    let (along, nearly) = (edges(NORMAL_TO_EDGE), edges(UNCERTAIN_NORMAL));
    let clear = along.iter().zip(&nearly).all(|(x, y)| x.all().len() == y.all().len());
    let around = |p: Vec3| [add_scaled(p, n, 0.5 * h), add_scaled(p, n, -0.5 * h)];
    let from_a = |on_a: Vec3| [on_a, sub(on_a, offset)];
    let from_b = |on_b: Vec3| [add(on_b, offset), on_b];
    let two_faces: [&[Vec3]; 2] = [&[[0.0; 3]; 2]; 2];
    match if clear { along.each_ref().map(|k| k.all()) } else { two_faces } {
        [[], [_, ..]] => from_a(v.on_a),
        [[_, ..], []] => from_b(v.on_b),
        [&[e], &[f]] => {
            let (cosine, between) = (dot(e, f), sub(v.on_b, v.on_a));
            let sine2 = 1.0 - cosine * cosine;
            if sine2 < NEAR * NEAR {
                return from_a(move_along_edge(v.on_a, e, shared_midpoint(a, b, n, e)));
            }
            from_a(add_scaled(v.on_a, e, (dot(e, between) - cosine * dot(f, between)) / sine2))
        }
        _ if norm(sub(v.point, offset)) <= NORMAL_TO_EDGE * (norm(v.on_a) + norm(v.on_b)) => {
            around(scale(add(v.on_a, v.on_b), 0.5))
        }
        _ => {
            let mut moved = b.moved(offset);
            let touching = distance(a, &mut moved, f64::INFINITY, limits).corral;
            b.work = moved.work;
            around(add_scaled(touching.mean(|v| v.on_a), n, -0.5 * h))
        }
    }
}

/// Moves a point along an edge direction until its coordinate along the edge is `coordinate`.
fn move_along_edge(line: Vec3, edge: Vec3, coordinate: f64) -> Vec3 {
    add_scaled(line, edge, coordinate - dot(edge, line))
}

/// The midpoint of the common part of two parallel edges, as a coordinate along them. The ends of the edges are
/// support points of slightly tilted directions.
fn shared_midpoint(a: &mut ConvexBody, b: &mut ConvexBody, n: Vec3, edge: Vec3) -> f64 {
    let end = |body: &mut ConvexBody, towards: f64, side: f64| {
        let tilted = normalize(add_scaled(scale(n, towards), edge, side * TILT)).0;
        dot(edge, body.support(tilted))
    };
    let low = end(a, 1.0, -1.0).max(end(b, -1.0, -1.0));
    let high = end(a, 1.0, 1.0).min(end(b, -1.0, 1.0));
    0.5 * (low + high)
}
