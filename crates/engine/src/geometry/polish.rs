//! The direction between two convex bodies, to rounding: Newton's method on the support function of their difference.
//!
//! h(n) = max n·(a - b) bounds the depth from above for every unit vector n, and the depth is its least value; of bodies
//! that are apart, -h(n) is how far a plane across n parts them, and the distance its largest value. Where the bodies are
//! round, h has a gradient, the support point w(n), and a Hessian H(n), the radii of curvature: on the sphere a
//! step δ across n solves (H - h) δ = -w. Where a body has an edge or a face, h has a kink, and the least value lies in it
//! as often as not: then n stays across the edge.

use super::difference::{Limits, support};
use super::gjk::distance;
use super::support::Body;
use crate::math::*;

/// Sine of the angle up to which a kink may be the place where h is least.
const NEAR: f64 = 0.03;
/// Most steps; near its end every one doubles the digits.
const MOST_STEPS: usize = 20;
/// After a step of this length, rad, the next would change nothing.
const SMALL: f64 = 1e-11;
/// Sine of the angle up to which a direction is across an edge.
const HELD: f64 = 1e-6;
/// A support point is along a direction when it is off by no more than this part of its length.
const STRAIGHT: f64 = 1e-8;
/// Most that a direction turns in one step, rad.
const TURN: f64 = 0.3;
/// Sine of the angle up to which a direction may be across it after all.
const UNCLEAR: f64 = 1e-3;
/// Angle that shows the ends of an edge, rad.
const TILT: f64 = 1e-4;
/// Edges of both bodies.
type Kinks = super::list::List<Vec3, 4>;

/// A direction, and how far the difference reaches along it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reach {
    pub(super) normal: Vec3,
    /// m; negative when the bodies are apart.
    pub(super) height: f64,
    /// The nearest or deepest point of each body.
    pub(super) witness: [Vec3; 2],
}

/// The direction near `start` along which the difference reaches least.
pub(super) fn least_reach(a: &mut Body, b: &mut Body, start: Vec3, limits: Limits) -> Reach {
    let mut kinks = Kinks::new();
    let of_a = a.kinks(start, NEAR);
    let of_b = b.kinks(scale(start, -1.0), NEAR);
    of_a.all().iter().chain(of_b.all()).for_each(|&k| kinks.push(k));
    // Never above the start.
    let (mut best, is_flat) = free(a, b, start);
    let mut consider = |found: (Vec3, f64)| {
        if found.1 < best.1 {
            best = found;
        }
    };
    // At the bottom of a bowl nothing nearby is lower.
    let list = if is_flat { &[] } else { kinks.all() };
    for (i, &edge) in list.iter().enumerate() {
        consider(across(a, b, start, edge));
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

/// How far the difference reaches along a direction.
fn height(a: &mut Body, b: &mut Body, n: Vec3) -> (Vec3, f64) {
    (n, dot(n, support(a, b, n).point))
}

/// Downhill in any direction; and whether the bottom of a bowl was found, where the support point is along the direction.
fn free(a: &mut Body, b: &mut Body, start: Vec3) -> ((Vec3, f64), bool) {
    let (n, w, h) = descend(a, b, start, |n, w, h, bend| {
        let f = frame(n);
        let (s, t) = ([f[3], f[4], f[5]], [f[6], f[7], f[8]]);
        let [ss, st, tt] = bend(n, s, t);
        let (ss, tt) = (ss - h, tt - h);
        // The two principal directions: a rotation that makes the matrix diagonal.
        let (sin, cos) = libm::sincos(0.5 * libm::atan2(2.0 * st, ss - tt));
        let (both, mixed) = (cos * cos * ss + sin * sin * tt, 2.0 * sin * cos * st);
        let first = downhill(cos * dot(s, w) + sin * dot(t, w), both + mixed);
        let second = downhill(cos * dot(t, w) - sin * dot(s, w), ss + tt - both - mixed);
        add(scale(s, cos * first - sin * second), scale(t, sin * first + cos * second))
    });
    ((n, h), norm(sub(w, scale(n, h))) <= STRAIGHT * norm(w))
}

/// Downhill among the directions across an edge.
fn across(a: &mut Body, b: &mut Body, start: Vec3, edge: Vec3) -> (Vec3, f64) {
    let start = normalize(add_scaled(start, edge, -dot(start, edge))).0;
    let (n, _, h) = descend(a, b, start, |n, w, h, bend| {
        let t = cross(edge, n);
        scale(t, downhill(dot(t, w), bend(n, t, t)[0] - h))
    });
    (n, h)
}

/// The step of Newton's method along one direction; away from a hilltop as far as it would go to it.
fn downhill(slope: f64, curvature: f64) -> f64 {
    if slope == 0.0 { 0.0 } else { (-slope / curvature.abs()).clamp(-TURN, TURN) }
}

/// Steps as long as they lead down; those that do not are cut to a quarter. `step` gets a direction n, its support point,
/// the height there, and the Hessian between two tangents: ss, st, tt. Returns the first three at the end.
fn descend(
    a: &mut Body,
    b: &mut Body,
    start: Vec3,
    step: impl Fn(Vec3, Vec3, f64, &dyn Fn(Vec3, Vec3, Vec3) -> Vec3) -> Vec3,
) -> (Vec3, Vec3, f64) {
    let mut at = (start, support(a, b, start).point);
    let mut h = dot(at.0, at.1);
    let mut part = 1.0;
    let next_step = |a: &Body, b: &Body, (n, w): (Vec3, Vec3), h: f64| {
        step(n, w, h, &|n, s, t| add(a.bend(n, s, t), b.bend(n, s, t)))
    };
    let mut delta = next_step(a, b, at, h);
    for _ in 0..MOST_STEPS {
        let n = normalize(add_scaled(at.0, delta, part)).0;
        let w = support(a, b, n).point;
        let (height, moved) = (dot(n, w), part * norm(delta));
        if height < h {
            (at, h, part) = ((n, w), height, 1.0);
            delta = next_step(a, b, at, h);
        } else {
            part *= 0.25;
        }
        if moved.is_nan() || moved < SMALL {
            break;
        }
    }
    (at.0, at.1, h)
}

/// The points of both bodies on the line along the least reach. Along an edge a support point may be anywhere: it goes where
/// the other body's is; along edges that cross to the crossing, along parallel ones to the middle of what they share.
/// Faces share a point with what lies on them once the bodies are moved apart so that they touch, and so does what may be
/// a face.
fn witness(a: &mut Body, b: &mut Body, n: Vec3, h: f64, limits: Limits) -> [Vec3; 2] {
    let v = support(a, b, n);
    let apart = scale(n, h);
    if norm(sub(v.point, apart)) <= SMALL * (norm(v.on_a) + norm(v.on_b)) {
        return [v.on_a, v.on_b];
    }
    let mut across = |angle: f64| [a.kinks(n, angle), b.kinks(scale(n, -1.0), angle)];
    let (along, nearly) = (across(HELD), across(UNCLEAR));
    let clear = along.iter().zip(&nearly).all(|(x, y)| x.all().len() == y.all().len());
    let around = |p: Vec3| [add_scaled(p, n, 0.5 * h), add_scaled(p, n, -0.5 * h)];
    let from_a = |on_a: Vec3| [on_a, sub(on_a, apart)];
    let from_b = |on_b: Vec3| [add(on_b, apart), on_b];
    let two_faces: [&[Vec3]; 2] = [&[[0.0; 3]; 2]; 2];
    match if clear { along.each_ref().map(|k| k.all()) } else { two_faces } {
        [[], [_, ..]] => from_a(v.on_a),
        [[_, ..], []] => from_b(v.on_b),
        [&[e], &[f]] => {
            let (cosine, between) = (dot(e, f), sub(v.on_b, v.on_a));
            let sine2 = 1.0 - cosine * cosine;
            if sine2 < NEAR * NEAR {
                return from_a(onto(v.on_a, e, shared_middle(a, b, n, e)));
            }
            from_a(add_scaled(v.on_a, e, (dot(e, between) - cosine * dot(f, between)) / sine2))
        }
        _ if norm(sub(v.point, apart)) <= HELD * (norm(v.on_a) + norm(v.on_b)) => {
            around(scale(add(v.on_a, v.on_b), 0.5))
        }
        _ => {
            let mut moved = b.moved(apart);
            let touching = distance(a, &mut moved, f64::INFINITY, limits).corral;
            b.work = moved.work;
            around(add_scaled(touching.mean(|v| v.on_a), n, -0.5 * h))
        }
    }
}

/// The point of a line where its coordinate is `at`.
fn onto(line: Vec3, edge: Vec3, at: f64) -> Vec3 {
    add_scaled(line, edge, at - dot(edge, line))
}

/// The middle of what both bodies have of an edge, as a coordinate along it: tilted a little to and fro they touch with
/// its ends.
fn shared_middle(a: &mut Body, b: &mut Body, n: Vec3, edge: Vec3) -> f64 {
    let end = |body: &mut Body, towards: f64, side: f64| {
        let tilted = normalize(add_scaled(scale(n, towards), edge, side * TILT)).0;
        dot(edge, body.support(tilted))
    };
    let low = end(a, 1.0, -1.0).max(end(b, -1.0, -1.0));
    let high = end(a, 1.0, 1.0).min(end(b, -1.0, 1.0));
    0.5 * (low + high)
}
