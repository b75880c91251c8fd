//! What is compared: integrators over a ladder of timesteps and, on request, settings of the constraint solver.

use labspec_core::{Model, integrator};

/// An integrator by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Integrator {
    /// Its number (`opt.integrator`).
    pub id: i32,
    /// Its name, as MJCF writes it.
    pub name: &'static str,
    /// MuJoCo has it too, so that a lab on a page can use it.
    pub shared: bool,
}

/// All of them: MuJoCo's first.
pub const INTEGRATORS: [Integrator; 9] = [
    Integrator { id: integrator::EULER, name: "Euler", shared: true },
    Integrator { id: integrator::IMPLICIT, name: "implicit", shared: true },
    Integrator { id: integrator::IMPLICITFAST, name: "implicitfast", shared: true },
    Integrator { id: integrator::RK4, name: "RK4", shared: true },
    Integrator { id: integrator::DISCRETE, name: "discrete", shared: true },
    Integrator { id: integrator::RKMK4, name: "rkmk4", shared: false },
    Integrator { id: integrator::RKMK8, name: "rkmk8", shared: false },
    Integrator { id: integrator::GAUSS, name: "gauss", shared: false },
    Integrator { id: integrator::ADAPTIVE, name: "adaptive", shared: false },
];

impl Integrator {
    /// The integrator with a name, whatever the case of its letters.
    pub fn named(name: &str) -> Option<Integrator> {
        INTEGRATORS.into_iter().find(|i| i.name.eq_ignore_ascii_case(name))
    }

    /// Whether its steps can be made again with any length to see what is between them: it is of an order above the second.
    pub(super) fn is_high(self) -> bool {
        use integrator::{ADAPTIVE, GAUSS, RK4, RKMK4, RKMK8};
        [RK4, RKMK4, RKMK8, GAUSS, ADAPTIVE].contains(&self.id)
    }

    /// The integrator that a model's options name; Euler's, as the engine takes it, for a number without a meaning.
    pub fn of(model: &Model) -> Integrator {
        let euler = INTEGRATORS[0];
        INTEGRATORS.into_iter().find(|i| i.id == model.opt.integrator).unwrap_or(euler)
    }
}

/// A setting of the solver that is varied, all else being the lab's own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Solver {
    /// `opt.iterations`.
    Iterations(i32),
    /// `opt.tolerance`.
    Tolerance(f64),
    /// `opt.cone`: 0 pyramidal, 1 elliptic.
    Cone(i32),
}

/// Which setting of the solver is varied.
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
    /// In words.
    pub fn name(self) -> String {
        match self {
            Solver::Iterations(n) => format!("iterations {n}"),
            Solver::Tolerance(x) => format!("tolerance {x:e}"),
            Solver::Cone(0) => "pyramidal cone".into(),
            Solver::Cone(_) => "elliptic cone".into(),
        }
    }
}

/// How a lab is run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    /// The integrator.
    pub integrator: Integrator,
    /// Timestep, s.
    pub timestep: f64,
    /// What differs from the lab's own solver.
    pub solver: Option<Solver>,
}

impl Setting {
    /// Writes it into the options of a model.
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
