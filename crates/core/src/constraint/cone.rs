//! The force of friction of one contact when its normal force is known: the nearest that an elliptic cone allows.
//!
//! min ½ xᵀ A x + bᵀ x over Σ (xⱼ/μⱼ)² ≤ r². With y = x/μ the ellipsoid is a ball, and a force is the answer when and only
//! when (G + λ) y = -g with G = μ A μ, g = μ b, and λ ≥ 0 is zero unless |y| = r. The length of y falls as λ grows, and
//! 1/|y| is almost linear in it: Newton's method on that (Hebden 1973; Moré and Sorensen, *Computing a trust region step*,
//! SIAM Journal on Scientific and Statistical Computing 4, 1983) meets r in a few steps, between bounds that hold it where
//! G is singular.

use crate::math::dot;

/// Part of the trace of G that is added to it: rounding, and a direction without friction, or without mass, has a diagonal.
const RIDGE: f64 = 1e-15;
/// Part of r that |y| may miss it by.
const CLOSE: f64 = 1e-14;
/// Newton's method needs about five.
const MOST_STEPS: usize = 60;

/// The friction with a given normal force `r`, in the rows 1 to N - 1 of A, `b` and the result; row 0 is left out.
pub(super) fn friction<const N: usize>(a: &[[f64; N]; N], b: &[f64; N], mu: &[f64; 5], r: f64) -> [f64; N] {
    let scale: [f64; N] = std::array::from_fn(|i| if i == 0 { 0.0 } else { mu[i - 1] });
    let g: [f64; N] = std::array::from_fn(|i| -b[i] * scale[i]);
    let mut matrix: [[f64; N]; N] =
        std::array::from_fn(|i| std::array::from_fn(|j| a[i][j] * scale[i] * scale[j]));
    let trace: f64 = (1..N).map(|i| matrix[i][i]).sum();
    // Where |y| = r, λ lies between these: |g| / (λ + trace) ≤ |y| ≤ |g| / λ.
    let most = dot(g, g).sqrt() / r;
    let [mut low, mut high] = [(most - trace).max(0.0), most];
    (1..N).for_each(|i| matrix[i][i] += RIDGE * trace);
    let mut lambda = low;
    let mut y = [0.0; N];
    for _ in 0..MOST_STEPS {
        let Some(factor) = factor(&matrix, lambda) else {
            // Too near to singular: further inside.
            low = lambda;
            lambda = 0.5 * (low + high);
            continue;
        };
        y = solve(&factor, g);
        let size = dot(y, y).sqrt();
        if size <= r && lambda == 0.0 || (size - r).abs() <= CLOSE * r || size.is_nan() {
            break;
        }
        if size > r {
            low = lambda
        } else {
            high = lambda
        }
        // d|y|²/dλ = -2 yᵀ (G + λ)⁻¹ y.
        let newton = lambda + size * size / dot(y, solve(&factor, y)) * (size - r) / r;
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        if next == lambda {
            break;
        }
        lambda = next;
    }
    let size = dot(y, y).sqrt();
    let onto = if size > r { r / size } else { 1.0 };
    std::array::from_fn(|i| y[i] * scale[i] * onto)
}

/// Cholesky factor of G + λ without its first row; `None` when a pivot is not positive.
fn factor<const N: usize>(g: &[[f64; N]; N], lambda: f64) -> Option<[[f64; N]; N]> {
    let mut l = [[0.0; N]; N];
    for i in 1..N {
        for j in 1..=i {
            let sum: f64 = (1..j).map(|k| l[i][k] * l[j][k]).sum();
            let rest = g[i][j] - sum + if i == j { lambda } else { 0.0 };
            l[i][j] = if i != j {
                rest / l[j][j]
            } else if rest > 0.0 {
                rest.sqrt()
            } else {
                return None;
            };
        }
    }
    Some(l)
}

/// (L Lᵀ)⁻¹ x without the first row.
fn solve<const N: usize>(l: &[[f64; N]; N], mut x: [f64; N]) -> [f64; N] {
    for i in 1..N {
        let sum: f64 = (1..i).map(|k| l[i][k] * x[k]).sum();
        x[i] = (x[i] - sum) / l[i][i];
    }
    for i in (1..N).rev() {
        let sum: f64 = (i + 1..N).map(|k| l[k][i] * x[k]).sum();
        x[i] = (x[i] - sum) / l[i][i];
    }
    x[0] = 0.0;
    x
}

#[cfg(test)]
mod tests {
    use super::friction;
    use crate::geometry::tests::Random;

    /// A convex problem: a force is the answer when and only when a step downhill, brought back into the ellipsoid, leaves
    /// it where it is. Whatever the matrix, singular ones, no friction in a direction, and hardly any normal force included.
    /// How far it moves at most, as a part of the normal force: with a regular matrix, with a singular one.
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
            // In the ball of y = x/μ.
            let y: Vec<f64> = (1..N).map(|i| if mu[i - 1] > 0.0 { x[i] / mu[i - 1] } else { 0.0 }).collect();
            let length = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
            assert!(length(&y) <= normal * (1.0 + 1e-12), "{y:?} {normal}");
            let slope: Vec<f64> =
                (1..N).map(|i| mu[i - 1] * (b[i] + (1..N).map(|j| a[i][j] * x[j]).sum::<f64>())).collect();
            let steepest = (1..N).map(|i| a[i][i] * mu[i - 1] * mu[i - 1]).sum::<f64>();
            let pull = (1..N).map(|i| (mu[i - 1] * b[i]).abs()).sum::<f64>();
            // Far enough that a slope is seen, whatever the units.
            let step = normal / (pull + steepest * normal).max(f64::MIN_POSITIVE);
            let moved: Vec<f64> = y.iter().zip(&slope).map(|(y, s)| y - step * s).collect();
            let onto = (normal / length(&moved)).min(1.0);
            let apart: Vec<f64> = moved.iter().zip(&y).map(|(m, y)| m * onto - y).collect();
            let worst = &mut worst[usize::from(rank < N + 1 || none)];
            *worst = worst.max(length(&apart) / normal);
        }
        worst
    }

    #[test]
    fn friction_is_the_best_that_the_cone_allows() {
        for [regular, singular] in [moves::<3>(100_000), moves::<4>(100_000), moves::<6>(100_000)] {
            println!("{regular:e} {singular:e}");
            // Along what has no mass a force is known to the root of rounding.
            assert!(regular < 1e-10 && singular < 1e-7, "{regular:e} {singular:e}");
        }
    }
}
