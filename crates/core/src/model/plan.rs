//! Plans as data: which stages of a step run, and what of them. How one is made: `step/plan`.

use super::stage::Stage;

/// One line of the plan.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Decision {
    /// The stage.
    pub stage: Stage,
    /// Whether it runs.
    pub keep: bool,
    /// Why, for a person to read.
    pub reason: String,
}

/// Which stages run.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    pub(crate) decisions: Vec<Decision>,
    pub(crate) kept: u32,
    /// Whether some tree is more than one simple body; otherwise the mass matrix is diagonal and constant.
    pub(crate) some_general: bool,
    /// Whether composite inertias are computed: some tree is more than a short chain, or they are read.
    pub(crate) composite: bool,
    /// Whether forces of bodies are computed by recursion: some tree is more than a short chain.
    pub(crate) recursion: bool,
    /// Whether M and the rows of its factorization are computed only in steps in which constraints act: nothing else
    /// looks at them.
    pub(crate) mass_for_rows: bool,
    /// Whether some body is a simple one.
    pub(crate) simple_bodies: bool,
    /// Whether the parameters of short chains, or the frames of bodies and joints, may change.
    pub(crate) chains_may_change: bool,
    pub(crate) frames_may_change: bool,
    /// Whether there can be equality constraints, dry friction, or limits of joints and tendons.
    pub(crate) equalities: bool,
    pub(crate) friction_loss: bool,
    pub(crate) limits: bool,
    /// Whether contacts pull, and whether surfaces move by themselves.
    pub(crate) adhesion: bool,
    pub(crate) surfaces: bool,
    /// Whether joints have dampers, where that is known once and for all; whether springs and dampers are looked at, and
    /// whether some of the dampers belong to actuators.
    pub(crate) damped: Option<bool>,
    pub(crate) springs: bool,
    pub(crate) dampers: bool,
    pub(crate) actuator_dampers: bool,
    /// Whether all actuators are motors of slides and hinges: each makes a force in proportion to its control.
    pub(crate) motors: bool,
    /// Whether forces of actuators are limited, one by one or by joint.
    pub(crate) force_limits: bool,
    /// Whether the solver says more than forces: `efc_b` and `efc_state`.
    pub(crate) solver_details: bool,
    /// Whether bodies feel a medium or gravity compensation.
    pub(crate) body_forces: bool,
    /// Whether forces applied to bodies are looked at.
    pub(crate) applied_forces: bool,
    pub(crate) pairs_may_change: bool,
    pub(crate) contact_params_may_change: bool,
}

impl Default for Plan {
    fn default() -> Self {
        Plan {
            decisions: Vec::new(),
            kept: 0,
            some_general: true,
            composite: true,
            recursion: true,
            mass_for_rows: false,
            simple_bodies: true,
            chains_may_change: true,
            frames_may_change: true,
            equalities: true,
            friction_loss: true,
            limits: true,
            adhesion: true,
            surfaces: true,
            damped: None,
            springs: true,
            dampers: true,
            actuator_dampers: true,
            motors: false,
            force_limits: true,
            solver_details: true,
            body_forces: true,
            applied_forces: true,
            pairs_may_change: true,
            contact_params_may_change: true,
        }
    }
}

impl Plan {
    /// Whether a stage runs.
    #[inline(always)]
    pub fn keeps(&self, stage: Stage) -> bool {
        self.kept & (1 << stage as u32) != 0
    }

    /// Every stage with the reason to keep it or leave it out, in the order of the pipeline.
    pub fn decisions(&self) -> &[Decision] {
        &self.decisions
    }

    /// The same with every stage kept and no list of reasons.
    pub(crate) fn keeping_all(self) -> Plan {
        Plan { kept: u32::MAX, ..self }
    }

    pub(crate) fn decide(&mut self, stage: Stage, keep: bool, reason: String) {
        if keep {
            self.kept |= 1 << stage as u32;
        }
        self.decisions.push(Decision { stage, keep, reason });
    }
}
