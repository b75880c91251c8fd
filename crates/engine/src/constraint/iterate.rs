//! State of the solvers between iterations.

use super::delassus::Dual;
use super::hessian::Hessian;

/// The current iterate and scratch: vectors over all degrees of freedom or all rows. Each island uses its own part.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Iterate {
    /// M a.
    pub(super) ma: Vec<f64>,
    /// Gradient of the cost, and its product with M⁻¹ or H⁻¹.
    pub(super) grad: Vec<f64>,
    pub(super) step: Vec<f64>,
    /// Both before the last step.
    pub(super) grad_old: Vec<f64>,
    pub(super) step_old: Vec<f64>,
    /// Search direction and M times it.
    pub(super) search: Vec<f64>,
    pub(super) mv: Vec<f64>,
    /// J a - aref, and J search.
    pub(super) jar: Vec<f64>,
    pub(super) jv: Vec<f64>,
    /// Hessian of the current island, those of the others with their layouts, and a right-hand side.
    pub(super) hessian: Hessian,
    pub(super) island_hessians: Vec<Hessian>,
    pub(super) rhs: Vec<f64>,
    /// Matrices of the dual methods.
    pub(super) dual: Dual,
    /// State of each island after the warm start.
    pub(super) progress: Vec<IslandProgress>,
}

impl Iterate {
    /// Makes the Hessian of an island the current one, with the layout that it had. Islands share no degrees of
    /// freedom, so one list of positions (`local`) serves all.
    pub(super) fn select_island(&mut self, island: usize) {
        let current = self.hessian.island();
        if current == island {
            return;
        }
        let most = current.max(island);
        if self.island_hessians.len() <= most {
            self.island_hessians.resize_with(most + 1, Hessian::default);
        }
        std::mem::swap(&mut self.hessian, &mut self.island_hessians[current]);
        std::mem::swap(&mut self.hessian, &mut self.island_hessians[island]);
        std::mem::swap(&mut self.hessian.local, &mut self.island_hessians[current].local);
    }

    pub(super) fn resize(&mut self, nv: usize, nefc: usize) {
        if self.ma.len() != nv {
            let old = [&mut self.grad_old, &mut self.step_old];
            let current = [&mut self.ma, &mut self.grad, &mut self.step, &mut self.search, &mut self.mv];
            for v in current.into_iter().chain(old) {
                v.resize(nv, 0.0);
            }
        }
        if self.jar.len() != nefc {
            for v in [&mut self.jar, &mut self.jv] {
                v.resize(nefc, 0.0);
            }
        }
    }
}

/// State of an island.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct IslandProgress {
    pub(super) cost: f64,
    /// Norm of the gradient.
    pub(super) gradient: f64,
    /// Factor that makes costs and gradients comparable between scenes.
    pub(super) scale: f64,
    /// Whether it is proven to be the minimum.
    pub(super) minimum: bool,
}
