//! The Cholesky factorization of a small dense matrix whose size is known when the engine is compiled (Golub and Van Loan,
//! *Matrix Computations*, 4.2).

/// L with L Lᵀ = G for the rows and columns `FIRST..N` of a symmetric positive matrix G; its diagonal is stored inverted.
pub(crate) struct Cholesky<const N: usize, const FIRST: usize>([[f64; N]; N]);

impl<const N: usize, const FIRST: usize> Cholesky<N, FIRST> {
    /// Of G + λ, of which the lower triangle is read; `None` where a pivot is not positive.
    #[inline]
    pub(crate) fn new(g: &[[f64; N]; N], lambda: f64) -> Option<Self> {
        let mut l = [[0.0; N]; N];
        for i in FIRST..N {
            for j in FIRST..i {
                l[i][j] = (FIRST..j).fold(g[i][j], |sum, k| sum - l[i][k] * l[j][k]) * l[j][j];
            }
            let pivot = (FIRST..i).fold(g[i][i] + lambda, |sum, k| sum - l[i][k] * l[i][k]);
            if pivot.is_nan() || pivot <= 0.0 {
                return None;
            }
            l[i][i] = 1.0 / pivot.sqrt();
        }
        Some(Cholesky(l))
    }

    /// G⁻¹ x; what is before `FIRST` becomes zero.
    #[inline]
    pub(crate) fn solve(&self, mut x: [f64; N]) -> [f64; N] {
        let l = &self.0;
        x[..FIRST].fill(0.0);
        for i in FIRST..N {
            x[i] = (FIRST..i).fold(x[i], |sum, k| sum - l[i][k] * x[k]) * l[i][i];
        }
        for i in (FIRST..N).rev() {
            x[i] = (i + 1..N).fold(x[i], |sum, k| sum - l[k][i] * x[k]) * l[i][i];
        }
        x
    }
}

#[cfg(test)]
mod tests {
    use super::Cholesky;
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
            let x = Cholesky::<5, 1>::new(&g, lambda).unwrap().solve(load);
            assert_eq!(x[0], 0.0);
            for i in 1..5 {
                let product: f64 = (1..5).map(|j| g[i][j] * x[j]).sum::<f64>() + lambda * x[i];
                assert!((product - load[i]).abs() < 1e-12);
            }
        }
        assert!(Cholesky::<2, 0>::new(&[[1.0, 0.0], [2.0, 1.0]], 0.0).is_none());
    }
}
