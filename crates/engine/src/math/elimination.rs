//! Small systems of linear equations that are not symmetric.

use super::{MINVAL, Spatial, Vec3};

/// x ← a⁻¹ x by Gaussian elimination with partial pivoting. Returns `false` if the matrix is singular. If the angular
/// and the linear part of the system are not coupled, each 3×3 block is solved separately.
pub(crate) fn solve_six(a: &mut [Spatial; 6], x: &mut Spatial) -> bool {
    let [_, _, _, d, e, f] = &a;
    let decoupled = a[..3].iter().all(|r| r[3..] == [0.0; 3]) && [d, e, f].iter().all(|r| r[..3] == [0.0; 3]);
    if !decoupled {
        return eliminate(a, x);
    }
    [0, 3].iter().all(|&first| {
        let mut part: [Vec3; 3] = std::array::from_fn(|r| std::array::from_fn(|c| a[first + r][first + c]));
        let mut y = [x[first], x[first + 1], x[first + 2]];
        let solved = solve_three(&mut part, &mut y);
        x[first..first + 3].copy_from_slice(&y);
        solved
    })
}

/// Solves a system of three equations like [`solve_six`]. A diagonal matrix takes three divisions that are
/// independent of each other.
#[cfg_attr(not(feature = "small"), inline(always))]
fn solve_three(a: &mut [Vec3; 3], x: &mut Vec3) -> bool {
    let [[d0, a01, a02], [a10, d1, a12], [a20, a21, d2]] = *a;
    if [a01, a02, a10, a12, a20, a21] != [0.0; 6] {
        return eliminate(a, x);
    }
    *x = [x[0] / d0, x[1] / d1, x[2] / d2];
    [d0, d1, d2].iter().all(|d| d.abs() >= MINVAL)
}

/// Gaussian elimination with partial pivoting for `N` equations. Returns `false` if a pivot is smaller than
/// [`MINVAL`].
#[cfg_attr(not(feature = "small"), inline(always))]
fn eliminate<const N: usize>(a: &mut [[f64; N]; N], x: &mut [f64; N]) -> bool {
    for k in 0..N {
        let mut best = k;
        for r in k + 1..N {
            if a[r][k].abs() > a[best][k].abs() {
                best = r;
            }
        }
        a.swap(k, best);
        x.swap(k, best);
        if a[k][k].abs() < MINVAL {
            return false;
        }
        for r in k + 1..N {
            let factor = a[r][k] / a[k][k];
            for c in k + 1..N {
                a[r][c] -= factor * a[k][c];
            }
            x[r] -= factor * x[k];
        }
    }
    for k in (0..N).rev() {
        for c in k + 1..N {
            x[k] -= a[k][c] * x[c];
        }
        x[k] /= a[k][k];
    }
    true
}
