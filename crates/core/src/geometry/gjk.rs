//! Distance of convex bodies by the algorithm of Gilbert, Johnson and Keerthi (1988) on their Minkowski
//! difference a - b: the bodies overlap when it holds the origin.
//!
//! Stops on the duality gap of Frank and Wolfe: x·(x - s) bounds how much nearer the origin can be.

use super::simplex::{combine, nearest};
use super::support::Body;
use crate::math::*;

/// A point of the Minkowski difference and where it comes from.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Vertex {
    pub(super) on_a: Vec3,
    pub(super) on_b: Vec3,
    /// a - b
    pub(super) point: Vec3,
    /// Corners of discrete bodies.
    pub(super) corners: [i32; 2],
}

/// The support point of the difference in a direction of unit length.
pub(super) fn support(a: &mut Body, b: &mut Body, dir: Vec3) -> Vertex {
    let (on_a, on_b) = (a.support(dir), b.support(scale(dir, -1.0)));
    Vertex { on_a, on_b, point: sub(on_a, on_b), corners: [a.corner, b.corner] }
}

/// Accuracy and effort.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limits {
    /// `opt.ccd_tolerance`, m.
    pub(crate) tolerance: f64,
    /// `opt.ccd_iterations`.
    pub(crate) iterations: usize,
}

/// What came out: a distance, or a simplex that holds the origin.
#[derive(Clone, Copy, Debug)]
pub(super) struct Gjk {
    /// Distance, m; zero when the bodies overlap, [`f64::MAX`] when they are farther apart than asked.
    pub(super) dist: f64,
    /// The nearest points of both bodies, when there are any.
    pub(super) witness: Option<[Vec3; 2]>,
    pub(super) simplex: [Vertex; 4],
    pub(super) size: usize,
    /// Iterations.
    pub(super) steps: usize,
}

/// Distance up to `cutoff`; a cutoff of zero or less asks only whether the bodies touch.
pub(super) fn gjk(a: &mut Body, b: &mut Body, cutoff: f64, limits: Limits) -> Gjk {
    let measure = cutoff > 0.0;
    let mut search = !measure;
    // Bodies with corners only are found exactly.
    let gap = if a.discrete() && b.discrete() { 0.0 } else { 0.5 * limits.tolerance * limits.tolerance };
    let mut simplex = [Vertex::default(); 4];
    let mut coef = [1.0, 0.0, 0.0, 0.0];
    let (mut n, mut k) = (0, 0);
    let mut x = sub(a.centre(), b.centre());
    let mut length = 0.0;
    let apart =
        |steps: usize| Gjk { dist: f64::MAX, witness: None, simplex: [Vertex::default(); 4], size: 0, steps };
    while k < limits.iterations {
        let length2 = dot(x, x);
        length = length2.sqrt();
        if length2 < MINVAL * MINVAL {
            break;
        }
        let s = support(a, b, scale(scale(x, 1.0 / length), -1.0));
        simplex[n] = s;
        if dot(x, sub(x, s.point)) < gap {
            n = n.max(usize::from(k == 0));
            break;
        }
        // The plane through s across x separates the bodies.
        let ahead = dot(x, s.point);
        if ahead > 0.0 && (!measure || (cutoff < f64::MAX && ahead * ahead / length2 >= cutoff * cutoff)) {
            return apart(k);
        }
        if n == 3 && search {
            match enclose(&mut simplex, a, b, &mut k, limits.iterations) {
                Some(true) => return Gjk { dist: 0.0, witness: None, simplex, size: 4, steps: k },
                Some(false) => return apart(k),
                None => search = false,
            }
        }
        coef = nearest(simplex.map(|v| v.point), n + 1);
        n = 0;
        for i in 0..4 {
            if coef[i] != 0.0 {
                (simplex[n], coef[n]) = (simplex[i], coef[i]);
                n += 1;
            }
        }
        if n == 0 {
            return apart(k);
        }
        let next = combine(&coef[..n], simplex.iter().map(|v| v.point));
        if sub(next, x).iter().all(|d| d.abs() < MINVAL) {
            break;
        }
        x = next;
        if n == 4 {
            length = 0.0;
            break;
        }
        length = norm(x);
        k += 1;
    }
    if n == 0 {
        // Coincident centres.
        return Gjk { dist: length, witness: Some([a.centre(), b.centre()]), simplex, size: 0, steps: k };
    }
    let on_a = combine(&coef[..n], simplex.iter().map(|v| v.on_a));
    let on_b = combine(&coef[..n], simplex.iter().map(|v| v.on_b));
    Gjk { dist: length, witness: Some([on_a, on_b]), simplex, size: n, steps: k }
}

/// Moves a tetrahedron towards the origin, one corner at a time: whether it came to hold the origin, or `None`
/// when that cannot be told.
fn enclose(
    simplex: &mut [Vertex; 4],
    a: &mut Body,
    b: &mut Body,
    k: &mut usize,
    most: usize,
) -> Option<bool> {
    let mut v = *simplex;
    // Corners in an order that keeps the orientation.
    let mut at = [0, 1, 2, 3];
    while *k < most {
        // Side i lacks corner i; its normal points to the inside where that corner is.
        let sides = [[2, 1, 3], [0, 2, 3], [1, 0, 3], [0, 1, 2]].map(|s| side(s.map(|i| v[at[i]].point)));
        if sides.iter().any(|s| s.0 == 0.0) {
            return None;
        }
        let lower = |i: usize, j: usize| if sides[i].0 < sides[j].0 { i } else { j };
        let worst = lower(lower(0, 1), lower(2, 3));
        let (dist, normal) = sides[worst];
        if dist > 0.0 {
            *simplex = at.map(|i| v[i]);
            return Some(true);
        }
        let new = support(a, b, normal);
        v[at[worst]] = new;
        if dot(normal, new.point) < 0.0 {
            return Some(false);
        }
        at.swap((worst + 1) % 4, (worst + 2) % 4);
        *k += 1;
    }
    None
}

/// Signed distance of a side from the origin, and its normal; very far when it has none.
fn side([a, b, c]: [Vec3; 3]) -> (f64, Vec3) {
    let normal = cross(sub(c, a), sub(b, a));
    let length2 = dot(normal, normal);
    if length2 > MINVAL * MINVAL && length2 < 1e20 {
        let normal = scale(normal, 1.0 / length2.sqrt());
        (dot(normal, a), normal)
    } else {
        (f64::MAX, normal)
    }
}
