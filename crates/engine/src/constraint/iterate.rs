//! What the solvers keep while they go from one acceleration to the next.

use super::delassus::Dual;
use super::hessian::Hessian;

/// Where the solver stands, and its scratch: vectors over all degrees of freedom or all rows, of which each island uses its own.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Iterate {
    /// M a.
    pub(super) ma: Vec<f64>,
    /// Gradient of the cost, and M⁻¹ or H⁻¹ times it.
    pub(super) grad: Vec<f64>,
    pub(super) step: Vec<f64>,
    /// The same before the last step.
    pub(super) grad_old: Vec<f64>,
    pub(super) step_old: Vec<f64>,
    /// Search direction and M times it.
    pub(super) search: Vec<f64>,
    pub(super) mv: Vec<f64>,
    /// J a - aref, and J search.
    pub(super) jar: Vec<f64>,
    pub(super) jv: Vec<f64>,
    /// Hessian of the island at hand, those of the others as they were laid out, and a right-hand side.
    pub(super) hessian: Hessian,
    pub(super) apart: Vec<Hessian>,
    pub(super) rhs: Vec<f64>,
    /// What the dual methods keep.
    pub(super) dual: Dual,
    /// Where each island stands after the warm start.
    pub(super) reached: Vec<Reached>,
}

impl Iterate {
    /// Brings the Hessian of an island to hand, laid out as it was left. Islands share no degree of freedom, so that one list of
    /// their positions serves all.
    pub(super) fn take_up(&mut self, island: usize) {
        let at = self.hessian.island();
        if at == island {
            return;
        }
        let most = at.max(island);
        if self.apart.len() <= most {
            self.apart.resize_with(most + 1, Hessian::default);
        }
        std::mem::swap(&mut self.hessian, &mut self.apart[at]);
        std::mem::swap(&mut self.hessian, &mut self.apart[island]);
        std::mem::swap(&mut self.hessian.local, &mut self.apart[at].local);
    }

    pub(super) fn resize(&mut self, nv: usize, nefc: usize) {
        if self.ma.len() != nv {
            let old = [&mut self.grad_old, &mut self.step_old];
            let now = [&mut self.ma, &mut self.grad, &mut self.step, &mut self.search, &mut self.mv];
            for v in now.into_iter().chain(old) {
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

/// Where an island stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Reached {
    pub(super) cost: f64,
    /// Norm of the gradient.
    pub(super) gradient: f64,
    /// What makes costs and gradients comparable between scenes.
    pub(super) scale: f64,
    /// Certified to be the minimum.
    pub(super) minimum: bool,
}
