//! The shortest path from one point to another around a sphere or an infinite cylinder.
//!
//! The path lies in a plane. For a sphere, it is the plane through its centre and both points. For a cylinder, it is the plane
//! perpendicular to its axis, and the heights follow from unrolling the cylinder. In the plane, the path consists of two tangents
//! of a circle and the arc between them. A side point selects the direction around the circle. A side point inside the circle
//! selects a path that touches the circle from the inside (MuJoCo's documentation, "Computation: Tendon").

use crate::math::*;

/// The shape that a path wraps around.
#[derive(Debug)]
pub(super) struct Round {
    /// Centre, world, m.
    pub(super) pos: Vec3,
    /// Orientation, world. The third axis is that of a cylinder.
    pub(super) mat: Mat3,
    /// m
    pub(super) radius: f64,
    /// Whether the shape is a cylinder; otherwise it is a sphere.
    pub(super) cylinder: bool,
}

/// The part of a path on the surface of the shape.
#[derive(Debug)]
pub(super) struct Arc {
    /// Start, world, m.
    pub(super) from: Vec3,
    /// End, world, m.
    pub(super) to: Vec3,
    /// Length, m.
    pub(super) length: f64,
}

type Vec2 = [f64; 2];

/// The two tangent points on the circle, and the length of the arc between them.
type WrapSegment = ([Vec2; 2], f64);

/// The path around a shape, or `None` if the straight line is unobstructed.
///
/// Projected along the third axis of [`frame`], the path is a taut string around a circle. Unrolled, it is a straight line: its
/// height along that axis changes with constant slope.
pub(super) fn around(ends: [Vec3; 2], shape: &Round, side: Option<Vec3>) -> Option<Arc> {
    let radius = shape.radius;
    let ends = ends.map(|x| sub(x, shape.pos));
    let side = side.map(|x| sub(x, shape.pos));
    let [x, y, z] = frame(ends, shape);
    let flat = |v: Vec3| [dot(v, x), dot(v, y)];

    let [first, last] = ends.map(flat);
    let ([from, to], arc) = match side {
        // The documented condition for a path on the inside.
        Some(s) if norm(s) < radius => inside([first, last], radius)?,
        _ => outside([first, last], radius, side.map(|s| scale(unit(flat(s)), radius)))?,
    };

    let [before, after] = [norm2(sub(first, from)), norm2(sub(last, to))];
    let [bottom, top] = ends.map(|v| dot(v, z));
    let slope = (top - bottom) / (before + arc + after);
    let point = |[a, b]: Vec2, path_length: f64| {
        let height = bottom + slope * path_length;
        add_scaled(add_scaled(add_scaled(shape.pos, x, a), y, b), z, height)
    };
    Some(Arc {
        from: point(from, before),
        to: point(to, before + arc),
        length: arc * (1.0 + slope * slope).sqrt(),
    })
}

/// Axes, world. For a cylinder, its own axes. For a sphere, the first two span the plane through its centre and both ends, and
/// the first points to the first end.
fn frame([a, b]: [Vec3; 2], shape: &Round) -> [Vec3; 3] {
    if shape.cylinder {
        return [0, 1, 2].map(|k| [shape.mat[k], shape.mat[3 + k], shape.mat[6 + k]]);
    }
    let (x, _) = normalize(a);
    let (mut y, size) = normalize(sub(b, scale(x, dot(x, b))));
    if size <= MINVAL * norm(b) {
        y = second_axis(x, &shape.mat);
    }
    [x, y, cross(x, y)]
}

/// The second axis of the plane for two ends on a line through the centre of a sphere. Any plane through the line is valid. The
/// choice is that of MuJoCo (measured): the normal of the plane is perpendicular to the line and to a vector. In the axes of the
/// sphere, this vector is (1, 1, 1) with a zero in the place of the line's largest component.
fn second_axis(line: Vec3, mat: &Mat3) -> Vec3 {
    let components = mat_t_mul_vec(mat, line).map(f64::abs);
    let largest = (1..3).fold(0, |most, i| if components[i] > components[most] { i } else { most });
    let mut other = [1.0; 3];
    other[largest] = 0.0;
    normalize(cross(cross(line, mat_mul_vec(mat, other)), line)).0
}

/// A taut string around the outside of a circle. `side` is a point on the circle, or `None` for the shorter direction.
///
/// The tangents from a point at the distance L touch the circle at the angles ±φ from its direction, cos φ = r/L. A
/// counter-clockwise string leaves the tangent of the first point at +φ₀ and reaches that of the second point at -φ₁. A clockwise
/// string is the mirror image. Between the tangent points, it lies on the circle.
fn outside(q: [Vec2; 2], radius: f64, side: Option<Vec2>) -> Option<WrapSegment> {
    let lengths = q.map(norm2);
    let span = sub(q[1], q[0]);
    if lengths.iter().any(|&l| l < radius) || radius < MINVAL || dot(span, span) < MINVAL {
        return None;
    }
    let nearest = nearest_of_segment(q);
    let blocked = norm2(nearest) <= radius;
    if !blocked && side.is_none_or(|s| dot(s, nearest) >= 0.0) {
        return None;
    }
    let directions = [0, 1].map(|i| scale(q[i], 1.0 / lengths[i]));
    // r (cos φ, sin φ). The sine is computed from (L - r)(L + r), which is accurate near the circle.
    let turns = lengths.map(|l| {
        let (cos, sin) = (radius / l, ((l - radius) * (l + radius)).sqrt() / l);
        [radius * cos, radius * sin]
    });
    // The string is counter-clockwise for +1 and clockwise for -1.
    let winding = |sign: f64| {
        let from = rotated_by(directions[0], [turns[0][0], sign * turns[0][1]]);
        let to = rotated_by(directions[1], [turns[1][0], -sign * turns[1][1]]);
        let angle = sign * libm::atan2(cross2(from, to), dot(from, to));
        // A string does not reverse its direction.
        ([from, to], if angle < 0.0 { angle + 2.0 * std::f64::consts::PI } else { angle })
    };
    let windings = [winding(1.0), winding(-1.0)];
    let first = match side {
        // MuJoCo's rule: the direction for which the midpoint of the tangent points is closer to the side point.
        Some(s) if blocked => {
            let towards = |touch: [Vec2; 2]| dot(unit(add(touch[0], touch[1])), s);
            towards(windings[0].0) > towards(windings[1].0)
        }
        // The shorter direction. If the straight line is unobstructed but on the wrong side, the only possible direction.
        // If both have the same length, counter-clockwise, as in MuJoCo.
        _ => windings[0].1 <= windings[1].1,
    };
    let (touch, angle) = if first { windings[0] } else { windings[1] };
    Some((touch, radius * angle))
}

/// The point of a segment that is nearest to the origin.
fn nearest_of_segment([a, b]: [Vec2; 2]) -> Vec2 {
    let span = sub(b, a);
    add_scaled(a, span, (-dot(span, a) / dot(span, span)).clamp(0.0, 1.0))
}

/// A string inside a ring that touches it at one point: the shortest of all paths over a point of the circle. It meets the circle
/// like light is reflected by a mirror (Hero's principle). With θ the angle from the direction of the first end, Δ the angle
/// between both ends, and d the distances to the point,
///
/// > d/dθ (d₀ + d₁) ∝ g(θ) = L₀ sin θ / d₀ - L₁ sin(Δ - θ) / d₁
///
/// where the terms are the sines of the two angles with the radius. Since g(0) ≤ 0 ≤ g(Δ), Newton's method with bisection
/// converges to the last bit. (MuJoCo stops when its own equation is satisfied to 1e-6, and uses the direction halfway between
/// both ends if Newton's method leaves the interval: docs/measured/parity.md.)
fn inside(q: [Vec2; 2], radius: f64) -> Option<WrapSegment> {
    /// Newton's method needs about six iterations, bisection alone fifty.
    const ITERATIONS: usize = 100;

    let lengths = q.map(norm2);
    if lengths.iter().any(|&l| l <= radius || l < MINVAL) || radius < MINVAL {
        return None;
    }
    if norm2(sub(q[1], q[0])) > MINVAL && norm2(nearest_of_segment(q)) <= radius {
        return None;
    }
    let turn = libm::atan2(cross2(q[0], q[1]), dot(q[0], q[1]));
    let between = turn.abs();
    // The sine of the angle with the radius, as a function of the central angle, and its derivative.
    let sine = |length: f64, angle: f64| {
        let (sin, cos) = libm::sincos(angle);
        let half = libm::sin(0.5 * angle);
        // d² = (L - r)² + 4 L r sin²(θ/2) is accurate if the end is near the circle.
        let square = (length - radius) * (length - radius) + 4.0 * length * radius * half * half;
        let distance = square.sqrt();
        let value = length * sin / distance;
        (value, (length * cos - radius * value * value) / distance)
    };
    let (mut low, mut high) = (0.0, between);
    let mut angle = between * lengths[1] / (lengths[0] + lengths[1]);
    for _ in 0..ITERATIONS {
        let ((s0, d0), (s1, d1)) = (sine(lengths[0], angle), sine(lengths[1], between - angle));
        let g = s0 - s1;
        if g < 0.0 {
            low = angle;
        } else {
            high = angle;
        }
        let newton = angle - g / (d0 + d1);
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        if g == 0.0 || next == angle || high - low <= f64::EPSILON * between {
            break;
        }
        angle = next;
    }
    let (sin, cos) = libm::sincos(if turn < 0.0 { -angle } else { angle });
    let point = scale(rotated_by(scale(q[0], 1.0 / lengths[0]), [cos, sin]), radius);
    Some(([point, point], 0.0))
}

/// The product of two vectors as complex numbers: a rotation with scaling.
fn rotated_by(a: Vec2, by: Vec2) -> Vec2 {
    [a[0] * by[0] - a[1] * by[1], a[1] * by[0] + a[0] * by[1]]
}

/// Positive if b is counter-clockwise from a.
fn cross2(a: Vec2, b: Vec2) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

fn norm2(a: Vec2) -> f64 {
    dot(a, a).sqrt()
}

/// a / |a|, or the x axis for a vector without direction.
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

    /// Compares with every recorded case. `golden/record.py` describes the format of a line.
    #[test]
    fn paths_are_those_of_mujoco() {
        let mut counts = [0; 5];
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
            let separation = distance(arc.from, touch[0]).max(distance(arc.to, touch[1]));
            // The path has the same length at another position: the ends are opposite each other, or on one line with the side
            // site on the far side. Both directions have the same length, and rounding selects one of them.
            let by_side = x[20] == 1.0 && around(ends, &shape, None).is_some();
            if !by_side && (length - total).abs() < 1e-12 && separation > 1e-3 {
                counts[3] += 1;
                continue;
            }
            // The straight line is unobstructed and the side site is on its far side. MuJoCo may then take the longer direction.
            if x[20] == 1.0 && length < total - 1e-6 && arc.length > std::f64::consts::PI * shape.radius {
                counts[4] += 1;
                continue;
            }
            if arc.length == 0.0 {
                // MuJoCo stops when its equation is satisfied to 1e-6. The shortest path is at most as long as its path.
                assert!(
                    (length - total).abs() < 1e-13 && separation < 2e-7,
                    "{} {separation:e} in {line}",
                    length - total
                );
                assert!(length <= total + 4.0 * f64::EPSILON * total, "{} longer in {line}", length - total);
                counts[2] += 1;
            } else {
                assert!(
                    (length - total).abs() < 1e-12 && separation < 1e-12,
                    "{} {separation:e} in {line}",
                    length - total
                );
                counts[1] += 1;
            }
        }
        // All cases occur: unobstructed, around, and touching from the inside.
        assert!(counts[..3].iter().all(|&n| n > 30) && counts[3] < 20 && counts[4] < 20, "{counts:?}");
    }

    /// A path around a shape touches it tangentially, and is never shorter than the straight line.
    #[test]
    fn a_string_around_a_cylinder_has_the_closed_form() {
        let shape = Round { pos: [0.0; 3], mat: EYE, radius: 1.0, cylinder: true };
        let arc = around([[-2.0, 0.0, 0.0], [2.0, 0.0, 0.0]], &shape, Some([0.0, 3.0, 0.0])).unwrap();
        // Both tangents touch at 60 degrees from the ends, so that the arc is a third of a half circle.
        assert!((arc.length - std::f64::consts::FRAC_PI_3).abs() < 1e-15);
        assert!(distance(arc.from, [-0.5, 0.75f64.sqrt(), 0.0]) < 1e-15);
        assert!(distance(arc.to, [0.5, 0.75f64.sqrt(), 0.0]) < 1e-15);
    }

    /// The minimum of a convex function on an interval, by ternary search.
    fn minimize_convex(mut low: f64, mut high: f64, f: impl Fn(f64) -> f64) -> f64 {
        for _ in 0..120 {
            let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
            if f(a) < f(b) { high = b } else { low = a }
        }
        f(0.5 * (low + high))
    }

    /// A reference solution without tangents: searches the point where a straight piece meets the circle among all points that
    /// are visible from its end.
    fn reference(q: [f64; 2], angles: [f64; 2], r: f64, inside: bool) -> f64 {
        // The law of cosines, in a form that is accurate for short sides.
        let side = |l: f64, r: f64, a: f64| ((l - r).powi(2) + 4.0 * l * r * (0.5 * a).sin().powi(2)).sqrt();
        let to = |l: f64, a: f64| side(l, r, a);
        let turn = (angles[1] - angles[0]).rem_euclid(2.0 * std::f64::consts::PI);
        let between = turn.min(2.0 * std::f64::consts::PI - turn);
        let seen = q.map(|l| ((l - r) * (l + r)).max(0.0).sqrt().atan2(r));
        let straight = side(q[0], q[1], between);
        if between <= seen[0] + seen[1] {
            let bent = minimize_convex(0.0, between, |a| to(q[0], a) + to(q[1], between - a));
            return if inside { bent } else { straight };
        }
        if inside {
            return straight;
        }
        let piece = |i: usize| minimize_convex(0.0, seen[i], |a| to(q[i], a) - r * a);
        piece(0) + piece(1) + r * between
    }

    #[test]
    fn wrapped_paths_have_minimal_length() {
        let mut state = 1u64;
        let mut random = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        let mut touched = [0; 2];
        for n in 0..100_000 {
            let r = 0.1 + random();
            // Distances from almost on the circle to far away; random angles, and angles that are almost equal or opposite.
            let mut length = || r * (1.0 + 10.0f64.powf(2.0 - 10.0 * random()));
            let q = [length(), length()];
            let first = 6.3 * random();
            let second = match n % 8 {
                0 => first + 1e-9 * random(),
                1 => first + std::f64::consts::PI * (1.0 + 1e-9 * (random() - 0.5)),
                _ => 6.3 * random(),
            };
            let ends = [0, 1].map(|i| {
                let a: f64 = [first, second][i];
                [q[i] * a.cos(), q[i] * a.sin(), 0.0]
            });
            let inside = n % 2 == 1;
            let shape = Round { pos: [0.0; 3], mat: EYE, radius: r, cylinder: n % 3 == 0 };
            let arc = around(ends, &shape, inside.then_some([0.0, 0.0, 0.0]));
            let length = match &arc {
                None => distance(ends[0], ends[1]),
                Some(arc) => distance(ends[0], arc.from) + arc.length + distance(arc.to, ends[1]),
            };
            touched[usize::from(inside)] += usize::from(arc.is_some());
            let best = reference(q, [first, second], r, inside);
            assert!(
                (length - best).abs() < 1e-12 * (q[0] + q[1]),
                "{n}: {length} for {best}, {q:?} {first} {second} {r}"
            );
        }
        assert!(touched.iter().all(|&n| n > 9_000), "{touched:?}");
    }
}
