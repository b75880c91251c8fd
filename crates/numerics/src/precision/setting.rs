//! The settings to compare: integrators with several timesteps and, on request, settings of the constraint solver.

use labspec::run::Integrator;
use labspec_core::Model;

/// A solver setting that is varied; all other settings are the lab's own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SolverVariation {
    /// `opt.iterations`.
    Iterations(i32),
    /// `opt.tolerance`.
    Tolerance(f64),
    /// `opt.cone`: 0 pyramidal, 1 elliptic.
    Cone(i32),
}

/// Which solver setting is varied.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VariedSetting {
    /// `opt.iterations`.
    Iterations,
    /// `opt.tolerance`.
    Tolerance,
    /// `opt.cone`.
    Cone,
}

impl VariedSetting {
    /// The values that are tried.
    pub(super) fn values(self) -> Vec<SolverVariation> {
        match self {
            VariedSetting::Iterations => [1, 2, 5, 10, 20, 50, 100].map(SolverVariation::Iterations).to_vec(),
            VariedSetting::Tolerance => {
                [1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 0.0].map(SolverVariation::Tolerance).to_vec()
            }
            VariedSetting::Cone => [0, 1].map(SolverVariation::Cone).to_vec(),
        }
    }
}

impl SolverVariation {
    /// The setting in words.
    pub fn name(self) -> String {
        match self {
            SolverVariation::Iterations(n) => format!("iterations {n}"),
            SolverVariation::Tolerance(x) => format!("tolerance {x:e}"),
            SolverVariation::Cone(0) => "pyramidal cone".into(),
            SolverVariation::Cone(_) => "elliptic cone".into(),
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
    pub solver: Option<SolverVariation>,
}

impl Setting {
    /// Writes the setting into the options of a model.
    pub(super) fn apply(&self, model: &mut Model) {
        let opt = model.edit().opt;
        (*opt.timestep, *opt.integrator) = (self.timestep, self.integrator.id);
        match self.solver {
            Some(SolverVariation::Iterations(n)) => *opt.iterations = n,
            Some(SolverVariation::Tolerance(x)) => *opt.tolerance = x,
            Some(SolverVariation::Cone(kind)) => *opt.cone = kind,
            None => {}
        }
    }
}
