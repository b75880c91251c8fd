//! Numerics that a lesson does not mention, and that its claims must survive.

use crate::run::StepVariant;
use labspec_core::integrator;

pub(crate) const HALVED: StepVariant = StepVariant { timestep: 0.5, ..StepVariant::NOMINAL };

pub(super) const QUARTERED: StepVariant = StepVariant { timestep: 0.25, ..StepVariant::NOMINAL };

pub(super) const FAST: StepVariant =
    StepVariant { integrator: Some(integrator::IMPLICITFAST), ..StepVariant::NOMINAL };

pub(super) const RK4: StepVariant = StepVariant { integrator: Some(integrator::RK4), ..StepVariant::NOMINAL };

pub(super) const TIGHT: StepVariant = StepVariant { tight: true, ..StepVariant::NOMINAL };

/// Far below what anybody could set or measure; a system that shows it after seconds is chaotic.
pub(super) const PERTURBATION: f64 = 1e-14;
/// The start moved by `PERTURBATION`.
pub const PERTURBED_START: StepVariant = StepVariant { perturbation: PERTURBATION, ..StepVariant::NOMINAL };
/// The start moved back by it.
pub const PERTURBED_BACK: StepVariant = StepVariant { perturbation: -PERTURBATION, ..StepVariant::NOMINAL };

/// Other numerics that every answer is put to.
pub(super) const CHANGES: usize = 4;

/// The changes of the numerics that an answer must survive, and their names. The first and the third are those of quotes.
pub(super) const PERTURBED: [(StepVariant, &str); CHANGES] = [
    (HALVED, "at half the timestep"),
    (TIGHT, "with the solver run to convergence"),
    (PERTURBED_START, "with a start moved by 1e-14"),
    (FAST, "with the integrator implicitfast"),
];

/// Those that an answer must survive besides, where what the others change of a condition could turn it over.
pub(super) const CLOSER: [(StepVariant, &str); 2] =
    [(QUARTERED, "at a quarter of the timestep"), (RK4, "with the integrator RK4")];
