//! Explicit Runge–Kutta methods, in the coordinates of a step.

use super::flow;
use crate::math::combine;
use crate::model::{Fields, Model};
use crate::step::workspace::StepScratch;

/// A method. Stage s starts from the state at the start of the step plus h times the slopes of the previous stages, with the
/// weights of its row. The result uses `weights`. The first stage is the state at the start itself and has no row.
pub(super) struct ButcherTableau {
    rows: &'static [&'static [f64]],
    weights: &'static [f64],
}

/// The classic method of fourth order (Kutta 1901).
pub(super) const FOURTH: ButcherTableau = ButcherTableau {
    rows: &[&[0.5], &[0.0, 0.5], &[0.0, 0.0, 1.0]],
    weights: &[1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0],
};

/// √21
const R: f64 = 4.582_575_694_955_84;

/// A method of eighth order with eleven stages (Cooper and Verner 1972, *Some explicit Runge-Kutta methods of high order*), whose
/// stages are at the nodes of Lobatto quadrature.
pub(super) const EIGHTH: ButcherTableau = ButcherTableau {
    rows: &[
        &[1.0 / 2.0],
        &[1.0 / 4.0, 1.0 / 4.0],
        &[1.0 / 7.0, (-7.0 - 3.0 * R) / 98.0, (21.0 + 5.0 * R) / 49.0],
        &[(11.0 + R) / 84.0, 0.0, (18.0 + 4.0 * R) / 63.0, (21.0 - R) / 252.0],
        &[(5.0 + R) / 48.0, 0.0, (9.0 + R) / 36.0, (-231.0 + 14.0 * R) / 360.0, (63.0 - 7.0 * R) / 80.0],
        &[
            (10.0 - R) / 42.0,
            0.0,
            (-432.0 + 92.0 * R) / 315.0,
            (633.0 - 145.0 * R) / 90.0,
            (-504.0 + 115.0 * R) / 70.0,
            (63.0 - 13.0 * R) / 35.0,
        ],
        &[1.0 / 14.0, 0.0, 0.0, 0.0, (14.0 - 3.0 * R) / 126.0, (13.0 - 3.0 * R) / 63.0, 1.0 / 9.0],
        &[
            1.0 / 32.0,
            0.0,
            0.0,
            0.0,
            (91.0 - 21.0 * R) / 576.0,
            11.0 / 72.0,
            (-385.0 - 75.0 * R) / 1152.0,
            (63.0 + 13.0 * R) / 128.0,
        ],
        &[
            1.0 / 14.0,
            0.0,
            0.0,
            0.0,
            1.0 / 9.0,
            (-733.0 - 147.0 * R) / 2205.0,
            (515.0 + 111.0 * R) / 504.0,
            (-51.0 - 11.0 * R) / 56.0,
            (132.0 + 28.0 * R) / 245.0,
        ],
        &[
            0.0,
            0.0,
            0.0,
            0.0,
            (-42.0 + 7.0 * R) / 18.0,
            (-18.0 + 28.0 * R) / 45.0,
            (-273.0 - 53.0 * R) / 72.0,
            (301.0 + 53.0 * R) / 72.0,
            (28.0 - 28.0 * R) / 45.0,
            (49.0 - 7.0 * R) / 18.0,
        ],
    ],
    weights: &[1.0 / 20.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 49.0 / 180.0, 16.0 / 45.0, 49.0 / 180.0, 1.0 / 20.0],
};

/// Makes a step.
pub(super) fn explicit(m: &Model, d: &mut Fields, s: &mut StepScratch, method: &ButcherTableau) {
    let h = m.opt.timestep;
    let mut w = flow::enter(m, d, s, method.weights.len());
    let n = w.start.len();
    let (mut rows, mut end) = (std::mem::take(&mut w.rows), std::mem::take(&mut w.end));
    rows[..n].copy_from_slice(&w.first);
    for (stage, row) in method.rows.iter().enumerate() {
        let (earlier, next) = rows.split_at_mut((stage + 1) * n);
        along(&w.start, h, row, earlier, &mut end);
        flow::slope(m, d, s, &w, h * row.iter().sum::<f64>(), &end, &mut next[..n]);
    }
    along(&w.start, h, method.weights, &rows, &mut end);
    (w.rows, w.end) = (rows, end);
    flow::finish(m, d, s, w);
}

/// out ← start + h Σ weight slope
pub(super) fn along(start: &[f64], h: f64, weights: &[f64], slopes: &[f64], out: &mut [f64]) {
    out.copy_from_slice(start);
    for (&weight, slope) in weights.iter().zip(slopes.chunks_exact(start.len().max(1))) {
        if weight != 0.0 {
            combine(out, [slope], |y, [k]| y + h * weight * k);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The quadrature conditions Σ b cᵏ⁻¹ = 1/k hold up to the order of the method. c are the row sums, b the weights.
    #[test]
    fn conditions_of_order() {
        for (method, order) in [(&FOURTH, 4), (&EIGHTH, 8)] {
            let mut nodes = vec![0.0];
            nodes.extend(method.rows.iter().map(|row| row.iter().sum::<f64>()));
            let moment =
                |k: i32| nodes.iter().zip(method.weights).map(|(c, b)| b * c.powi(k - 1)).sum::<f64>();
            for k in 1..=order {
                assert!((moment(k) - 1.0 / f64::from(k)).abs() < 1e-14, "{order}: {k}");
            }
            // The order conditions of tall rooted trees: bᵀ Aᵏ⁻¹ 1 = 1/k!
            let mut chain = vec![1.0; nodes.len()];
            let mut factorial = 1.0;
            for k in 1..=order {
                factorial *= f64::from(k);
                let sum: f64 = chain.iter().zip(method.weights).map(|(x, b)| b * x).sum();
                assert!((sum - 1.0 / factorial).abs() < 1e-13, "{order}: tall {k}: {sum}");
                let next: Vec<f64> = std::iter::once(0.0)
                    .chain(method.rows.iter().map(|row| row.iter().zip(&chain).map(|(a, x)| a * x).sum()))
                    .collect();
                chain = next;
            }
        }
    }
}
