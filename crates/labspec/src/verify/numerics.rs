//! Perturbed numerics that a lesson does not mention, under which its claims must still hold.

use crate::run::StepVariant;
use labspec_core::integrator;

/// Half the timestep.
pub const HALVED: StepVariant = StepVariant { timestep: 0.5, ..StepVariant::NOMINAL };

pub(super) const QUARTERED: StepVariant = StepVariant { timestep: 0.25, ..StepVariant::NOMINAL };

pub(super) const FAST: StepVariant =
    StepVariant { integrator: Some(integrator::IMPLICITFAST), ..StepVariant::NOMINAL };

pub(super) const RK4: StepVariant = StepVariant { integrator: Some(integrator::RK4), ..StepVariant::NOMINAL };

pub(super) const TIGHT_SOLVER: StepVariant = StepVariant { tight: true, ..StepVariant::NOMINAL };

/// Far below anything that could be set or measured. A system in which it is visible after seconds is chaotic.
pub(super) const PERTURBATION: f64 = 1e-14;
/// The initial state perturbed by `PERTURBATION`.
pub const PERTURBED_START: StepVariant = StepVariant { perturbation: PERTURBATION, ..StepVariant::NOMINAL };
/// The initial state perturbed by `-PERTURBATION`.
pub const PERTURBED_BACK: StepVariant = StepVariant { perturbation: -PERTURBATION, ..StepVariant::NOMINAL };

/// Number of perturbed numerics under which every answer is checked.
pub(super) const CHANGES: usize = 4;

/// The perturbed numerics under which an answer must hold, and their names. Quotes use the first and the third.
pub(super) const PERTURBED: [(StepVariant, &str); CHANGES] = [
    (HALVED, "at half the timestep"),
    (TIGHT_SOLVER, "with the solver run to convergence"),
    (PERTURBED_START, "with a start moved by 1e-14"),
    (FAST, "with the integrator implicitfast"),
];

/// Additional numerics for an answer, where the changes under the others come close to the margin of a condition.
pub(super) const CLOSE_VARIANTS: [(StepVariant, &str); 2] =
    [(QUARTERED, "at a quarter of the timestep"), (RK4, "with the integrator RK4")];
