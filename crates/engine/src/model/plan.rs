//! Plans as data: which stages of a step run, and what of them. How one is made: `step/planner`.

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
    /// Why, for a person to read.
    pub reason: String,
}

/// The flags of a plan, each with its value when nothing is known of the model: the one for which a stage assumes nothing and
/// looks.
macro_rules! plan_flags {
    ($($(#[doc = $doc:literal])+ $flag:ident = $unknown:literal,)+) => {
        /// What is known of a model once and for all, where stages would otherwise look again at every step.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum PlanFlag {
            $($(#[doc = $doc])+ $flag,)+
        }

        impl PlanFlag {
            /// A bit for each flag that holds when nothing is known.
            const UNKNOWN: u32 = $((($unknown as u32) << PlanFlag::$flag as u32))|+;
        }
    };
}
plan_flags! {
    /// M of some tree depends on the configuration; otherwise it is diagonal and constant.
    General = true,
    /// Composite inertias are computed: some tree is computed by the general algorithm, or they are read.
    Composite = true,
    /// Inertias of bodies about the centre of mass of their tree are computed.
    BodyInertias = true,
    /// Forces of bodies are computed by recursion: some tree is computed by the general algorithm.
    Recursion = true,
    /// M and the rows of its factorization are computed only in steps in which constraints act: nothing else looks at them.
    MassForRows = false,
    /// There can be equality constraints.
    Equalities = true,
    /// There can be dry friction.
    FrictionLoss = true,
    /// Joints or tendons can be limited.
    Limits = true,
    /// Contacts pull.
    Adhesion = true,
    /// Surfaces move by themselves.
    Surfaces = true,
    /// Whether joints have dampers is known once and for all.
    DampersStay = false,
    /// Then: they do.
    JointDampers = true,
    /// Springs are looked at.
    Springs = true,
    /// Dampers are looked at.
    Dampers = true,
    /// Some dampers of joints belong to actuators.
    ActuatorDampers = true,
    /// All actuators are motors of slides and hinges: each makes a force in proportion to its control.
    Motors = false,
    /// All actuators are motors or servos of slides, hinges and tendons: their forces follow from a control, a length and a
    /// velocity.
    Servos = false,
    /// How forces change with velocities follows from the model alone, but for how much each actuator's force does.
    SlopesStay = false,
    /// Forces of actuators are limited, one by one or by joint.
    ForceLimits = true,
    /// The solver says more than forces: `efc_b` and `efc_state`.
    SolverDetails = true,
    /// Bodies feel a medium or gravity compensation.
    BodyForces = true,
    /// Forces applied to bodies are looked at.
    AppliedForces = true,
    /// Nothing but gravity and motion makes forces where no constraint acts: no springs, no actuators, none applied.
    Unforced = false,
    /// The same, M is diagonal, nothing can touch and no tree sleeps.
    Ballistic = false,
    /// Which pairs of geoms may touch can change while it runs.
    PairsChange = true,
    /// The parameters of contacts may change.
    ContactParamsChange = true,
    /// Where bodies, joints and geoms are in the model may change.
    PlacesChange = true,
}

/// Which stages run.
#[derive(Clone, Debug, PartialEq)]
pub struct PlanTable {
    pub(crate) decisions: Vec<Decision>,
    /// A bit for each stage that runs, and for each flag that holds.
    kept_stages: u32,
    flags: u32,
    /// How trees may be computed.
    pub algorithms: TreeAlgorithms,
    /// What is read of sensors.
    pub sensed: Values,
    /// Every sensor is evaluated, read or not.
    pub every_sensor: bool,
    /// A stage that runs because it was asked for, wanted or not.
    pub more: Option<Stage>,
    /// What a forward pass runs of each of its parts; then the same without what sensors show.
    pub(crate) passes: [[u32; 3]; 2],
}

impl Default for PlanTable {
    /// No stage, and nothing is known.
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

    /// Whether a flag holds.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub fn has(&self, flag: PlanFlag) -> bool {
        self.flags & (1 << flag as u32) != 0
    }

    /// Every stage with the reason to keep it or leave it out, in the order of the pipeline.
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
