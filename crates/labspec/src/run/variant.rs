//! Other numerics for a run: to see whether an answer depends on the step, the solver, the integrator or rounding.

use labspec_core::{Model, integrator};

/// A change of the numerics that a lesson does not mention, to see whether its answers depend on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepVariant {
    /// The timestep is multiplied by this.
    pub timestep: f64,
    /// The constraint problem is solved to rounding.
    pub tight: bool,
    /// Every coordinate of the start is moved by this: far less than anybody could measure.
    pub perturbation: f64,
    /// Another integrator, where the scene has the one that it has unless somebody says otherwise.
    pub integrator: Option<i32>,
}

impl StepVariant {
    /// As the lesson states it.
    pub const NOMINAL: StepVariant =
        StepVariant { timestep: 1.0, tight: false, perturbation: 0.0, integrator: None };

    /// Changes the options of a model. What the lesson states itself is left alone: `mentioned` says that it states the timestep.
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
