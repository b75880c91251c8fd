//! Divides polygons into triangles: a quadrilateral along its shorter diagonal, larger polygons by ear clipping (Meisters 1975,
//! *Polygons have ears*). The order of the ears is that of MuJoCo 3.14.0, measured on the library.

use crate::math::{Vec3, cross, dot, sub};
use crate::mjcf::gather::listed;

/// The triangles of a polygon, as indexes of its corners. A self-intersecting polygon may be covered only in part.
pub(super) fn triangles(corners: &[Vec3]) -> Vec<[usize; 3]> {
    match corners {
        [_, _, _] => vec![[0, 1, 2]],
        [a, b, c, d] => {
            let (ac, bd) = (sub(*c, *a), sub(*d, *b));
            if dot(ac, ac) < dot(bd, bd) { vec![[0, 1, 2], [0, 2, 3]] } else { vec![[0, 1, 3], [1, 2, 3]] }
        }
        _ => cut_ears(&flattened(corners)),
    }
}

/// The projection of the polygon along the axis with the largest component of the first non-zero cross product of two consecutive
/// sides.
fn flattened(corners: &[Vec3]) -> Vec<[f64; 2]> {
    let n = corners.len();
    let bend = (0..n)
        .map(|k| {
            let [a, b, c] = [k, (k + 1) % n, (k + 2) % n].map(|i| corners[i]);
            cross(sub(b, a), sub(c, b)).map(f64::abs)
        })
        .find(|bend| bend.iter().any(|&x| x > f64::EPSILON));
    let [i, j] = match bend {
        Some([x, y, z]) if x > y && x > z => [1, 2],
        Some([x, y, z]) if z > x && z > y => [0, 1],
        Some(_) => [0, 2],
        None => [1, 2],
    };
    listed(corners.iter().map(|p| [p[i], p[j]]))
}

fn cut_ears(corners: &[[f64; 2]]) -> Vec<[usize; 3]> {
    let mut rest: Vec<usize> = listed(0..corners.len());
    let mut found = Vec::with_capacity(rest.len());
    let (mut ear, mut misses) = (0, 0);
    while rest.len() > 3 && misses <= rest.len() {
        let n = rest.len();
        ear %= n;
        let three = [0, 1, 2].map(|k| rest[(ear + k) % n]);
        let [a, b, c] = three.map(|i| corners[i]);
        let turn = (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0]);
        // The orientation of the polygon is estimated from the area between this side and the origin. The estimate is wrong for
        // some sides, but then another ear is found.
        let sense = a[0] * b[1] - a[1] * b[0];
        let holds = |&i: &usize| !three.contains(&i) && inside([a, b, c], corners[i]);
        if turn * sense < 0.0 || rest.iter().any(holds) {
            ear += 1;
            misses += 1;
            continue;
        }
        found.push(three);
        rest.remove((ear + 1) % n);
        misses = 0;
    }
    if let [a, b, c] = rest[..] {
        found.push([a, b, c]);
    }
    found
}

/// Whether a point is inside a triangle: a ray from it crosses the boundary an odd number of times.
fn inside(triangle: [[f64; 2]; 3], [x, y]: [f64; 2]) -> bool {
    let mut odd = false;
    for k in 0..3 {
        let ([ax, ay], [bx, by]) = (triangle[k], triangle[(k + 2) % 3]);
        if (ay > y) != (by > y) && x < (bx - ax) * (y - ay) / (by - ay) + ax {
            odd = !odd;
        }
    }
    odd
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Regular polygons and a star, in the order of MuJoCo 3.14.0.
    #[test]
    fn ears_are_cut_in_the_order_of_mujoco() {
        let ring = |n: usize, star: bool| -> Vec<Vec3> {
            (0..n)
                .map(|i| {
                    let (r, a) = (
                        if star && i % 2 == 1 { 0.4 } else { 1.0 },
                        2.0 * std::f64::consts::PI * i as f64 / n as f64,
                    );
                    [r * a.cos(), r * a.sin(), 1.0].map(|x| (x * 1e6).round() / 1e6)
                })
                .collect()
        };
        assert_eq!(triangles(&ring(5, false)), [[0, 1, 2], [0, 2, 3], [0, 3, 4]]);
        assert_eq!(triangles(&ring(7, false)), [[0, 1, 2], [0, 2, 3], [0, 3, 4], [4, 5, 6], [0, 4, 6]]);
        assert_eq!(
            triangles(&ring(8, false)),
            [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5], [5, 6, 7], [0, 5, 7]]
        );
        assert_eq!(
            triangles(&ring(10, true)),
            [[1, 2, 3], [1, 3, 4], [1, 4, 5], [1, 5, 6], [7, 8, 9], [7, 9, 0], [7, 0, 1], [1, 6, 7]]
        );
    }

    #[test]
    fn a_polygon_without_ears_terminates() {
        for n in [5, 6, 50, 500] {
            let tangled: Vec<Vec3> =
                (0..n).map(|i| [((i * 7919) % 13) as f64, ((i * 104729) % 17) as f64, 0.0]).collect();
            assert!(triangles(&tangled).len() <= n - 2);
            assert!(triangles(&vec![[1.0; 3]; n]).len() <= n - 2);
        }
    }
}
