//! The settings to compare: integrators with several timesteps and, on request, settings of the constraint solver.

use labspec::run::Integrator;
use labspec_core::Model;

/// A solver setting that is varied; all other settings are the lab's own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Solver {
    /// `opt.iterations`.
    Iterations(i32),
    /// `opt.tolerance`.
    Tolerance(f64),
    /// `opt.cone`: 0 pyramidal, 1 elliptic.
    Cone(i32),
}

/// Which solver setting is varied.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// `opt.iterations`.
    Iterations,
    /// `opt.tolerance`.
    Tolerance,
    /// `opt.cone`.
    Cone,
}

impl Axis {
    /// The values that are tried.
    pub(super) fn values(self) -> Vec<Solver> {
        match self {
            Axis::Iterations => [1, 2, 5, 10, 20, 50, 100].map(Solver::Iterations).to_vec(),
            Axis::Tolerance => [1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 0.0].map(Solver::Tolerance).to_vec(),
            Axis::Cone => [0, 1].map(Solver::Cone).to_vec(),
        }
    }
}

impl Solver {
    /// The setting in words.
    pub fn name(self) -> String {
        match self {
            Solver::Iterations(n) => format!("iterations {n}"),
            Solver::Tolerance(x) => format!("tolerance {x:e}"),
            Solver::Cone(0) => "pyramidal cone".into(),
            Solver::Cone(_) => "elliptic cone".into(),
        }
    }
}

/// The setting of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    /// The integrator.
    pub integrator: Integrator,
    /// Timestep, s.
    pub timestep: f64,
    /// The difference from the lab's own solver settings.
    pub solver: Option<Solver>,
}

impl Setting {
    /// Writes the setting into the options of a model.
    pub(super) fn apply(&self, model: &mut Model) {
        let opt = model.edit().opt;
        (*opt.timestep, *opt.integrator) = (self.timestep, self.integrator.id);
        match self.solver {
            Some(Solver::Iterations(n)) => *opt.iterations = n,
            Some(Solver::Tolerance(x)) => *opt.tolerance = x,
            Some(Solver::Cone(kind)) => *opt.cone = kind,
            None => {}
        }
    }
}
