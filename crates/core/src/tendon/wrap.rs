//! The shortest path from one point to another around a sphere or an infinite cylinder.
//!
//! It lies in a plane: for a sphere the one through its centre and both points, for a cylinder the one across
//! its axis, with heights that follow from unrolling it. In the plane the path is two tangents of a circle and
//! the arc between them. A side point says which way round; inside the circle, it asks for a path that touches
//! the circle from within (MuJoCo's documentation, "Computation: Tendon").

use crate::math::*;

/// What a path goes around.
#[derive(Debug)]
pub(super) struct Round {
    /// Centre, world, m.
    pub(super) pos: Vec3,
    /// Axes, world; a cylinder's axis is the third.
    pub(super) mat: Mat3,
    /// m
    pub(super) radius: f64,
    /// A cylinder, otherwise a sphere.
    pub(super) cylinder: bool,
}

/// The part of a path that lies on the surface.
#[derive(Debug)]
pub(super) struct Arc {
    /// Where it begins, world, m.
    pub(super) from: Vec3,
    /// Where it ends.
    pub(super) to: Vec3,
    /// m
    pub(super) length: f64,
}

type Vec2 = [f64; 2];

/// The two points on the circle and the length between them.
type Touch = ([Vec2; 2], f64);

/// The path around a shape, `None` when the straight line is free.
pub(super) fn around(ends: [Vec3; 2], shape: &Round, side: Option<Vec3>) -> Option<Arc> {
    let local = |x: Vec3| mat_t_mul_vec(&shape.mat, sub(x, shape.pos));
    let p = ends.map(local);
    if p.iter().any(|&p| norm(p) < MINVAL) {
        return None;
    }
    let axes = if shape.cylinder { [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]] } else { plane(p) };
    let flat = |x: Vec3| [dot(x, axes[0]), dot(x, axes[1])];
    let q = p.map(flat);

    let side = side.map(local);
    let ([from, to], mut length) = match side {
        Some(s) if norm(s) < shape.radius => inside(q, shape.radius)?,
        _ => outside(q, shape.radius, side.map(|s| scale(unit(flat(s)), shape.radius)))?,
    };
    let lift = |q: Vec2| add_scaled(scale(axes[0], q[0]), axes[1], q[1]);
    let mut touch = [lift(from), lift(to)];
    if shape.cylinder {
        // On the unrolled surface the path is straight: its height grows evenly along it.
        let (before, after) = (norm2(sub(q[0], from)), norm2(sub(q[1], to)));
        let slope = (p[1][2] - p[0][2]) / (before + length + after);
        touch[0][2] = p[0][2] + slope * before;
        touch[1][2] = p[0][2] + slope * (before + length);
        let rise = touch[1][2] - touch[0][2];
        length = (length * length + rise * rise).sqrt();
    }
    let [from, to] = touch.map(|x| add(mat_mul_vec(&shape.mat, x), shape.pos));
    Some(Arc { from, to, length })
}

/// Axes of the plane through the origin and two points, the first towards the first point.
fn plane(p: [Vec3; 2]) -> [Vec3; 2] {
    let (x, _) = normalize(p[0]);
    let (mut normal, size) = normalize(cross(p[0], p[1]));
    if size < MINVAL {
        // The points and the origin are in line: any plane through the line will do.
        let [a, b, c] = x.map(f64::abs);
        let largest = if b > a && b > c {
            1
        } else if c > a && c > b {
            2
        } else {
            0
        };
        let mut other = [1.0; 3];
        other[largest] = 0.0;
        normal = normalize(cross(x, other)).0;
    }
    [x, normalize(cross(normal, x)).0]
}

/// Around a circle from outside; `side` is a point on it, `None` for the shorter way.
fn outside(q: [Vec2; 2], radius: f64, side: Option<Vec2>) -> Option<Touch> {
    let squares = q.map(|q| dot(q, q));
    let square = radius * radius;
    let span = sub(q[1], q[0]);
    let gap = dot(span, span);
    if squares.iter().any(|&s| s < square) || radius < MINVAL || gap < MINVAL {
        return None;
    }
    // The line is free where it misses the circle, on the right side.
    let nearest = add_scaled(q[0], span, (-dot(span, q[0]) / gap).clamp(0.0, 1.0));
    if dot(nearest, nearest) > square && side.is_none_or(|s| dot(s, nearest) >= 0.0) {
        return None;
    }
    // Tangent points of the two ways round: q r²/|q|² ± the same across, times √(|q|² - r²)/r. For ends opposite
    // each other rounding decides between them, so products are taken in the library's order.
    let tangent = |i: usize, sign: f64| {
        let (r, root) = (sign * radius, (squares[i] - square).sqrt());
        let [x, y] = q[i];
        [(x * square + r * y * root) / squares[i], (y * square - r * x * root) / squares[i]]
    };
    let ways = [1.0, -1.0].map(|sign| [tangent(0, sign), tangent(1, -sign)]);
    let crosses = |t: [Vec2; 2]| intersect([q[0], t[0]], [q[1], t[1]]);
    let merit = |t: [Vec2; 2]| {
        if crosses(t) {
            return -1e4; // worse than any that does not cross
        }
        match side {
            Some(s) => dot(unit(add(t[0], t[1])), s),
            None => -dot(sub(t[0], t[1]), sub(t[0], t[1])),
        }
    };
    let first = merit(ways[0]) > merit(ways[1]);
    let way = if first { ways[0] } else { ways[1] };
    if crosses(way) {
        return None;
    }
    let mut angle = libm::acos(dot(unit(way[0]), unit(way[1])).clamp(-1.0, 1.0));
    let turn = way[0][1] * way[1][0] - way[0][0] * way[1][1];
    if if first { turn < 0.0 } else { turn > 0.0 } {
        angle = 2.0 * std::f64::consts::PI - angle;
    }
    Some((way, radius * angle))
}

/// Touching a circle from inside, in one point: the angles of both straight pieces with the radius there are
/// equal. With z the sine of that angle, A = r/|q₀|, B = r/|q₁| and G the angle between q₀ and q₁,
///
/// > f(z) = asin(A z) + asin(B z) - 2 asin(z) + G = 0
///
/// which Newton's method solves from the right. Where it fails the point is half way between both.
fn inside(q: [Vec2; 2], radius: f64) -> Option<Touch> {
    const ITERATIONS: usize = 20;
    const START: f64 = 1.0 - 1e-7;
    const TOLERANCE: f64 = 1e-6;

    let lengths = q.map(norm2);
    let span = sub(q[1], q[0]);
    let gap = dot(span, span);
    if lengths.iter().any(|&l| l <= radius || l < MINVAL) || radius < MINVAL {
        return None;
    }
    if gap > MINVAL {
        let a = -dot(span, q[0]) / gap;
        if a > 0.0 && a < 1.0 && norm2(add_scaled(q[0], span, a)) <= radius {
            return None;
        }
    }
    let single = |p: Vec2| Some(([p, p], 0.0));
    let half_way = scale(unit(scale(add(q[0], q[1]), 0.5)), radius);
    let [a, b] = lengths.map(|l| radius / l);
    let cosine = (lengths[0] * lengths[0] + lengths[1] * lengths[1] - gap) / (2.0 * lengths[0] * lengths[1]);
    if cosine < MINVAL - 1.0 {
        return None;
    }
    if cosine > 1.0 - MINVAL {
        return single(half_way);
    }
    let between = libm::acos(cosine);
    let f = |z: f64| libm::asin(a * z) + libm::asin(b * z) - 2.0 * libm::asin(z) + between;
    let slope = |z: f64| {
        let term = |c: f64| c / (1.0 - z * z * c * c).sqrt().max(MINVAL);
        term(a) + term(b) - 2.0 * term(1.0)
    };
    let mut z = START;
    let mut value = f(z);
    if value > 0.0 {
        return single(half_way); // the solution is beyond the start
    }
    let mut iteration = 0;
    while iteration < ITERATIONS && value.abs() > TOLERANCE {
        let df = slope(z);
        let next = z - value / df;
        if df > -MINVAL || next > z {
            return single(half_way);
        }
        z = next;
        value = f(z);
        if value > TOLERANCE {
            return single(half_way);
        }
        iteration += 1;
    }
    // Not `value.abs() > TOLERANCE`: a solution in the last iteration does not count, as in MuJoCo.
    if iteration >= ITERATIONS {
        return single(half_way);
    }
    // From the point that comes first, counter-clockwise.
    let counter = q[0][0] * q[1][1] - q[0][1] * q[1][0] > 0.0;
    let (start, ratio) = if counter { (q[0], a) } else { (q[1], b) };
    let (s, c) = libm::sincos(libm::asin(z) - libm::asin(ratio * z));
    let [x, y] = unit(start);
    single(scale([c * x - s * y, s * x + c * y], radius))
}

/// Whether two segments have a point in common; parallel ones have none.
fn intersect(a: [Vec2; 2], b: [Vec2; 2]) -> bool {
    let (u, v, w) = (sub(a[1], a[0]), sub(b[1], b[0]), sub(a[0], b[0]));
    let det = v[1] * u[0] - v[0] * u[1];
    if det.abs() < MINVAL {
        return false;
    }
    let along = [(v[0] * w[1] - v[1] * w[0]) / det, (u[0] * w[1] - u[1] * w[0]) / det];
    along.iter().all(|x| (0.0..=1.0).contains(x))
}

fn norm2(a: Vec2) -> f64 {
    dot(a, a).sqrt()
}

/// a / |a|; the x axis for a vector without direction.
fn unit(a: Vec2) -> Vec2 {
    let n = norm2(a);
    if n < MINVAL { [1.0, 0.0] } else { scale(a, 1.0 / n) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(x: &[f64]) -> Vec3 {
        [x[0], x[1], x[2]]
    }

    fn distance(a: Vec3, b: Vec3) -> f64 {
        norm(sub(a, b))
    }

    /// Every recorded case: `golden/record.py` says what a line holds.
    #[test]
    fn paths_are_those_of_mujoco() {
        let mut counts = [0; 3];
        for line in include_str!("golden/wrap.txt").lines() {
            let free = line.ends_with("free");
            let x: Vec<f64> = line.split(' ').filter_map(|w| w.parse().ok()).collect();
            let mut mat = [0.0; 9];
            mat.copy_from_slice(&x[5..14]);
            let shape = Round { pos: point(&x[2..]), mat, radius: x[1], cylinder: x[0] == 5.0 };
            let (ends, total) = ([point(&x[14..]), point(&x[17..])], x[24]);
            let arc = around(ends, &shape, (x[20] == 1.0).then(|| point(&x[21..])));
            let Some(arc) = arc else {
                assert!(free, "the path is not free: {line}");
                counts[0] += 1;
                continue;
            };
            assert!(!free, "the path is free: {line}");
            let length = distance(ends[0], arc.from) + arc.length + distance(arc.to, ends[1]);
            let touch = [point(&x[25..]), point(&x[28..])];
            let error = [length - total, distance(arc.from, touch[0]), distance(arc.to, touch[1])];
            assert!(error.iter().all(|e| e.abs() < 1e-12), "{error:?} in {line}");
            counts[if arc.length == 0.0 { 2 } else { 1 }] += 1;
        }
        // Free, around, touched from inside: all are there.
        assert!(counts.iter().all(|&n| n > 30), "{counts:?}");
    }

    /// A path around a shape touches it tangentially, and is never shorter than the straight line.
    #[test]
    fn a_string_around_a_cylinder_has_the_closed_form() {
        let shape = Round { pos: [0.0; 3], mat: EYE, radius: 1.0, cylinder: true };
        let arc = around([[-2.0, 0.0, 0.0], [2.0, 0.0, 0.0]], &shape, Some([0.0, 3.0, 0.0])).unwrap();
        // Both tangents leave at 60 degrees: a third of a half circle is between them.
        assert!((arc.length - std::f64::consts::FRAC_PI_3).abs() < 1e-15);
        assert!(distance(arc.from, [-0.5, 0.75f64.sqrt(), 0.0]) < 1e-15);
        assert!(distance(arc.to, [0.5, 0.75f64.sqrt(), 0.0]) < 1e-15);
    }
}
