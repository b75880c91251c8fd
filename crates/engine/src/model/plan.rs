//! Plans as data: which stages of a step run, and which parts of them. `step/planner` makes them.

use super::sensed::Values;
use super::stage::Stage;
use super::tree_algorithm::TreeAlgorithms;

/// One line of the plan.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Decision {
    /// The stage.
    pub stage: Stage,
    /// Whether it runs.
    pub keep: bool,
    /// The reason, for people.
    pub reason: String,
}

/// The flags of a plan. Each has a value for the case that nothing is known about the model, in which a stage makes no assumption
/// and checks at every step.
macro_rules! plan_flags {
    ($($(#[doc = $doc:literal])+ $flag:ident = $unknown:literal,)+) => {
        /// Facts about a model that are constant, so that stages need not check them at every step.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum PlanFlag {
            $($(#[doc = $doc])+ $flag,)+
        }

        impl PlanFlag {
            /// One bit for each flag that is set when nothing is known.
            const UNKNOWN: u32 = $((($unknown as u32) << PlanFlag::$flag as u32))|+;
        }
    };
}
plan_flags! {
    /// M of some tree depends on the configuration. Otherwise M is diagonal and constant.
    General = true,
    /// Composite inertias are computed, because some tree uses the general algorithm, or because they are read.
    Composite = true,
    /// Inertias of bodies about the centre of mass of their tree are computed.
    BodyInertias = true,
    /// Forces of bodies are computed by recursion, because some tree uses the general algorithm.
    Recursion = true,
    /// M and the rows of its factorization are computed only in steps with active constraints, because only these read them.
    MassForRows = false,
    /// Equality constraints may be active.
    Equalities = true,
    /// Dry friction may be active.
    FrictionLoss = true,
    /// Joints or tendons may be limited.
    Limits = true,
    /// Contacts may be adhesive.
    Adhesion = true,
    /// Surfaces of geoms may have a velocity.
    Surfaces = true,
    /// Whether joints have dampers is constant.
    ConstantDamping = false,
    /// If [`PlanFlag::ConstantDamping`] is set: joints have dampers.
    JointDampers = true,
    /// Springs are checked at every step.
    Springs = true,
    /// Dampers are checked at every step.
    Dampers = true,
    /// Some dampers of joints belong to actuators.
    ActuatorDampers = true,
    /// All actuators are motors of slides and hinges: each force is proportional to the control.
    Motors = false,
    /// All actuators are motors or servos of slides, hinges and tendons: each force depends on a control, a length and a
    /// velocity.
    Servos = false,
    /// The derivatives of forces with respect to velocities depend on the model alone, except for those of actuator forces.
    ConstantVelocityDerivatives = false,
    /// Forces of actuators may be limited, individually or per joint.
    ForceLimits = true,
    /// The solver also writes `efc_b` and `efc_state`.
    SolverDetails = true,
    /// Fluid forces or gravity compensation may act on bodies.
    BodyForces = true,
    /// Forces that are applied to bodies are checked at every step.
    AppliedForces = true,
    /// Without active constraints, only gravity and the bias force act: there are no springs, no actuators, and no applied
    /// forces.
    Unforced = false,
    /// Like [`PlanFlag::Unforced`], and M is diagonal, contacts are impossible, and no tree sleeps.
    Ballistic = false,
    /// The set of pairs of geoms that may touch can change during a run.
    PairsChange = true,
    /// The parameters of contacts can change during a run.
    ContactParamsChange = true,
    /// The poses of bodies, joints and geoms in the model can change during a run.
    PlacesChange = true,
}

/// Which stages run, and which flags are set.
#[derive(Clone, Debug, PartialEq)]
pub struct PlanTable {
    pub(crate) decisions: Vec<Decision>,
    /// One bit for each stage that runs, and one bit for each flag that is set.
    kept_stages: u32,
    flags: u32,
    /// The allowed tree algorithms.
    pub algorithms: TreeAlgorithms,
    /// The sensor values that are read.
    pub sensed: Values,
    /// Whether every sensor is evaluated, read or not.
    pub every_sensor: bool,
    /// A stage that runs because it was requested explicitly.
    pub more: Option<Stage>,
    /// The stages that run in each part of a forward pass; then the same without the stages that only sensors need.
    pub(crate) passes: [[u32; 3]; 2],
}

impl Default for PlanTable {
    /// A plan without stages, in which nothing is known about the model.
    fn default() -> PlanTable {
        PlanTable {
            decisions: Vec::new(),
            kept_stages: 0,
            flags: PlanFlag::UNKNOWN,
            algorithms: TreeAlgorithms::ALL,
            sensed: Values::ALL,
            every_sensor: true,
            more: None,
            passes: [[0; 3]; 2],
        }
    }
}

impl PlanTable {
    /// Whether a stage runs.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub fn keeps(&self, stage: Stage) -> bool {
        self.kept_stages & (1 << stage as u32) != 0
    }

    /// Whether a flag is set.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub fn has(&self, flag: PlanFlag) -> bool {
        self.flags & (1 << flag as u32) != 0
    }

    /// Every stage with the reason to run it or to leave it out, in the order of the pipeline.
    pub fn decisions(&self) -> &[Decision] {
        &self.decisions
    }

    pub(crate) fn keep(&mut self, stage: Stage, keep: bool) {
        let bit = 1 << stage as u32;
        self.kept_stages = if keep { self.kept_stages | bit } else { self.kept_stages & !bit };
    }

    pub(crate) fn set_flag(&mut self, flag: PlanFlag, holds: bool) {
        let bit = 1 << flag as u32;
        self.flags = if holds { self.flags | bit } else { self.flags & !bit };
    }
}
