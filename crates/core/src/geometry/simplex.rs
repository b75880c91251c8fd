//! The point of a simplex nearest to the origin, in barycentric coordinates, by signed volumes.
//!
//! Montanari, Petrinic, Barbieri: *Improving the GJK algorithm for faster and more reliable distance queries
//! between convex objects*, ACM Transactions on Graphics 36 (2017). A coordinate that has not the sign of the
//! whole volume means that the opposite side may be nearer; sides are tried and the nearest kept.

use crate::math::*;

/// Whether two numbers are both positive or both negative.
#[inline]
fn same_sign(a: f64, b: f64) -> bool {
    (a > 0.0 && b > 0.0) || (a < 0.0 && b < 0.0)
}

/// Σ λᵢ pᵢ over the first points.
#[inline]
pub(super) fn combine(coef: &[f64], points: impl Iterator<Item = Vec3>) -> Vec3 {
    let mut terms = coef.iter().zip(points).map(|(&c, p)| scale(p, c));
    let first = terms.next().unwrap_or_default();
    terms.fold(first, add)
}

/// The determinant of the matrix with these columns.
#[inline]
pub(super) fn det(a: Vec3, b: Vec3, c: Vec3) -> f64 {
    a[0] * (b[1] * c[2] - b[2] * c[1])
        + a[1] * (b[2] * c[0] - b[0] * c[2])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
}

/// Coordinates of the nearest point of a simplex of one to four points; the rest is zero.
pub(super) fn nearest(s: [Vec3; 4], n: usize) -> [f64; 4] {
    match n {
        4 => tetrahedron(s),
        3 => {
            let [a, b, c] = triangle([s[0], s[1], s[2]]);
            [a, b, c, 0.0]
        }
        2 => {
            let [a, b] = segment([s[0], s[1]]);
            [a, b, 0.0, 0.0]
        }
        _ => [1.0, 0.0, 0.0, 0.0],
    }
}

/// The nearest of the sides that are asked for: side `i` lacks point `i`.
fn nearest_side<const N: usize, const M: usize>(
    s: [Vec3; N],
    try_side: [bool; N],
    nearest: fn([Vec3; M]) -> [f64; M],
) -> [f64; N] {
    let mut best = [0.0; N];
    let mut least = f64::MAX;
    for i in (0..N).filter(|&i| try_side[i]) {
        let others: [usize; M] = std::array::from_fn(|k| if k < i { k } else { k + 1 });
        let coef = nearest(others.map(|k| s[k]));
        let point = combine(&coef, others.iter().map(|&k| s[k]));
        let dist2 = dot(point, point);
        if dist2 < least {
            least = dist2;
            best = [0.0; N];
            for (k, c) in others.into_iter().zip(coef) {
                best[k] = c;
            }
        }
    }
    best
}

fn tetrahedron(s: [Vec3; 4]) -> [f64; 4] {
    let [a, b, c, d] = s;
    let part = [-det(b, c, d), det(a, c, d), -det(a, b, d), det(a, b, c)];
    let whole = part[0] + part[1] + part[2] + part[3];
    let outside = part.map(|p| !same_sign(whole, p));
    if outside == [false; 4] {
        return part.map(|p| p / whole);
    }
    nearest_side(s, outside, triangle)
}

fn triangle(s: [Vec3; 3]) -> [f64; 3] {
    let [a, b, c] = s;
    let Some(p) = origin_on_plane(a, b, c) else {
        let [a, b] = segment([a, b]);
        return [a, b, 0.0];
    };
    let view = View::of(a, b, c);
    let part = [view.area(p, b, c), view.area(p, c, a), view.area(p, a, b)];
    let outside = part.map(|x| !same_sign(view.whole, x));
    if outside == [false; 3] {
        return part.map(|x| x / view.whole);
    }
    nearest_side(s, outside, segment)
}

fn segment([a, b]: [Vec3; 2]) -> [f64; 2] {
    let along = sub(b, a);
    let p = add_scaled(b, along, -(dot(b, along) / dot(along, along)));
    // Along the axis on which the segment has the longest shadow.
    let shadow = sub(a, b);
    let mut i = 0;
    for k in 1..3 {
        if shadow[k].abs() >= shadow[i].abs() {
            i = k;
        }
    }
    let (u, v) = (p[i] - b[i], a[i] - p[i]);
    if same_sign(shadow[i], u) && same_sign(shadow[i], v) {
        [u / shadow[i], v / shadow[i]]
    } else {
        [0.0, 1.0]
    }
}

/// A triangle as seen along the axis from which it looks largest.
pub(super) struct View {
    axes: [usize; 2],
    /// Twice the signed area of the triangle.
    pub(super) whole: f64,
}

impl View {
    pub(super) fn of(a: Vec3, b: Vec3, c: Vec3) -> View {
        let [x, y, z] = [[1, 2], [0, 2], [0, 1]].map(|axes| {
            let view = View { axes, whole: 0.0 };
            let [i, j] = axes;
            let whole = b[i] * c[j] - b[j] * c[i] - a[i] * c[j] + a[j] * c[i] + a[i] * b[j] - a[j] * b[i];
            View { whole, ..view }
        });
        let size = |v: &View| v.whole.abs();
        if size(&x) >= size(&y) && size(&x) >= size(&z) {
            x
        } else if size(&y) >= size(&z) {
            y
        } else {
            z
        }
    }

    /// Twice the signed area of a triangle.
    pub(super) fn area(&self, a: Vec3, b: Vec3, c: Vec3) -> f64 {
        let [i, j] = self.axes;
        a[i] * b[j] + a[j] * c[i] + b[i] * c[j] - a[i] * c[j] - a[j] * b[i] - c[i] * b[j]
    }
}

/// The origin projected on the plane of a triangle; `None` when the triangle is a line.
pub(super) fn origin_on_plane(a: Vec3, b: Vec3, c: Vec3) -> Option<Vec3> {
    let (ab, ac, bc) = (sub(b, a), sub(c, a), sub(c, b));
    // The same normal from each corner: the first that is not lost in rounding.
    let mut last = [0.0; 3];
    for (edges, corner) in [((bc, ab), b), ((ab, ac), a), ((ac, bc), c)] {
        let normal = cross(edges.0, edges.1);
        let (height, length2) = (dot(normal, corner), dot(normal, normal));
        if length2 == 0.0 {
            return None;
        }
        last = scale(normal, height / length2);
        if height != 0.0 && length2 > MINVAL {
            break;
        }
    }
    Some(last)
}

/// Affine coordinates of a point in the plane of a triangle.
pub(super) fn affine(a: Vec3, b: Vec3, c: Vec3, p: Vec3) -> Vec3 {
    let view = View::of(a, b, c);
    [view.area(p, b, c), view.area(p, c, a), view.area(p, a, b)].map(|x| x / view.whole)
}
