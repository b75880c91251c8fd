//! The force of one contact with an elliptic cone: the minimum of ½ xᵀ A x + bᵀ x over |x_t / μ| ≤ x₀, or over the
//! friction x_t only if the normal force x₀ is given.
//!
//! With y = x/μ, G = μ A μ and g = μ b the cone is circular and its own dual. y is optimal if and only if G y + g is
//! also in the cone and is orthogonal to y (Boyd and Vandenberghe, *Convex Optimization*, 5.9). There are three
//! cases: g is in the cone and y = 0; the unconstrained minimum -G⁻¹ g is in the cone; y is on the boundary of the
//! cone.
//!
//! Friction for a normal force n is optimal if and only if (G_t + λ) y_t = -(g_t + c n), where c is the first row of
//! G without G₀₀, and λ ≥ 0 is zero unless |y_t| = n. |y_t| decreases as λ increases, and 1/|y_t| is almost linear in
//! λ. Newton's method on 1/|y_t| (Hebden 1973; Moré and Sorensen, *Computing a trust region step*, SIAM Journal on
//! Scientific and Statistical Computing 4, 1983) therefore converges in a few steps. Bounds of λ keep it safe if G_t
//! is singular.
//!
//! On the boundary the remaining problem is convex in n, with the derivatives
//!
//! > φ'(n) = (G₀₀ - λ) n + c·y_t + g₀,  φ''(n) = G₀₀ - λ - c·p + (n + y_t·p)² / (y_t·q),
//!
//! where (G_t + λ) p = c and (G_t + λ) q = y_t. The root of φ' is also found by Newton's method.

use crate::math::broken_invariant;
use crate::math::{Ldl, add_scaled, dot};

/// Fraction of the trace of G_t that is added to its diagonal. It is as small as rounding, and keeps the diagonal
/// positive in directions without friction or inertia.
const DIAGONAL_SHIFT: f64 = 1e-15;
/// Tolerance of |y_t| = n, relative to n.
const SLIP_TOLERANCE: f64 = 1e-14;
/// If Newton's step for n is below this fraction of n, the relative error after it is the square of this, which is
/// rounding.
const LAST_STEP: f64 = 1e-7;
/// Maximum number of Newton steps; about five are needed.
const MOST_STEPS: usize = 60;

/// The friction force for the normal force `n`, in rows 1 to N - 1 of A, `b` and the result. Row 0 is not used.
pub(super) fn friction<const N: usize>(a: &[[f64; N]; N], b: &[f64; N], mu: &[f64; 5], n: f64) -> [f64; N] {
    let scale = scales(mu, 0.0);
    let disc = Disc::new(&scaled(a, &scale));
    let load = std::array::from_fn(|i| -b[i] * scale[i]);
    let y = disc.minimum(&load, n, 0.0).map_or([0.0; N], |found| shortened(found.y, n));
    std::array::from_fn(|i| y[i] * scale[i])
}

/// The force of a whole cone. `guess` is an estimate of the normal force, or zero.
pub(super) fn cone_force<const N: usize>(
    a: &[[f64; N]; N],
    b: &[f64; N],
    mu: &[f64; 5],
    guess: f64,
) -> [f64; N] {
    let scale = scales(mu, 1.0);
    let g: [f64; N] = std::array::from_fn(|i| b[i] * scale[i]);
    if g[0] >= length_of_tangents(&g) {
        return [0.0; N];
    }
    if let Some(factor) = Ldl::<N, 0>::positive(a, 0.0) {
        let free = factor.solve(b.map(|b| -b));
        if length_of_tangents::<N>(&std::array::from_fn(|i| free[i] / scale[i])) <= free[0] {
            return free;
        }
    }
    let y = on_boundary(&scaled(a, &scale), &g, guess);
    std::array::from_fn(|i| y[i] * scale[i])
}

/// The minimum of ½ yᵀ G y + gᵀ y over |y_t| ≤ y₀ where the constraint is active.
fn on_boundary<const N: usize>(matrix: &[[f64; N]; N], g: &[f64; N], guess: f64) -> [f64; N] {
    let disc = Disc::new(matrix);
    let mut couple = matrix[0];
    couple[0] = 0.0;
    let [mut low, mut high] = [0.0, f64::INFINITY];
    let mut n = if guess > 0.0 { guess } else { along_steepest_ray(matrix, g) };
    let mut lambda = 0.0;
    let mut y = [0.0; N];
    for _ in 0..MOST_STEPS {
        let load = std::array::from_fn(|i| -(g[i] + couple[i] * n));
        let Some(Tangents { y: minimizer, lambda: multiplier, factor }) = disc.minimum(&load, n, lambda)
        else {
            break;
        };
        (y, lambda) = (minimizer, multiplier);
        let slope = (matrix[0][0] - lambda) * n + dot(couple, y) + g[0];
        if slope < 0.0 {
            low = n;
        } else {
            high = n;
        }
        let p = factor.solve(couple);
        let mut curvature = matrix[0][0] - lambda - dot(couple, p);
        let mut by_n = p.map(|p| -p);
        if lambda > 0.0 {
            // The condition |y_t| = n determines the derivative of λ with respect to n.
            let q = factor.solve(y);
            let growth = (n + dot(y, p)) / dot(y, q);
            curvature += growth * (n + dot(y, p));
            by_n = add_scaled(by_n, q, growth);
        }
        let newton = -slope / curvature;
        if newton.abs() <= LAST_STEP * n {
            (y, n) = (add_scaled(y, by_n, newton), n + newton);
            break;
        }
        n = match n + newton {
            next if next > low && next < high => next,
            _ if high == f64::INFINITY => 2.0 * n,
            _ => 0.5 * (low + high),
        };
    }
    y = shortened(y, n);
    y[0] = n;
    y
}

/// The normal force at the minimum along the steepest ray from the apex on the boundary.
fn along_steepest_ray<const N: usize>(matrix: &[[f64; N]; N], g: &[f64; N]) -> f64 {
    let pull = length_of_tangents(g);
    let ray: [f64; N] = std::array::from_fn(|i| {
        if i == 0 {
            1.0
        } else if pull > 0.0 {
            -g[i] / pull
        } else {
            0.0
        }
    });
    -dot(ray, *g) / dot(ray, matrix.map(|row| dot(row, ray)))
}

/// The friction problem in coordinates in which the admissible forces form a ball: G_t, and an upper bound of its
/// eigenvalues.
struct Disc<const N: usize> {
    matrix: [[f64; N]; N],
    trace: f64,
}

/// A minimum over the ball, and its multiplier.
struct Tangents<const N: usize> {
    y: [f64; N],
    lambda: f64,
    /// Factorization of G_t + λ.
    factor: Ldl<N, 1>,
}

impl<const N: usize> Disc<N> {
    fn new(matrix: &[[f64; N]; N]) -> Disc<N> {
        let trace: f64 = (1..N).map(|i| matrix[i][i]).sum();
        let mut matrix = *matrix;
        (1..N).for_each(|i| matrix[i][i] += DIAGONAL_SHIFT * trace);
        Disc { matrix, trace }
    }

    /// Solves (G_t + λ) y = load with |y| ≤ n. The search starts at the multiplier `guess`, or at the bounds if it is
    /// outside.
    fn minimum(&self, load: &[f64; N], n: f64, guess: f64) -> Option<Tangents<N>> {
        // If |y| = n, λ lies between these bounds: |load| / (λ + trace) ≤ |y| ≤ |load| / λ.
        let most = length_of_tangents(load) / n;
        let [mut low, mut high] = [(most - self.trace).max(0.0), most];
        let mut lambda = guess.max(low).min(high);
        let mut found = None;
        for _ in 0..MOST_STEPS {
            let Some(factor) = Ldl::<N, 1>::positive(&self.matrix, lambda) else {
                // The matrix is too close to singular: the next λ is further inside the bounds.
                low = lambda;
                lambda = 0.5 * (low + high);
                continue;
            };
            let y = factor.solve(*load);
            let size = length_of_tangents(&y);
            let Tangents { factor, .. } = found.insert(Tangents { y, lambda, factor });
            if size <= n && lambda == 0.0 || (size - n).abs() <= SLIP_TOLERANCE * n || size.is_nan() {
                break;
            }
            if size > n {
                low = lambda;
            } else {
                high = lambda;
            }
            // d|y|²/dλ = -2 yᵀ (G_t + λ)⁻¹ y.
            let newton = lambda + size * size / dot(y, factor.solve(y)) * (size - n) / n;
            let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
            if next == lambda {
                break;
            }
            lambda = next;
        }
        found
    }
}

/// Projects a force onto its cone, in the coordinates in which the cone is circular (Boyd and Vandenberghe, exercise
/// 8.3).
pub(super) fn nearest_in_cone(force: &mut [f64], mu: &[f64; 5]) {
    let Some((normal, tangents)) = force.split_first_mut() else {
        return broken_invariant("a cone has a normal");
    };
    let size = tangents.iter().zip(mu).map(|(f, mu)| (f / mu) * (f / mu)).sum::<f64>().sqrt();
    if size > *normal {
        let onto = (0.5 * (*normal + size)).max(0.0);
        // A force below the apex without friction has no direction to preserve.
        let part = if size > 0.0 { onto / size } else { 0.0 };
        tangents.iter_mut().for_each(|f| *f *= part);
        *normal = onto;
    }
}

/// Scales y_t to the length n if rounding has made it longer.
fn shortened<const N: usize>(y: [f64; N], n: f64) -> [f64; N] {
    let size = length_of_tangents(&y);
    if size > n { y.map(|y| y * (n / size)) } else { y }
}

/// The factors from y to x = μ y: `normal`, then the friction coefficients.
fn scales<const N: usize>(mu: &[f64; 5], normal: f64) -> [f64; N] {
    std::array::from_fn(|i| if i == 0 { normal } else { mu[i - 1] })
}

/// μ A μ.
fn scaled<const N: usize>(a: &[[f64; N]; N], scale: &[f64; N]) -> [[f64; N]; N] {
    std::array::from_fn(|i| std::array::from_fn(|j| a[i][j] * scale[i] * scale[j]))
}

fn length_of_tangents<const N: usize>(x: &[f64; N]) -> f64 {
    x[1..].iter().map(|x| x * x).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::{cone_force, friction, nearest_in_cone};
    use crate::geometry::tests::Random;

    /// The problem is convex: a force is optimal if and only if a gradient step, projected back onto the ellipsoid,
    /// does not change it. The cases include singular matrices, directions without friction, and very small normal
    /// forces. Returns the largest change, relative to the normal force, for regular and for singular matrices.
    fn moves<const N: usize>(cases: usize) -> [f64; 2] {
        let mut r = Random(N as u64);
        let mut worst = [0.0_f64; 2];
        for _ in 0..cases {
            let rank = 1 + r.below(N + 2);
            let rows: Vec<[f64; N]> =
                (0..rank).map(|_| std::array::from_fn(|_| r.within(-1.0, 1.0))).collect();
            let unit = 10f64.powf(r.within(-3.0, 3.0));
            let a: [[f64; N]; N] = std::array::from_fn(|i| {
                std::array::from_fn(|j| unit * rows.iter().map(|row| row[i] * row[j]).sum::<f64>())
            });
            let push = 10f64.powf(r.within(-4.0, 4.0));
            let b: [f64; N] = std::array::from_fn(|_| push * r.within(-1.0, 1.0));
            let none = r.below(10) == 0;
            let mu: [f64; 5] =
                std::array::from_fn(|k| if none && k == 1 { 0.0 } else { 10f64.powf(r.within(-4.0, 0.5)) });
            let normal = 10f64.powf(r.within(-6.0, 3.0));
            let x = friction(&a, &b, &mu, normal);
            assert_eq!(x[0], 0.0);
            // The force is in the ball of y = x/μ.
            let y: Vec<f64> = (1..N).map(|i| if mu[i - 1] > 0.0 { x[i] / mu[i - 1] } else { 0.0 }).collect();
            let length = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
            assert!(length(&y) <= normal * (1.0 + 1e-12), "{y:?} {normal}");
            let slope: Vec<f64> =
                (1..N).map(|i| mu[i - 1] * (b[i] + (1..N).map(|j| a[i][j] * x[j]).sum::<f64>())).collect();
            let steepest = (1..N).map(|i| a[i][i] * mu[i - 1] * mu[i - 1]).sum::<f64>();
            let pull = (1..N).map(|i| (mu[i - 1] * b[i]).abs()).sum::<f64>();
            // A step long enough to show a gradient, in any units.
            let step = normal / (pull + steepest * normal).max(f64::MIN_POSITIVE);
            let moved: Vec<f64> = y.iter().zip(&slope).map(|(y, s)| y - step * s).collect();
            let onto = (normal / length(&moved)).min(1.0);
            let difference: Vec<f64> = moved.iter().zip(&y).map(|(m, y)| m * onto - y).collect();
            let worst = &mut worst[usize::from(rank < N + 1 || none)];
            *worst = worst.max(length(&difference) / normal);
        }
        worst
    }

    #[test]
    fn friction_is_the_best_that_the_cone_allows() {
        for [regular, singular] in [moves::<3>(100_000), moves::<4>(100_000), moves::<6>(100_000)] {
            println!("{regular:e} {singular:e}");
            // Along directions without inertia, forces are accurate only to the square root of rounding.
            assert!(regular < 1e-10 && singular < 1e-7, "{regular:e} {singular:e}");
        }
    }

    /// Optimality conditions in the coordinates in which the cone is circular: y and G y + g are in the cone and
    /// orthogonal. Returns the largest relative violation over random problems.
    fn optimality_violation<const N: usize>(cases: usize, zones: &mut [usize; 3]) -> f64 {
        let mut random = Random(N as u64);
        let mut worst = 0.0_f64;
        for case in 0..cases {
            let rows: [[f64; N]; N] =
                std::array::from_fn(|_| std::array::from_fn(|_| random.within(-1.0, 1.0)));
            let unit = 10f64.powf(random.within(-3.0, 3.0));
            let soft = 10f64.powf(random.within(-4.0, 0.0));
            let a: [[f64; N]; N] = std::array::from_fn(|i| {
                std::array::from_fn(|j| {
                    unit * ((0..N).map(|k| rows[k][i] * rows[k][j]).sum::<f64>()
                        + if i == j { soft } else { 0.0 })
                })
            });
            let push = 10f64.powf(random.within(-4.0, 4.0));
            let b: [f64; N] =
                std::array::from_fn(|i| push * random.within(-1.0, if i == 0 { 0.3 } else { 1.0 }));
            let mu: [f64; 5] = std::array::from_fn(|_| 10f64.powf(random.within(-3.0, 0.5)));
            let guess = if case % 2 == 0 { 0.0 } else { 10f64.powf(random.within(-6.0, 6.0)) };
            let x = cone_force(&a, &b, &mu, guess);
            let scale = |i: usize| if i == 0 { 1.0 } else { mu[i - 1] };
            let length = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
            let y: Vec<f64> = (0..N).map(|i| x[i] / scale(i)).collect();
            let slope: Vec<f64> =
                (0..N).map(|i| scale(i) * (b[i] + (0..N).map(|j| a[i][j] * x[j]).sum::<f64>())).collect();
            // The magnitude of the terms of the slope, to which rounding is proportional.
            let sizes =
                (0..N).map(|i| scale(i) * (b[i].abs() + (0..N).map(|j| (a[i][j] * x[j]).abs()).sum::<f64>()));
            let size = sizes.fold(0.0, f64::max);
            let out = (length(&y[1..]) - y[0]).max(0.0) / y[0].max(f64::MIN_POSITIVE);
            let pull = (length(&slope[1..]) - slope[0]).max(0.0) / size;
            let product: f64 = (0..N).map(|i| y[i] * slope[i]).sum::<f64>().abs();
            let across = product / (size * y[0]).max(f64::MIN_POSITIVE);
            let miss = out.max(pull).max(across);
            assert!(miss < 1e-9, "{miss:e} {out:e} {pull:e} {across:e}: {a:?} {b:?} {mu:?} {guess} {x:?}");
            worst = worst.max(miss);
            zones[if x[0] == 0.0 { 0 } else { 1 + usize::from(length(&y[1..]) < y[0] * (1.0 - 1e-9)) }] += 1;
        }
        worst
    }

    #[test]
    fn forces_of_cones_are_optimal() {
        let mut zones = [0; 3];
        let worst = [
            optimality_violation::<3>(50_000, &mut zones),
            optimality_violation::<4>(50_000, &mut zones),
            optimality_violation::<6>(50_000, &mut zones),
        ];
        println!("{worst:?}, {zones:?} at the apex, on the boundary, inside");
        assert!(zones.iter().all(|&n| n > 1_000), "{zones:?}");
    }

    #[test]
    fn the_nearest_force_of_a_cone() {
        for (force, expected) in [
            ([1.0, 0.1, 0.1], [1.0, 0.1, 0.1]),
            ([1.0, 1.5, 0.0], [2.0, 1.0, 0.0]),
            ([-1.0, 0.0, -0.75], [1.0, 0.0, -0.25]),
            ([-1.0, 0.3, 0.1], [0.0, 0.0, 0.0]),
            ([-1.0, 0.0, 0.0], [0.0, 0.0, 0.0]),
            ([0.0, 0.0, 0.0], [0.0, 0.0, 0.0]),
            ([1.0, 0.0, 0.0], [1.0, 0.0, 0.0]),
        ] {
            let mut x = force;
            nearest_in_cone(&mut x, &[0.5, 0.25, 1.0, 1.0, 1.0]);
            assert_eq!(x, expected);
        }
    }
}
