//! Unsolved forces: detects that the solver stopped at its iteration limit with a considerable error.
//!
//! The solver computes the accelerations that satisfy the constraints, and stops at the iteration limit of the model.
//! Newton's method needs few iterations. Conjugate gradients and Gauss-Seidel need many for a stack, and a model that
//! allows only one gets forces that do not support it. A solver at its limit is no proof, because the last iterations often
//! change nothing. The proof is the residual: with Δa the difference between its accelerations and those of a converged
//! solver, and a - a₀ the change that the constraints must make,
//!
//! > √(Δaᵀ M Δa) / √((a - a₀)ᵀ M (a - a₀))
//!
//! is the fraction of the constraints' effect that is missing. The next step, which starts from the last solution, soon
//! corrects a single error. Repeated large errors mean that the constraints do not hold.

use labspec_core::math::dot_slice;
use labspec_core::{
    Data, Model, Plan, Planned, Scope, exhausted, forward, limit, mul_m, solver, state, work_left,
};

/// A missing fraction that is reported, and how many times it must be observed.
const PART: f64 = 0.25;
const MIN_UNSOLVED: u32 = 8;
/// Number of steps between two evaluations, each of which costs two forward passes. `FIRST_EVALUATIONS` applies to the first
/// evaluations.
const STEPS_PER_EVALUATION: u32 = 100;
const FIRST_EVALUATIONS: u32 = 10;
/// Iteration limit and tolerance of the converged solver.
const ITERATIONS: i32 = 500;
const TOLERANCE: f64 = 1e-10;

/// A solver that stopped too early.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unsolved {
    /// Time of the first large residual, s.
    pub time: f64,
    /// Number of iterations, which equals the limit.
    pub iterations: usize,
    /// Missing fraction of the effect of the constraints.
    pub part: f64,
    /// The degree of freedom with the largest residual.
    pub dof: usize,
}

/// Monitors the steps in which the solver stopped at its iteration limit.
#[derive(Clone, Debug, Default)]
pub struct SolverMonitor {
    scratch: Option<Box<SolverScratch>>,
    left: u32,
    looks: u32,
    residuals_over: u32,
    since: f64,
}

/// The same scene, solved as the model specifies and to convergence.
#[derive(Clone, Debug)]
struct SolverScratch {
    model: Model,
    exact: Data<Planned>,
    data: Data<Planned>,
    /// Differences of accelerations, and M times them.
    a: Vec<f64>,
    product: Vec<f64>,
}

/// Resets the monitor after the state or the model was changed from outside.
pub fn restart(w: &mut SolverMonitor) {
    *w = SolverMonitor::default();
}

/// Call after each step.
#[inline]
pub fn observe<S: Scope>(w: &mut SolverMonitor, m: &Model, d: &Data<S>) -> Option<Unsolved> {
    let f = d.fields();
    let stopped = f.nefc > 0 && f.solver_niter >= m.opt.iterations.max(0) as usize;
    w.left = w.left.saturating_sub(1);
    if stopped && w.left == 0 { compare(w, m, d) } else { None }
}

/// Solves the current state with both solvers.
#[cold]
fn compare<S: Scope>(w: &mut SolverMonitor, m: &Model, d: &Data<S>) -> Option<Unsolved> {
    w.looks += 1;
    w.left = if w.looks < 2 * MIN_UNSOLVED { FIRST_EVALUATIONS } else { STEPS_PER_EVALUATION };
    let scratch = w.scratch.get_or_insert_with(|| Box::new(scratch(m)));
    let (part, dof) = residual(scratch, m, d)?;
    if part < PART {
        w.residuals_over = 0;
        return None;
    }
    if w.residuals_over == 0 {
        w.since = d.time();
    }
    w.residuals_over += 1;
    let iterations = d.fields().solver_niter;
    (w.residuals_over >= MIN_UNSOLVED).then_some(Unsolved { time: w.since, iterations, part, dof })
}

fn scratch(m: &Model) -> SolverScratch {
    let mut model = m.clone();
    let opt = model.edit().opt;
    (*opt.iterations, *opt.tolerance) = (ITERATIONS, TOLERANCE);
    *opt.solver = solver::NEWTON;
    let exact = Data::planned(&model, Plan::awake());
    let data = Data::planned(m, Plan::awake());
    SolverScratch { model, exact, data, a: vec![0.0; m.nv], product: vec![0.0; m.nv] }
}

/// The missing fraction, and the degree of freedom with the largest residual.
fn residual<S: Scope>(scratch: &mut SolverScratch, m: &Model, d: &Data<S>) -> Option<(f64, usize)> {
    for data in [&mut scratch.exact, &mut scratch.data] {
        state::copy(m, d, data, state::INTEGRATION).ok()?;
        limit(data, work_left(d));
    }
    forward(&scratch.model, &mut scratch.exact).ok()?;
    forward(m, &mut scratch.data).ok()?;
    if exhausted(&scratch.exact) || exhausted(&scratch.data) {
        return None;
    }
    let (exact, data) = (scratch.exact.fields(), scratch.data.fields());
    let mut norm = |from: &[f64], to: &[f64]| {
        for ((a, x), y) in scratch.a.iter_mut().zip(from).zip(to) {
            *a = y - x;
        }
        mul_m(m, &scratch.data, &scratch.a, &mut scratch.product).ok()?;
        Some(dot_slice(&scratch.a, &scratch.product).sqrt())
    };
    let work = norm(&exact.qacc_smooth, &exact.qacc)?;
    let miss = norm(&exact.qacc, &data.qacc)?;
    let most = |k: &usize| (scratch.a[*k] * scratch.product[*k]).abs();
    let dof = (0..m.nv).max_by(|a, b| most(a).total_cmp(&most(b)))?;
    (work > 0.0).then_some((miss / work, dof))
}
