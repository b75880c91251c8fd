//! The factorization L D Lᵀ of a small dense symmetric matrix whose size is known at compile time. It needs no square
//! roots (Golub and Van Loan, *Matrix Computations*, 4.1).

/// L (unit diagonal) and D⁻¹ for the rows and columns `FIRST..N` of a symmetric positive definite matrix.
pub(crate) struct Ldl<const N: usize, const FIRST: usize> {
    l: [[f64; N]; N],
    inverse: [f64; N],
}

impl<const N: usize, const FIRST: usize> Ldl<N, FIRST> {
    /// Factorizes G + λ. Only the lower triangle of G is read. `pivot` maps each entry of D to the value that is
    /// used, or rejects it.
    #[cfg_attr(not(feature = "small"), inline(always))]
    fn factor(g: &[[f64; N]; N], lambda: f64, pivot: impl Fn(f64) -> Option<f64>) -> Option<Self> {
        let (mut l, mut inverse) = ([[0.0; N]; N], [0.0; N]);
        for i in FIRST..N {
            // L D left of the diagonal, then D.
            let mut row = g[i];
            row[i] += lambda;
            for j in FIRST..i {
                for k in FIRST..j {
                    row[j] -= row[k] * l[j][k];
                }
                l[i][j] = row[j] * inverse[j];
            }
            for k in FIRST..i {
                row[i] -= row[k] * l[i][k];
            }
            inverse[i] = 1.0 / pivot(row[i])?;
        }
        Some(Ldl { l, inverse })
    }

    /// Factorizes G + λ; `None` if it is not positive definite.
    pub(crate) fn positive(g: &[[f64; N]; N], lambda: f64) -> Option<Self> {
        Self::factor(g, lambda, |d| (d > 0.0).then_some(d))
    }

    /// Factorizes G, with entries of D below `floor` replaced by `floor`.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(crate) fn raised(g: &[[f64; N]; N], floor: f64) -> Option<Self> {
        Self::factor(g, 0.0, |d| Some(d.max(floor)))
    }

    /// G⁻¹ x; the entries before `FIRST` become zero.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(crate) fn solve(&self, mut x: [f64; N]) -> [f64; N] {
        let Ldl { l, inverse } = self;
        x[..FIRST].fill(0.0);
        for i in FIRST..N {
            for k in FIRST..i {
                x[i] -= l[i][k] * x[k];
            }
        }
        for i in (FIRST..N).rev() {
            x[i] *= inverse[i];
            for k in i + 1..N {
                x[i] -= l[k][i] * x[k];
            }
        }
        x
    }
}

#[cfg(test)]
mod tests {
    use super::Ldl;
    use crate::geometry::tests::Random;

    #[test]
    fn the_solution_solves() {
        let mut random = Random(1);
        for _ in 0..1000 {
            let b: [[f64; 5]; 5] = std::array::from_fn(|_| std::array::from_fn(|_| random.within(-1.0, 1.0)));
            let g: [[f64; 5]; 5] = std::array::from_fn(|i| {
                std::array::from_fn(|j| (0..5).map(|k| b[i][k] * b[j][k]).sum::<f64>())
            });
            let load: [f64; 5] = std::array::from_fn(|_| random.within(-1.0, 1.0));
            let lambda = random.within(0.1, 1.0);
            let x = Ldl::<5, 1>::positive(&g, lambda).unwrap().solve(load);
            assert_eq!(x[0], 0.0);
            for i in 1..5 {
                let product: f64 = (1..5).map(|j| g[i][j] * x[j]).sum::<f64>() + lambda * x[i];
                assert!((product - load[i]).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn pivots_are_refused_or_raised() {
        let singular = [[1.0, 0.0], [1.0, 1.0]];
        assert!(Ldl::<2, 0>::positive(&singular, 0.0).is_none());
        let raised = Ldl::<2, 0>::raised(&singular, 0.5).unwrap();
        assert_eq!(raised.solve([0.0, 1.0]), [-2.0, 2.0]);
    }
}
