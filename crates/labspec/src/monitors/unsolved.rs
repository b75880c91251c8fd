//! Forces that were not found: whether the solver stopped at its limit of iterations with a miss that matters.
//!
//! The solver seeks the accelerations that constraints ask for, and stops when it has made as many iterations as the model lets
//! it. Newton's method needs few; conjugate gradients and Gauss-Seidel need many for a stack, and a model that allows one gets
//! forces that do not hold it. A solver at its limit is no proof: often the last iterations change nothing. Proof is what it
//! misses: with Δa between its accelerations and those of a solver that goes on to the end, and a - a₀ what the constraints have
//! to do,
//!
//! > √(Δaᵀ M Δa) / √((a - a₀)ᵀ M (a - a₀))
//!
//! is the part of the constraints' work that is missing. One miss is soon made good by the next step, which starts from it; a
//! large one again and again is a scene that nothing holds.

use labspec_core::math::dot_slice;
use labspec_core::{
    Data, Model, Plan, Planned, Scope, exhausted, forward, limit, mul_m, solver, state, work_left,
};

/// A miss of this part matters, when it is seen so many times.
const PART: f64 = 0.25;
const TIMES: u32 = 8;
/// Steps from one look to the next: a look costs two passes.
const EVERY: u32 = 100;
const FIRST: u32 = 10;
/// How far a solver goes that goes to the end.
const ITERATIONS: i32 = 500;
const TOLERANCE: f64 = 1e-10;

/// A solver that stopped too early.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unsolved {
    /// Since when, s.
    pub time: f64,
    /// Iterations that it made, all that it may.
    pub iterations: usize,
    /// The part of what the constraints have to do that is missing.
    pub part: f64,
    /// The degree of freedom that misses most.
    pub dof: usize,
}

/// Looks at the steps in which the solver stopped at its limit.
#[derive(Clone, Debug, Default)]
pub struct SolverMonitor {
    scratch: Option<Box<SolverScratch>>,
    left: u32,
    looks: u32,
    residuals_over: u32,
    since: f64,
}

/// The same scene solved as the model says, and to the end.
#[derive(Clone, Debug)]
struct SolverScratch {
    model: Model,
    exact: Data<Planned>,
    data: Data<Planned>,
    /// Accelerations, and M times them.
    a: Vec<f64>,
    product: Vec<f64>,
}

/// Forgets what was seen: something from outside has changed the state or the model.
pub fn restart(w: &mut SolverMonitor) {
    *w = SolverMonitor::default();
}

/// To be called after each step.
#[inline]
pub fn observe<S: Scope>(w: &mut SolverMonitor, m: &Model, d: &Data<S>) -> Option<Unsolved> {
    let f = d.fields();
    let stopped = f.nefc > 0 && f.solver_niter >= m.opt.iterations.max(0) as usize;
    w.left = w.left.saturating_sub(1);
    if stopped && w.left == 0 { compare(w, m, d) } else { None }
}

/// Solves the state at hand twice.
#[cold]
fn compare<S: Scope>(w: &mut SolverMonitor, m: &Model, d: &Data<S>) -> Option<Unsolved> {
    w.looks += 1;
    w.left = if w.looks < 2 * TIMES { FIRST } else { EVERY };
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
    (w.residuals_over >= TIMES).then_some(Unsolved { time: w.since, iterations, part, dof })
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

/// The part that is missing, and where most of it is.
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
