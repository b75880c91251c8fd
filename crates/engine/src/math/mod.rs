//! Vectors, quaternions, rotation matrices and spatial algebra on plain arrays.
//!
//! Conventions: quaternions are `w x y z`, matrices row-major, spatial vectors angular part first
//! (Featherstone, *Rigid Body Dynamics Algorithms*, 2008, chapter 2). [`rows`] views a flat array as an array of
//! rows.

mod elimination;
mod invariant;
pub(crate) mod lanes;
mod ldl;
mod rotation;
pub(crate) mod sort;

pub(crate) use elimination::solve_six;
pub(crate) use invariant::broken_invariant;
pub(crate) use ldl::Ldl;
pub use rotation::{
    quat_axis_angle, quat_conj, quat_integrate, quat_mul, quat_normalize, quat_to_mat, quat_to_vel, rotate,
};

use std::ops::{Add, Mul, Sub};

/// Floor of every guarded denominator.
pub const MINVAL: f64 = 1e-15;

/// 3-vector.
pub type Vec3 = [f64; 3];
/// Quaternion, `w x y z`.
pub type Quat = [f64; 4];
/// Rotation matrix, row-major.
pub type Mat3 = [f64; 9];
/// Spatial vector: angular, then linear.
pub type Spatial = [f64; 6];
/// Rigid-body inertia about a point: `Ixx Iyy Izz Ixy Ixz Iyz, m·dx m·dy m·dz, m`.
pub type Inertia = [f64; 10];

/// The number type of formulas: one number, or several in SIMD lanes. The same operations in the same order give each
/// lane bit-identical results to the scalar computation.
pub trait Real: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {}

impl<T: Copy + Add<Output = T> + Sub<Output = T> + Mul<Output = T>> Real for T {}

/// Views a flat array as rows of `N`.
#[cfg_attr(not(feature = "small"), inline(always))]
pub fn rows<const N: usize>(a: &[f64]) -> &[[f64; N]] {
    a.as_chunks().0
}

/// Views a flat array as mutable rows of `N`.
#[cfg_attr(not(feature = "small"), inline(always))]
pub fn rows_mut<const N: usize>(a: &mut [f64]) -> &mut [[f64; N]] {
    a.as_chunks_mut().0
}

/// x limited to the range from `low` to `high`. Unlike `f64::clamp`, it never panics for invalid limits. The panic
/// message of `f64::clamp` would also add number formatting to the module.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn clamp(x: f64, low: f64, high: f64) -> f64 {
    if x < low {
        low
    } else if x > high {
        high
    } else {
        x
    }
}

/// Calls `f` with 0, 1, … n - 1. One or two calls, which are common for the state of labs, are made without a loop.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn each(n: usize, mut f: impl FnMut(usize)) {
    match n {
        1 if !SMALL => f(0),
        2 if !SMALL => {
            f(0);
            f(1);
        }
        _ => (0..n).for_each(f),
    }
}

/// Whether the build is optimized for size (feature `small`). Code that exists only for speed is then replaced by a
/// plain loop with the same order of additions.
pub(crate) const SMALL: bool = cfg!(feature = "small");

/// Degrees of freedom of a free body. Loops over this count are common enough to have an unrolled version.
pub(crate) const FREE_DOFS: usize = 6;

/// out ← f(out, inputs), element by element. The inputs are at least as long as `out`. More than two elements are
/// processed in groups of four, so that the compiler can use SIMD lanes.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn combine<const N: usize>(
    out: &mut [f64],
    inputs: [&[f64]; N],
    f: impl Fn(f64, [f64; N]) -> f64,
) {
    match out.len() {
        n if SMALL || n <= 2 => {
            let inputs = inputs.map(|x| &x[..n]);
            each(n, |k| out[k] = f(out[k], inputs.map(|x| x[k])));
        }
        FREE_DOFS => combine_fours(&mut out[..FREE_DOFS], inputs.map(|x| &x[..FREE_DOFS]), f),
        n => combine_fours(out, inputs.map(|x| &x[..n]), f),
    }
}

#[cfg_attr(not(feature = "small"), inline(always))]
fn combine_fours<const N: usize>(out: &mut [f64], inputs: [&[f64]; N], f: impl Fn(f64, [f64; N]) -> f64) {
    let n = out.len();
    let (fours, rest) = out.as_chunks_mut::<4>();
    let (inputs, ends) =
        (inputs.map(|x| &x.as_chunks::<4>().0[..fours.len()]), inputs.map(|x| &x[n - rest.len()..]));
    for (c, four) in fours.iter_mut().enumerate() {
        let x = inputs.map(|x| x[c]);
        *four = std::array::from_fn(|l| f(four[l], x.map(|x| x[l])));
    }
    for (l, out) in rest.iter_mut().enumerate() {
        *out = f(*out, ends.map(|x| x[l]));
    }
}

/// Σ f(inputs) over the elements. All inputs are as long as the first. Four partial sums are accumulated and then
/// added in a fixed order.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn sum<const N: usize>(inputs: [&[f64]; N], f: impl Fn([f64; N]) -> f64) -> f64 {
    match inputs[0].len() {
        n if SMALL => {
            let mut sums = [0.0; 4];
            (0..n).for_each(|k| sums[k % 4] += f(inputs.map(|x| x[k])));
            (sums[0] + sums[2]) + (sums[1] + sums[3])
        }
        FREE_DOFS => sum_fours(inputs.map(|x| &x[..FREE_DOFS]), f),
        n => sum_fours(inputs.map(|x| &x[..n]), f),
    }
}

#[cfg_attr(not(feature = "small"), inline(always))]
fn sum_fours<const N: usize>(inputs: [&[f64]; N], f: impl Fn([f64; N]) -> f64) -> f64 {
    let parts = inputs.map(|x| x.as_chunks::<4>());
    let mut sums = [0.0; 4];
    for c in 0..parts[0].0.len() {
        let x = parts.map(|(fours, _)| fours[c]);
        for l in 0..4 {
            sums[l] += f(x.map(|x| x[l]));
        }
    }
    for l in 0..parts[0].1.len() {
        sums[l] += f(parts.map(|(_, rest)| rest[l]));
    }
    (sums[0] + sums[2]) + (sums[1] + sums[3])
}

/// Copies numbers; the shorter array determines how many.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn copy(from: &[f64], to: &mut [f64]) {
    let n = from.len().min(to.len());
    let (from, to) = (&from[..n], &mut to[..n]);
    match n {
        _ if SMALL => to.copy_from_slice(from),
        0..=2 => each(n, |k| to[k] = from[k]),
        FREE_DOFS => to[..FREE_DOFS].copy_from_slice(&from[..FREE_DOFS]),
        _ => to.copy_from_slice(from),
    }
}

/// Sets all numbers to zero.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn zero(x: &mut [f64]) {
    match x.len() {
        _ if SMALL => x.fill(0.0),
        n @ 0..=2 => each(n, |k| x[k] = 0.0),
        FREE_DOFS => x[..FREE_DOFS].fill(0.0),
        _ => x.fill(0.0),
    }
}

/// The unit quaternion.
pub const IDENTITY: Quat = [1.0, 0.0, 0.0, 0.0];
/// The unit matrix.
pub const EYE: Mat3 = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];

/// a + b
#[cfg_attr(not(feature = "small"), inline(always))]
pub fn add<T: Real, const N: usize>(a: [T; N], b: [T; N]) -> [T; N] {
    let mut r = a;
    for i in 0..N {
        r[i] = r[i] + b[i];
    }
    r
}

/// a - b
#[cfg_attr(not(feature = "small"), inline(always))]
pub fn sub<T: Real, const N: usize>(a: [T; N], b: [T; N]) -> [T; N] {
    let mut r = a;
    for i in 0..N {
        r[i] = r[i] - b[i];
    }
    r
}

/// s a
#[cfg_attr(not(feature = "small"), inline(always))]
pub fn scale<const N: usize>(a: [f64; N], s: f64) -> [f64; N] {
    let mut r = a;
    for x in &mut r {
        *x *= s;
    }
    r
}

/// a + s b
#[cfg_attr(not(feature = "small"), inline(always))]
pub fn add_scaled<const N: usize>(a: [f64; N], b: [f64; N], s: f64) -> [f64; N] {
    let mut r = a;
    for i in 0..N {
        r[i] += s * b[i];
    }
    r
}

/// a · b
#[cfg_attr(not(feature = "small"), inline(always))]
pub fn dot<T: Real, const N: usize>(a: [T; N], b: [T; N]) -> T {
    let mut s = a[0] * b[0];
    for i in 1..N {
        s = s + a[i] * b[i];
    }
    s
}

/// a · b of two spatial vectors, without copies.
#[cfg_attr(not(feature = "small"), inline(always))]
pub fn dot_ref(a: &Spatial, b: &Spatial) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3] + a[4] * b[4] + a[5] * b[5]
}

/// a · b of two slices, in one sum.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn dot_in_order(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).reduce(|sum, x| sum + x).unwrap_or(0.0)
}

/// a · b of two slices of the same length, in two interleaved sums.
#[cfg_attr(not(feature = "small"), inline(always))]
pub fn dot_slice(a: &[f64], b: &[f64]) -> f64 {
    let mut s = [0.0; 2];
    let ((a2, a1), (b2, b1)) = (a.as_chunks::<2>(), b.as_chunks::<2>());
    for (x, y) in a2.iter().zip(b2) {
        s[0] += x[0] * y[0];
        s[1] += x[1] * y[1];
    }
    match (a1, b1) {
        ([x], [y]) => s[0] + s[1] + x * y,
        _ => s[0] + s[1],
    }
}

/// a × b
#[cfg_attr(not(feature = "small"), inline(always))]
pub fn cross<T: Real>(a: [T; 3], b: [T; 3]) -> [T; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// |a|
#[cfg_attr(not(feature = "small"), inline(always))]
pub fn norm(a: Vec3) -> f64 {
    dot(a, a).sqrt()
}

/// a / |a| and |a|; a vector shorter than [`MINVAL`] becomes the x axis.
pub fn normalize(a: Vec3) -> (Vec3, f64) {
    let n = norm(a);
    if n < MINVAL { ([1.0, 0.0, 0.0], n) } else { (scale(a, 1.0 / n), n) }
}

/// a / |a| and |a|, however short a is, for vectors whose length depends on the scale of the scene. Zero becomes the
/// x axis.
pub fn unit_vector(a: Vec3) -> (Vec3, f64) {
    let n = norm(a);
    if n > 0.0 || n.is_nan() { (scale(a, 1.0 / n), n) } else { ([1.0, 0.0, 0.0], n) }
}

/// a b
pub fn mat_mul(a: &Mat3, b: &Mat3) -> Mat3 {
    std::array::from_fn(|i| dot([a[i / 3 * 3], a[i / 3 * 3 + 1], a[i / 3 * 3 + 2]], column(b, i % 3)))
}

/// m v
#[cfg_attr(not(feature = "small"), inline(always))]
pub fn mat_mul_vec(m: &Mat3, v: Vec3) -> Vec3 {
    [
        m[0] * v[0] + m[1] * v[1] + m[2] * v[2],
        m[3] * v[0] + m[4] * v[1] + m[5] * v[2],
        m[6] * v[0] + m[7] * v[1] + m[8] * v[2],
    ]
}

/// mᵀ v
#[cfg_attr(not(feature = "small"), inline(always))]
pub fn mat_t_mul_vec(m: &Mat3, v: Vec3) -> Vec3 {
    [
        m[0] * v[0] + m[3] * v[1] + m[6] * v[2],
        m[1] * v[0] + m[4] * v[1] + m[7] * v[2],
        m[2] * v[0] + m[5] * v[1] + m[8] * v[2],
    ]
}

/// Normal and two tangents as rows. The tangents start from the world's y axis, or z when the normal is
/// near y.
pub(crate) fn frame(normal: Vec3) -> Mat3 {
    let seed = if normal[1] < 0.5 && normal[1] > -0.5 { [0.0, 1.0, 0.0] } else { [0.0, 0.0, 1.0] };
    let (t1, _) = normalize(add_scaled(seed, normal, -dot(seed, normal)));
    let t2 = cross(normal, t1);
    [normal[0], normal[1], normal[2], t1[0], t1[1], t1[2], t2[0], t2[1], t2[2]]
}

/// Normal and two tangents as rows. The first tangent follows the given direction, unless that vector is shorter than
/// 0.5.
pub(crate) fn frame_along(normal: Vec3, tangent: Vec3) -> Mat3 {
    if norm(tangent) < 0.5 {
        return frame(normal);
    }
    let (t1, _) = normalize(add_scaled(tangent, normal, -dot(tangent, normal)));
    let t2 = cross(normal, t1);
    [normal[0], normal[1], normal[2], t1[0], t1[1], t1[2], t2[0], t2[1], t2[2]]
}

/// The largest magnitude that counts as a valid number of a simulation.
pub(crate) const LARGEST: f64 = 1e10;

/// Whether a number is invalid in a simulation: NaN, or larger in magnitude than [`LARGEST`].
#[cfg_attr(not(feature = "small"), inline(always))]
#[allow(clippy::neg_cmp_op_on_partial_ord)] // one comparison that is also false for NaN: it runs for every number of the state
pub(crate) fn bad(x: f64) -> bool {
    !(x.abs() <= LARGEST)
}

/// Column `i` of a matrix.
#[cfg_attr(not(feature = "small"), inline(always))]
pub fn column(m: &Mat3, i: usize) -> Vec3 {
    [m[i], m[3 + i], m[6 + i]]
}

/// The angular part.
#[cfg_attr(not(feature = "small"), inline(always))]
pub fn angular<T: Real>(s: &[T; 6]) -> [T; 3] {
    [s[0], s[1], s[2]]
}

/// The linear part.
#[cfg_attr(not(feature = "small"), inline(always))]
pub fn linear<T: Real>(s: &[T; 6]) -> [T; 3] {
    [s[3], s[4], s[5]]
}

/// v × m for motions: the derivative of the motion m carried by the motion v.
pub fn cross_motion(v: &Spatial, m: &Spatial) -> Spatial {
    let w = cross(angular(v), angular(m));
    let l = add(cross(angular(v), linear(m)), cross(linear(v), angular(m)));
    [w[0], w[1], w[2], l[0], l[1], l[2]]
}

/// v ×* f for forces: the derivative of the momentum f carried by the motion v.
#[cfg_attr(not(feature = "small"), inline(always))]
pub fn cross_force<T: Real>(v: &[T; 6], f: &[T; 6]) -> [T; 6] {
    let t = add(cross(angular(v), angular(f)), cross(linear(v), linear(f)));
    let l = cross(angular(v), linear(f));
    [t[0], t[1], t[2], l[0], l[1], l[2]]
}

/// Inertia about a point, in world axes, of a body with principal moments `moments` along the columns of
/// `axes`, mass `mass` and centre of mass at `d` from the point: R diag(I) Rᵀ + m (|d|² 1 - d dᵀ).
#[cfg_attr(not(feature = "small"), inline(always))]
pub fn inertia_about<T: Real>(moments: [T; 3], axes: &[T; 9], d: [T; 3], mass: T) -> [T; 10] {
    // t = diag(I) Rᵀ, one row per world axis.
    let t = |i: usize| [axes[3 * i] * moments[0], axes[3 * i + 1] * moments[1], axes[3 * i + 2] * moments[2]];
    let r = |i: usize| [axes[3 * i], axes[3 * i + 1], axes[3 * i + 2]];
    let (t0, t1, t2) = (t(0), t(1), t(2));
    [
        dot(r(0), t0) + mass * (d[1] * d[1] + d[2] * d[2]),
        dot(r(1), t1) + mass * (d[0] * d[0] + d[2] * d[2]),
        dot(r(2), t2) + mass * (d[0] * d[0] + d[1] * d[1]),
        dot(r(0), t1) - mass * d[0] * d[1],
        dot(r(0), t2) - mass * d[0] * d[2],
        dot(r(1), t2) - mass * d[1] * d[2],
        mass * d[0],
        mass * d[1],
        mass * d[2],
        mass,
    ]
}

/// Momentum of the motion v of a body with inertia i, both about the same point.
#[cfg_attr(not(feature = "small"), inline(always))]
pub fn inertia_mul<T: Real>(i: &[T; 10], v: &[T; 6]) -> [T; 6] {
    [
        i[0] * v[0] + i[3] * v[1] + i[4] * v[2] - i[8] * v[4] + i[7] * v[5],
        i[3] * v[0] + i[1] * v[1] + i[5] * v[2] + i[8] * v[3] - i[6] * v[5],
        i[4] * v[0] + i[5] * v[1] + i[2] * v[2] - i[7] * v[3] + i[6] * v[4],
        i[8] * v[1] - i[7] * v[2] + i[9] * v[3],
        i[6] * v[2] - i[8] * v[0] + i[9] * v[4],
        i[7] * v[0] - i[6] * v[1] + i[9] * v[5],
    ]
}

/// x limited to a range. An empty range gives its lower end; NaN gives NaN.
#[cfg_attr(not(feature = "small"), inline(always))]
pub fn clip(x: f64, [lower, upper]: [f64; 2]) -> f64 {
    if x < lower {
        lower
    } else if x > upper {
        upper
    } else {
        x
    }
}

/// A spatial vector from its parts.
pub(crate) fn spatial(w: Vec3, v: Vec3) -> Spatial {
    [w[0], w[1], w[2], v[0], v[1], v[2]]
}

/// Whether two slices hold the same numbers, bit for bit.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn same_bits(a: &[f64], b: &[f64]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits())
}

#[cfg(test)]
mod tests;
