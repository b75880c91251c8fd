//! The integrators of the engine, by number and name.

use labspec_core::reflect::option;
use labspec_core::{AccessSet, Model, integrator};

/// An integrator by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Integrator {
    /// Its number (`opt.integrator`).
    pub id: i32,
    /// Its name in MJCF.
    pub name: &'static str,
    /// Whether MuJoCo has it too, so that a lab on a page can use it.
    pub shared: bool,
}

/// All integrators, those of MuJoCo first.
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

/// Whether a program of a lab sets the integrator, so that the attribute of its model has no effect.
pub fn sets_integrator(access: &AccessSet) -> bool {
    access.writes.contains(option::integrator)
}

impl Integrator {
    /// The integrator with a name, ignoring case.
    pub fn named(name: &str) -> Option<Integrator> {
        INTEGRATORS.into_iter().find(|i| i.name.eq_ignore_ascii_case(name))
    }

    /// Whether its order is above two, so that a step can be repeated with any length to interpolate within it.
    pub fn is_high(self) -> bool {
        use integrator::{ADAPTIVE, GAUSS, RK4, RKMK4, RKMK8};
        [RK4, RKMK4, RKMK8, GAUSS, ADAPTIVE].contains(&self.id)
    }

    /// The integrator of a model; Euler for an unknown number, as in the engine.
    pub fn of_model(model: &Model) -> Integrator {
        let euler = INTEGRATORS[0];
        INTEGRATORS.into_iter().find(|i| i.id == model.opt.integrator).unwrap_or(euler)
    }
}
