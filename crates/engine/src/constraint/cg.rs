//! The conjugate gradient method with the mass matrix as preconditioner.
//!
//! Search directions and the truncation of β follow Hager and Zhang 2005 (*A new conjugate gradient method with
//! guaranteed descent and an efficient line search*).

use super::iterate::IslandProgress;
use super::primal::{Direction, PrimalProblem};
use crate::math::MINVAL;

/// η of the truncation, which keeps it finite if the gradient vanishes.
const ETA: f64 = 0.01;

impl PrimalProblem<'_> {
    #[inline(never)]
    pub(super) fn conjugate_gradient(&mut self, from: IslandProgress) {
        if from.minimum {
            return;
        }
        let [rows, _] = self.pass_costs();
        let price = 6 * rows + 4 * self.m.nC as u64 / self.d.nisland.max(1) as u64;
        self.descend(from, price, Self::conjugate_direction);
    }

    /// search ← β search - M⁻¹ g. Also stores g and M⁻¹ g for the next β.
    fn conjugate_direction(&mut self, before: Option<f64>) -> Option<Direction> {
        self.decrement_by_mass();
        let beta = before.map(|gradient| self.beta(gradient));
        let (dofs, s) = (self.dofs(), &mut *self.s);
        for k in dofs.flatten() {
            s.search[k] = beta.map_or(-s.step[k], |beta| beta * s.search[k] - s.step[k]);
            (s.grad_old[k], s.step_old[k]) = (s.grad[k], s.step[k]);
        }
        Some(Direction::Other)
    }

    /// The factor β of the previous direction d: (y·Mg - 2 (y·My) (d·g) / (d·y)) / (d·y), where y is the change of
    /// the gradient g, and M is the preconditioner. β is at least -1 / (|d| min(η, |g|)), with the previous gradient.
    fn beta(&mut self, gradient: f64) -> f64 {
        let (dofs, s) = (self.dofs(), &mut *self.s);
        let mut sums = [0.0; 5];
        for k in dofs.flatten() {
            let (y, my) = (s.grad[k] - s.grad_old[k], s.step[k] - s.step_old[k]);
            let (g, mg, d) = (s.grad[k], s.step[k], s.search[k]);
            for (sum, term) in sums.iter_mut().zip([y * mg, y * my, d * g, d * y, d * d]) {
                *sum += term;
            }
        }
        let [y_mg, y_my, d_g, d_y, d_d] = sums;
        if d_y < MINVAL {
            return 0.0;
        }
        let beta = (y_mg - 2.0 * y_my / d_y * d_g) / d_y;
        beta.max(-1.0 / (d_d.sqrt() * gradient.min(ETA)).max(MINVAL))
    }
}
