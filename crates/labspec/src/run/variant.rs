//! Perturbed numerics of a run: they show whether an answer depends on the step, the solver, the integrator or rounding.

use labspec_core::{Model, integrator};

/// A change of the numerics that a lesson does not mention, to test whether its answers depend on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepVariant {
    /// Factor on the timestep.
    pub timestep: f64,
    /// Whether the constraint problem is solved to rounding precision.
    pub tight: bool,
    /// Displacement of every coordinate of the start, far below what could be measured.
    pub perturbation: f64,
    /// Another integrator. It replaces only the default integrator.
    pub integrator: Option<i32>,
}

impl StepVariant {
    /// The numerics of the lesson.
    pub const NOMINAL: StepVariant =
        StepVariant { timestep: 1.0, tight: false, perturbation: 0.0, integrator: None };

    /// Changes the options of a model. `mentioned` states that the lesson sets the timestep, which is then kept.
    pub(super) fn change_options(&self, model: &mut Model, mentioned: bool) {
        let opt = model.edit().opt;
        if !mentioned {
            *opt.timestep *= self.timestep;
        }
        if let Some(other) = self.integrator.filter(|_| *opt.integrator == integrator::EULER) {
            *opt.integrator = other;
        }
        if self.tight {
            (*opt.tolerance, *opt.ls_tolerance) = (0.0, 1e-10);
            (*opt.iterations, *opt.ls_iterations) = (200, 100);
        }
    }
}
