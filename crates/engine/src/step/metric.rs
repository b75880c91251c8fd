//! The metric of the discrete integrator: M + h D + h² K. With it, a step is one linear problem.
//!
//! A force along several degrees of freedom (that of a tendon) is a rank-one term s r rᵀ. The problem with terms is solved by
//! conjugate gradients, preconditioned with the rest of the metric (Golub and Van Loan 2013, *Matrix Computations*, section
//! 11.5).

use crate::constraint;
use crate::dynamics::mass;
use crate::forces::derivative;
use crate::forces::derivative::Medium;
use crate::forces::derivative::actuator_slope;
use crate::forces::passive::fluid;
use crate::forces::passive::spring::{self, Law};
use crate::forces::tendon;
use crate::kinds::{disable, joint, solver};
use crate::math::{Spatial, dot_slice, norm};
use crate::model::{Fields, Model};

/// The metric and its factorization.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Metric {
    /// The metric without its terms, and the factorization of that matrix plus the diagonals of the terms.
    pub(super) matrix: Vec<f64>,
    pub(super) ld: Vec<f64>,
    pub(super) diag_inv: Vec<f64>,
    /// f - h K v.
    pub(super) force: Vec<f64>,
    /// The terms: forces along several degrees of freedom.
    pub(super) terms: Vec<Term>,
    /// The trees that some term of the metric couples.
    coupled: Vec<bool>,
    residual: Vec<f64>,
    step: Vec<f64>,
    pub(super) search: Vec<f64>,
    pub(super) product: Vec<f64>,
    /// The diagonal of the metric, including the terms.
    pub(super) diagonal: Vec<f64>,
    /// `qacc_smooth` while the terms are constraint rows, and the Jacobian of one of them.
    pub(super) other: Vec<f64>,
    pub(super) columns: Vec<i32>,
    pub(super) values: Vec<f64>,
}

/// A tendon, or a force output of an actuator.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum MetricRow {
    Tendon(usize),
    Output(usize),
}

/// The term s r rᵀ, for the Jacobian r of the length of a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Term {
    pub(super) row: MetricRow,
    pub(super) scale: f64,
}

impl MetricRow {
    /// The degrees of freedom, ascending, and the values.
    pub(super) fn jacobian<'a>(self, m: &'a Model, d: &'a Fields) -> (&'a [i32], &'a [f64]) {
        match self {
            MetricRow::Tendon(t) => {
                let row = tendon::row(m, t);
                (&m.ten_J_colind[row.clone()], &d.ten_J[row])
            }
            MetricRow::Output(o) => {
                let row = d.moment_rowadr[o] as usize..(d.moment_rowadr[o] + d.moment_rownnz[o]) as usize;
                (&d.moment_colind[row.clone()], &d.actuator_moment[row])
            }
        }
    }
}

impl Metric {
    /// The metric and the force, from the forces and velocities of this step.
    pub(super) fn build(&mut self, m: &Model, d: &Fields, slopes: &mut derivative::Work) {
        self.resize(m);
        self.matrix.copy_from_slice(&d.M);
        self.force.copy_from_slice(&d.qfrc_smooth);
        self.terms.clear();
        self.coupled.fill(false);
        if !m.opt.disabled(disable::SPRING) {
            self.joint_springs(m, d);
        }
        if !m.opt.disabled(disable::DAMPER) {
            for i in 0..m.nv {
                let slope = spring::joint_damping(m, d, i);
                self.matrix[mass::diagonal(m, i)] += m.opt.timestep * slope.max(0.0);
            }
        }
        if fluid::acts(m) {
            derivative::medium(m, d, slopes, Medium::Drag);
            derivative::sparse::subtract_lower(m, &slopes.whole, m.opt.timestep, &mut self.matrix);
        }
        // The dual solver uses the inverse with the sparsity pattern of M only.
        if m.opt.solver != solver::PGS {
            self.tendons(m, d);
            self.actuators(m, d);
        }
        self.ld.copy_from_slice(&self.matrix);
        for term in &self.terms {
            let (dofs, values) = term.row.jacobian(m, d);
            for (&k, x) in dofs.iter().zip(values) {
                self.ld[mass::diagonal(m, k as usize)] += term.scale * x * x;
            }
        }
        for i in 0..m.nv {
            self.diagonal[i] = self.ld[mass::diagonal(m, i)];
        }
        mass::factor(m, &mut self.ld, &mut self.diag_inv, 0..m.nv);
    }

    /// Exchanges the acceleration with the terms (stored in `other`) for that without them, and the factorization with the
    /// diagonals of the terms for that of the matrix alone.
    pub(super) fn solve_without_mass_rows(&mut self, m: &Model, smooth: &mut Vec<f64>) {
        self.ld.copy_from_slice(&self.matrix);
        mass::factor(m, &mut self.ld, &mut self.diag_inv, 0..m.nv);
        self.other.copy_from_slice(&self.force);
        mass::solve(m, &self.ld, &self.diag_inv, &mut self.other, 0..m.nv);
        std::mem::swap(&mut self.other, smooth);
    }

    fn resize(&mut self, m: &Model) {
        self.matrix.resize(m.nC, 0.0);
        self.ld.resize(m.nC, 0.0);
        self.coupled.resize(m.ntree, false);
        let vectors = [&mut self.force, &mut self.diag_inv, &mut self.residual, &mut self.step];
        let more = [&mut self.search, &mut self.product, &mut self.diagonal, &mut self.other];
        for v in vectors.into_iter().chain(more) {
            v.resize(m.nv, 0.0);
        }
    }

    /// The stiffness of a joint spring in all directions is that in the radial direction.
    fn joint_springs(&mut self, m: &Model, d: &Fields) {
        for j in 0..m.njnt {
            let law = Law::new(&m.jnt_stiffness, &m.jnt_stiffnesspoly, j);
            if law.is_zero() {
                continue;
            }
            let first = m.jnt_dofadr[j] as usize;
            if matches!(m.jnt_type[j], joint::SLIDE | joint::HINGE) {
                let q = m.jnt_qposadr[j] as usize;
                self.spring(m, d, first..first + 1, law.slope(d.qpos[q] - m.qpos_spring[q]));
                continue;
            }
            let (shift, turn) = spring::displacements(m, d, j);
            let mut first = first;
            for x in [shift, Some(turn)].into_iter().flatten() {
                self.spring(m, d, first..first + 3, law.slope(norm(x)));
                first += 3;
            }
        }
    }

    fn spring(&mut self, m: &Model, d: &Fields, dofs: std::ops::Range<usize>, stiffness: f64) {
        let (h, k) = (m.opt.timestep, stiffness.max(0.0));
        for i in dofs {
            self.matrix[mass::diagonal(m, i)] += h * (h * k);
            self.force[i] -= h * k * d.qvel[i];
        }
    }

    fn tendons(&mut self, m: &Model, d: &Fields) {
        for t in 0..m.ntendon {
            let (mut stiffness, mut damping) = (0.0, 0.0);
            if !m.opt.disabled(disable::SPRING) {
                let x = tendon::spring_displacement(m, d, t);
                if x != 0.0 {
                    stiffness = Law::new(&m.tendon_stiffness, &m.tendon_stiffnesspoly, t).slope(x);
                }
            }
            if !m.opt.disabled(disable::DAMPER) {
                damping = spring::tendon_damper(m, t).slope(d.ten_velocity[t].abs());
            }
            self.add(m, d, MetricRow::Tendon(t), stiffness, damping, d.ten_velocity[t]);
        }
    }

    fn actuators(&mut self, m: &Model, d: &Fields) {
        if m.opt.disabled(disable::ACTUATION) {
            return;
        }
        for i in (0..m.nactuator).filter(|&i| actuator_slope::acts(m, d, i)) {
            let slopes = actuator_slope::slopes(m, d, i);
            let first = m.actuator_outadr[i] as usize;
            for o in first..first + m.actuator_outnum[i] as usize {
                self.add(
                    m,
                    d,
                    MetricRow::Output(o),
                    -slopes.length,
                    -slopes.velocity,
                    d.actuator_velocity[o],
                );
            }
        }
    }

    /// Adds a spring and a damper along a row whose length changes with `velocity`.
    fn add(&mut self, m: &Model, d: &Fields, row: MetricRow, stiffness: f64, damping: f64, velocity: f64) {
        let (h, k, b) = (m.opt.timestep, stiffness.max(0.0), damping.max(0.0));
        let scale = h * h * k + h * b;
        let (dofs, values) = row.jacobian(m, d);
        if scale == 0.0 {
            return;
        }
        for (&i, x) in dofs.iter().zip(values) {
            self.force[i as usize] -= h * k * velocity * x;
            self.coupled[m.dof_treeid[i as usize] as usize] = true;
        }
        match (dofs, values) {
            (&[i], x) => self.matrix[mass::diagonal(m, i as usize)] += scale * x[0] * x[0],
            _ => self.terms.push(Term { row, scale }),
        }
    }

    /// x ← metric⁻¹ force. With terms, by conjugate gradients from zero, to the tolerance of the solver.
    pub(super) fn solve(&mut self, m: &Model, d: &Fields, x: &mut [f64]) {
        if self.terms.is_empty() {
            x.copy_from_slice(&self.force);
            mass::solve(m, &self.ld, &self.diag_inv, x, 0..m.nv);
            return;
        }
        x.fill(0.0);
        self.residual.copy_from_slice(&self.force);
        self.search.fill(0.0);
        let goal = m.opt.tolerance * norm_of(&self.force);
        let mut before = 1.0;
        // In exact arithmetic, the number of iterations is the number of terms plus one.
        for _ in 0..2 * self.terms.len() + 20 {
            if norm_of(&self.residual) <= goal {
                break;
            }
            self.step.copy_from_slice(&self.residual);
            mass::solve(m, &self.ld, &self.diag_inv, &mut self.step, 0..m.nv);
            let current = dot_slice(&self.residual, &self.step);
            for (p, z) in self.search.iter_mut().zip(&self.step) {
                *p = z + current / before * *p;
            }
            before = current;
            self.multiply(m, d);
            let curvature = dot_slice(&self.search, &self.product);
            if current <= 0.0 || curvature <= 0.0 {
                break;
            }
            let alpha = current / curvature;
            for i in 0..m.nv {
                x[i] += alpha * self.search[i];
                self.residual[i] -= alpha * self.product[i];
            }
        }
    }

    /// The metric of a free rigid body that is not coupled with others, with the derivative of its gyroscopic force: the first
    /// degree of freedom, and the block.
    pub(super) fn free_block(
        &self,
        m: &Model,
        d: &Fields,
        slopes: &mut derivative::Work,
        rows: &constraint::ConstraintScratch,
        tree: usize,
    ) -> Option<(usize, [Spatial; 6])> {
        let first = m.tree_dofadr[tree] as usize;
        if self.coupled[tree] || !derivative::is_free_rigid(m, tree) || rows.jac.touches(first..first + 6) {
            return None;
        }
        derivative::tree_bias(m, d, slopes, tree);
        Some((first, derivative::free_block(m, &self.matrix, slopes, m.opt.timestep, first)))
    }

    /// `product` ← metric `search`.
    pub(super) fn multiply(&mut self, m: &Model, d: &Fields) {
        let x = &self.search;
        mass::mul(m, &self.matrix, x, &mut self.product, 0..m.nv);
        for term in &self.terms {
            let (dofs, values) = term.row.jacobian(m, d);
            let along: f64 = dofs.iter().zip(values).map(|(&k, v)| v * x[k as usize]).sum();
            for (&k, v) in dofs.iter().zip(values) {
                self.product[k as usize] += term.scale * along * v;
            }
        }
    }
}

fn norm_of(x: &[f64]) -> f64 {
    dot_slice(x, x).sqrt()
}
