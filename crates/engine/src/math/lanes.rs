//! SIMD lanes. They hold the three components of one vector, or the same component of four bodies in a computation
//! that is identical for all bodies and independent between them.

use crate::math::{Mat3, Vec3};
use std::array::from_fn;
use wide::f64x4;

/// Transposes the rows of four bodies: lane i of result k is component k of the row of body `of[i]`.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn gather<const N: usize>(rows: &[[f64; N]], indexes: [usize; 4]) -> [f64x4; N] {
    let [a, b, c, d] = indexes.map(|i| &rows[i]);
    from_fn(|k| f64x4::new([a[k], b[k], c[k], d[k]]))
}

/// One number of each of four bodies.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn gather_one(numbers: &[f64], indexes: [usize; 4]) -> f64x4 {
    f64x4::new(indexes.map(|i| numbers[i]))
}

/// Writes lanes back to the rows of four bodies: the inverse of [`gather`].
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn scatter<const N: usize>(lanes: [f64x4; N], rows: &mut [[f64; N]], indexes: [usize; 4]) {
    let columns = lanes.map(|v| v.to_array());
    for (lane, i) in indexes.into_iter().enumerate() {
        rows[i] = from_fn(|k| columns[k][lane]);
    }
}

/// The sum of the lanes, in an order that is the same on every processor.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn total(lanes: f64x4) -> f64 {
    let [a, b, c, d] = lanes.to_array();
    (a + c) + (b + d)
}

/// The bodies 1 to n-1 in groups of four. The last body is repeated to fill the last group; computing it more than
/// once gives the same result.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn by_fours(n: usize) -> impl Iterator<Item = [usize; 4]> {
    let last = n.saturating_sub(1);
    (1..n).step_by(4).map(move |first| from_fn(|lane| (first + lane).min(last)))
}

/// A 3-vector in SIMD lanes; the fourth lane repeats the third.
pub(crate) type Lane3 = f64x4;

/// The columns of a rotation matrix.
pub(crate) type Axes = [Lane3; 3];

#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn lane3(v: Vec3) -> Lane3 {
    f64x4::new([v[0], v[1], v[2], v[2]])
}

#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn vec3(v: Lane3) -> Vec3 {
    let [x, y, z, _] = v.to_array();
    [x, y, z]
}

/// The columns of a matrix as lanes.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn axes(m: &Mat3) -> Axes {
    from_fn(|c| lane3([m[c], m[3 + c], m[6 + c]]))
}

/// The matrix with the given columns.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn matrix(axes: &Axes) -> Mat3 {
    let [a, b, c] = axes.map(|v| v.to_array());
    [a[0], b[0], c[0], a[1], b[1], c[1], a[2], b[2], c[2]]
}

/// The vector whose components in the frame `axes` are v.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn along(axes: &Axes, v: Vec3) -> Lane3 {
    axes[0] * v[0] + axes[1] * v[1] + axes[2] * v[2]
}

/// The product of two matrices by columns: `axes` times the matrix with the columns `columns`.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn product(axes: &Axes, columns: &[Vec3; 3]) -> Axes {
    columns.map(|c| along(axes, c))
}

/// Rotates the columns of a matrix about a unit vector, given in the frame of the columns, by the angle with sine s
/// and cosine c.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn rotate_columns(m: &Mat3, axis: Vec3, s: f64, c: f64) -> Mat3 {
    matrix(&turned(&axes(m), axis, s, c))
}

/// Rotates axes about a unit vector, given in the frame of the axes, by the angle with sine s and cosine c.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn turned(axes: &Axes, axis: Vec3, s: f64, c: f64) -> Axes {
    let [x, y, z] = *axes;
    // Rotation about one of the axes only mixes the other two.
    let plane = |a: Lane3, b: Lane3, s: f64| (a * c + b * s, b * c - a * s);
    if axis[2].abs() == 1.0 {
        let (x, y) = plane(x, y, s * axis[2]);
        return [x, y, z];
    }
    if axis[1].abs() == 1.0 {
        let (z, x) = plane(z, x, s * axis[1]);
        return [x, y, z];
    }
    if axis[0].abs() == 1.0 {
        let (y, z) = plane(y, z, s * axis[0]);
        return [x, y, z];
    }
    let t = 1.0 - c;
    let [x, y, z] = axis;
    let columns = [
        [c + t * x * x, t * x * y + s * z, t * x * z - s * y],
        [t * x * y - s * z, c + t * y * y, t * y * z + s * x],
        [t * x * z + s * y, t * y * z - s * x, c + t * z * z],
    ];
    product(axes, &columns)
}
