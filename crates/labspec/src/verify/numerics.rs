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

/// Perturbed numerics under which claims are checked.
#[derive(Clone, Copy, Debug)]
pub(super) struct Perturbation {
    pub(super) numerics: StepVariant,
    /// Their name, as in "it does not hold at half the timestep".
    pub(super) how: &'static str,
    /// What a change of a quoted value under them means; `None` if quotes are not checked under them.
    pub(super) quoted: Option<QuotedChange>,
}

/// What a change of a quoted value means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum QuotedChange {
    /// The value depends on the timestep.
    Timestep,
    /// The value depends on a start that nobody can reproduce.
    Start,
}

/// Number of perturbed numerics under which every answer is checked.
pub(super) const CHANGES: usize = 5;

/// The perturbed numerics under which answers must hold; quotes are checked under some of them. A start is perturbed in
/// both directions, because a motion from an unstable equilibrium depends on the direction.
pub(super) const PERTURBED: [Perturbation; CHANGES] = [
    Perturbation { numerics: HALVED, how: "at half the timestep", quoted: Some(QuotedChange::Timestep) },
    Perturbation { numerics: TIGHT_SOLVER, how: "with the solver run to convergence", quoted: None },
    Perturbation {
        numerics: PERTURBED_START,
        how: "with a start moved by 1e-14",
        quoted: Some(QuotedChange::Start),
    },
    Perturbation {
        numerics: PERTURBED_BACK,
        how: "with a start moved by -1e-14",
        quoted: Some(QuotedChange::Start),
    },
    Perturbation { numerics: FAST, how: "with the integrator implicitfast", quoted: None },
];

/// Additional numerics for an answer, where the changes under the others come close to the margin of a condition.
pub(super) const CLOSE_VARIANTS: [(StepVariant, &str); 2] =
    [(QUARTERED, "at a quarter of the timestep"), (RK4, "with the integrator RK4")];
