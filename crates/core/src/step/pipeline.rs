//! The stages of a step as a table: what each needs, why it would run, why not, and what runs.
//!
//! A row is all that there is to know of a stage: the forward pass runs the rows in this order, the plan is decided from them
//! (from the last to the first, as a stage runs for what a later one needs), and `labspec plan` prints them. What a stage
//! computes stands in the field table, row by row under its [`Stage`].

use super::analysis::ModelAnalysis;
use super::calls as run;
use super::clocked::{self, CLOCKED};
use crate::dynamics::tree_algorithms;
use crate::kinds::{disable, integrator, trntype, wraptype};
use crate::math::broken_invariant;
use crate::model::reflect::{data, model};
use crate::model::stage::Stage;
use crate::model::{Model, Obj};
use crate::step::workspace::Workspace;
use crate::{collision, sensor};

/// When in a forward pass something runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PassPart {
    /// What depends on `qpos` alone.
    Positions,
    /// What depends on `qvel` as well.
    Velocities,
    /// What depends on inputs as well.
    Inputs,
}

type Run = fn(&Model, &mut Workspace);

/// Stages whose results are used (any, where the list is empty), and in which scenes.
type Need = (&'static [Stage], fn(&ModelAnalysis, Stage) -> bool);

/// A stage.
pub(super) struct Row {
    pub(super) stage: Stage,
    /// In words, before "stage".
    pub(super) name: &'static str,
    pub(super) needs: &'static [Need],
    /// Why it runs for its own sake.
    pub(super) wanted: fn(&ModelAnalysis) -> Option<String>,
    /// Why it does not run when nothing wants it.
    pub(super) left_out: fn(&ModelAnalysis) -> &'static str,
    pub(super) run: &'static [(PassPart, Run)],
}

impl Row {
    /// Whether the stage uses the results of another one in a scene.
    pub(super) fn uses(&self, analysis: &ModelAnalysis, of: Stage) -> bool {
        self.needs
            .iter()
            .any(|(stages, when)| (stages.is_empty() || stages.contains(&of)) && when(analysis, of))
    }
}

/// In every scene where the stage runs.
const ALWAYS: fn(&ModelAnalysis, Stage) -> bool = |_, _| true;

fn because(yes: bool, why: &str) -> Option<String> {
    yes.then(|| why.to_string())
}

/// The stages in their order.
pub(super) const STAGES: [Row; 26] = [
    Row {
        stage: Stage::Sleep,
        name: "sleep",
        needs: &[],
        wanted: |s| because(s.sleeps, "trees at rest fall asleep"),
        left_out: |s| if s.m.ntree == 0 { "nothing can move" } else { "the sleep flag is off" },
        run: &[(PassPart::Positions, run::wake), (PassPart::Inputs, run::keep_sleeping)],
    },
    Row {
        stage: Stage::Kinematics,
        name: "kinematics",
        needs: &[],
        wanted: |s| s.reads(Stage::Kinematics),
        left_out: |_| "nothing can touch and nothing reads a pose",
        run: &[(PassPart::Positions, run::bodies)],
    },
    Row {
        stage: Stage::Orientations,
        name: "orientation",
        needs: &[(&[Stage::Kinematics], ALWAYS)],
        wanted: |s| s.reads(Stage::Orientations),
        left_out: |_| "nothing reads an orientation as a quaternion",
        run: &[(PassPart::Positions, run::orientations)],
    },
    Row {
        stage: Stage::GeomPoses,
        name: "geom-pose",
        needs: &[(&[Stage::Kinematics], ALWAYS)],
        wanted: |s| s.reads(Stage::GeomPoses),
        left_out: |_| "no contact is possible and nothing reads a geom's pose",
        run: &[(PassPart::Positions, run::geoms)],
    },
    Row {
        stage: Stage::SitePoses,
        name: "site-pose",
        needs: &[(&[Stage::Kinematics], ALWAYS)],
        wanted: |s| s.reads(Stage::SitePoses),
        left_out: |s| match s.m.nsite {
            0 => "the model has no sites",
            _ => "nothing reads a site's pose",
        },
        run: &[(PassPart::Positions, run::sites)],
    },
    Row {
        stage: Stage::ComPos,
        name: "centre-of-mass",
        needs: &[(&[Stage::Kinematics], ALWAYS)],
        wanted: |s| s.reads(Stage::ComPos),
        left_out: |_| NO_SPATIAL_BODIES,
        run: &[(PassPart::Positions, run::com_pos)],
    },
    Row {
        stage: Stage::CameraPoses,
        name: "camera-pose",
        needs: &[(&[Stage::Orientations, Stage::ComPos], ALWAYS)],
        wanted: |s| s.reads(Stage::CameraPoses),
        left_out: |s| match s.m.ncam + s.m.nlight {
            0 => "the model has no cameras and lights",
            _ => "nothing reads the pose of a camera or light",
        },
        run: &[(PassPart::Positions, run::cameras_and_lights)],
    },
    Row {
        stage: Stage::Tendon,
        name: "tendon",
        needs: &[
            (&[Stage::Kinematics], ALWAYS),
            (&[Stage::SitePoses], |s, _| s.m.wrap_type.contains(&wraptype::SITE)),
            (&[Stage::GeomPoses], |s, _| s.m.wrap_type.iter().any(|&t| t > wraptype::SITE)),
        ],
        wanted: |s| {
            let wakes = s.sleeps && s.m.tendon_limited.contains(&true);
            s.reads(Stage::Tendon)
                .or_else(|| because(wakes, "tendons at their limits wake the trees that they connect"))
        },
        left_out: without_tendons,
        run: &[(PassPart::Positions, run::tendons)],
    },
    Row {
        stage: Stage::MassMatrix,
        name: "mass-matrix",
        needs: &[
            (&[Stage::ComPos], |s, _| s.large || s.reads_field(data::crb)),
            (&[Stage::Tendon], |s, _| s.tendon_armature),
        ],
        // Constant where all bodies are simple: only the composite inertias would be computed.
        wanted: |s| match s.general {
            true => Some(MOVING_MASS.into()),
            false => because(s.reads_field(data::crb), "data.crb is read"),
        },
        left_out: |_| CONSTANT_MASS,
        run: &[(PassPart::Positions, run::mass_matrix)],
    },
    Row {
        stage: Stage::Factor,
        name: "factorization",
        needs: &[],
        wanted: |s| because(s.general, MOVING_MASS),
        left_out: |_| CONSTANT_MASS,
        run: &[(PassPart::Positions, run::factor)],
    },
    Row {
        stage: Stage::Collision,
        name: "collision",
        needs: &[(&[Stage::GeomPoses], ALWAYS)],
        wanted: contacts,
        left_out: |s| {
            let off = s.m.opt.disabled(disable::CONTACT) || s.m.opt.disabled(disable::CONSTRAINT);
            match s.m.ngeom {
                _ if off => "contacts are switched off",
                0 => "the model has no geoms",
                _ => "no pair of geoms can ever touch",
            }
        },
        run: &[(PassPart::Positions, run::collide)],
    },
    Row {
        stage: Stage::Constraint,
        name: "constraint",
        needs: &[
            (&[Stage::Orientations], |s, _| s.welds_bodies()),
            (&[Stage::Kinematics], |s, _| s.pairs > 0 || s.ties_bodies()),
            (&[Stage::SitePoses], |s, _| s.ties_bodies() && s.m.eq_objtype.contains(&(Obj::Site as i32))),
            (&[Stage::Tendon], |s, _| s.tendon_constraints()),
        ],
        wanted: |s| {
            let wakes = s.sleeps && s.m.neq > 0;
            constraints(s).or_else(|| because(wakes, "trees that are tied together wake each other"))
        },
        left_out: |_| NO_CONSTRAINTS,
        run: &[(PassPart::Positions, run::make_constraints)],
    },
    Row {
        stage: Stage::Transmission,
        name: "transmission",
        needs: &[
            (&[Stage::Orientations, Stage::SitePoses], |s, _| s.transmits(&AT_SITES)),
            (&[Stage::Kinematics], |s, _| s.transmits(&AT_SITES) || s.transmits(&[trntype::BODY])),
            (&[Stage::Tendon], |s, _| s.transmits(&[trntype::TENDON])),
            (&[Stage::Collision, Stage::Constraint], |s, _| s.transmits(&[trntype::BODY])),
        ],
        wanted: |s| s.reads(Stage::Transmission),
        left_out: |s| without_actuators(s).unwrap_or("moments are constant and no force depends on a length"),
        run: &[(PassPart::Positions, run::transmissions)],
    },
    Row {
        stage: Stage::TendonVel,
        name: "tendon-velocity",
        needs: &[(&[Stage::Tendon], ALWAYS)],
        wanted: |s| s.reads(Stage::TendonVel),
        left_out: without_tendons,
        run: &[(PassPart::Velocities, run::tendon_velocities)],
    },
    Row {
        stage: Stage::ActuatorVel,
        name: "actuator-velocity",
        needs: &[(&[Stage::Transmission], ALWAYS)],
        wanted: |s| s.reads(Stage::ActuatorVel),
        left_out: |s| without_actuators(s).unwrap_or("no force depends on the velocity of an actuator"),
        run: &[(PassPart::Velocities, run::actuator_velocities)],
    },
    Row {
        stage: Stage::ComVel,
        name: "body-velocity",
        needs: &[(&[Stage::ComPos], ALWAYS)],
        wanted: |s| s.reads(Stage::ComVel),
        left_out: |_| NO_SPATIAL_BODIES,
        run: &[(PassPart::Velocities, run::com_vel)],
    },
    Row {
        stage: Stage::Passive,
        name: "passive-force",
        needs: &[
            (&[Stage::Tendon], |s, _| s.tendon_forces()),
            (&[Stage::TendonVel], |s, _| s.tendon_dampers),
            (&[Stage::Kinematics], |s, _| s.body_forces() || s.adhesion),
            (&[Stage::ComVel], |s, _| s.fluid),
            (&[Stage::GeomPoses], |s, _| s.fluid && s.ellipsoids()),
        ],
        wanted: |s| {
            because(s.joint_forces || s.tendon_forces(), "joints or tendons have springs or dampers")
                .or_else(|| because(s.fluid, "bodies move in a medium"))
                .or_else(|| because(s.adhesion, "contacts pull"))
                .or_else(|| because(s.gravcomp, "the weight of bodies is compensated"))
        },
        left_out: |_| "no joint or tendon has a spring or a damper, and bodies move in a vacuum",
        run: &[(PassPart::Velocities, run::passive)],
    },
    Row {
        stage: Stage::Reference,
        name: "reference",
        needs: &[(&[Stage::ComVel], |s, _| s.ties_bodies())],
        wanted: constraints,
        left_out: |_| NO_CONSTRAINTS,
        run: &[(PassPart::Velocities, run::reference)],
    },
    Row {
        stage: Stage::Bias,
        name: "bias-force",
        needs: &[
            (&[Stage::Tendon], |s, _| s.tendon_armature),
            (&[Stage::ComVel], |s, _| s.tendon_armature || s.large),
            (&[Stage::Kinematics], |s, _| tree_algorithms::look_at_places(s.m, s.algorithms)),
        ],
        wanted: |s| because(s.m.nv > 0, "gravity and the motion of bodies make forces"),
        left_out: |_| "nothing moves",
        run: &[(PassPart::Velocities, run::bias)],
    },
    Row {
        stage: Stage::Actuation,
        name: "actuation",
        needs: &[
            (&[Stage::Transmission, Stage::ActuatorVel], |s, _| s.lengths_act()),
            (&[Stage::Passive], |s, _| {
                s.m.jnt_actgravcomp.contains(&true) || s.writes(&[model::jnt_actgravcomp])
            }),
        ],
        wanted: |s| because(s.actuated, "actuators make forces"),
        left_out: |s| without_actuators(s).unwrap_or("actuators are switched off"),
        run: &[(PassPart::Inputs, run::actuation)],
    },
    Row {
        stage: Stage::Acceleration,
        name: "acceleration",
        needs: &[
            (&[Stage::ComVel], |s, _| s.bias_slopes()),
            // The discrete integrator takes springs at the end of the step, where velocities lead.
            (&[Stage::Tendon, Stage::TendonVel], |s, _| {
                s.tendon_forces() && s.may_integrate_by(integrator::DISCRETE)
            }),
            (&[Stage::Kinematics], |s, _| s.pushed()),
        ],
        wanted: |s| because(s.m.nv > 0, "the integrator needs it"),
        left_out: |_| "nothing moves",
        run: &[(PassPart::Inputs, run::acceleration)],
    },
    Row {
        stage: Stage::Solve,
        name: "solver",
        needs: &[],
        wanted: constraints,
        left_out: |_| NO_CONSTRAINTS,
        run: &[(PassPart::Inputs, run::solve)],
    },
    Row {
        stage: Stage::SubtreeVel,
        name: "subtree-momentum",
        needs: &[(&[Stage::ComVel], ALWAYS)],
        // Its fields show something only where a sensor asks for it.
        wanted: |s| s.reads(Stage::SubtreeVel).filter(|_| sensor::needs(s.m, Stage::SubtreeVel)),
        left_out: |_| "no sensor measures the momentum of a subtree",
        run: &[(PassPart::Velocities, run::subtree_velocities)],
    },
    Row {
        stage: Stage::RnePost,
        name: "body-force",
        needs: &[
            (&[Stage::ComVel], ALWAYS),
            // Spatial tendons pull at bodies.
            (&[Stage::Tendon, Stage::TendonVel, Stage::Actuation], |s, _| {
                s.m.wrap_type.contains(&wraptype::SITE)
            }),
        ],
        wanted: |s| s.reads(Stage::RnePost).filter(|_| sensor::needs(s.m, Stage::RnePost)),
        left_out: |_| "no sensor measures a force or an acceleration",
        run: &[(PassPart::Inputs, run::body_forces)],
    },
    Row {
        stage: Stage::Sensors,
        name: "sensor",
        needs: &[
            (&[Stage::Orientations], |s, _| {
                let poses = [Stage::Kinematics, Stage::GeomPoses, Stage::SitePoses, Stage::CameraPoses];
                poses.into_iter().any(|stage| s.sensed(stage))
            }),
            (&[], |s, of| s.sensed(of)),
        ],
        wanted: |s| because(s.sensors, "sensor values are read"),
        left_out: |s| match s.m.nsensor {
            0 => "the model has no sensors",
            _ => "nothing reads sensordata",
        },
        run: &[
            (PassPart::Positions, run::position_sensors),
            (PassPart::Velocities, run::velocity_sensors),
            (PassPart::Inputs, run::acceleration_sensors),
        ],
    },
    Row {
        stage: Stage::Energy,
        name: "energy",
        needs: &[
            (&[Stage::Sensors], |s, _| sensor::measures_energy(s.m)),
            (&[Stage::Kinematics], ALWAYS),
            (&[Stage::Tendon], |s, _| s.tendon_springs),
        ],
        wanted: |s| s.reads(Stage::Energy).filter(|_| s.energy || sensor::measures_energy(s.m)),
        left_out: |s| if s.energy { "nothing reads the energy" } else { "the energy flag is off" },
        run: &[(PassPart::Positions, run::potential_energy), (PassPart::Velocities, run::kinetic_energy)],
    },
];

const MOVING_MASS: &str = "the mass matrix depends on the configuration";
const CONSTANT_MASS: &str =
    "every moving body is a single free or sliding body: its mass matrix is diagonal and constant";
const NO_SPATIAL_BODIES: &str =
    "every tree is one rigid body, a short chain or slides alone, whose equations need no composite bodies";
const NO_CONSTRAINTS: &str = "no contact and no limit is possible";
/// Transmissions between sites.
const AT_SITES: [i32; 3] = [trntype::SITE, trntype::SLIDERCRANK, trntype::SO3];

fn without_tendons(s: &ModelAnalysis) -> &'static str {
    if s.m.ntendon == 0 { "the model has no tendons" } else { "nothing uses the tendons" }
}

fn without_actuators(s: &ModelAnalysis) -> Option<&'static str> {
    match s.m.nactuator {
        0 => Some("the model has no actuators"),
        _ if s.idle => Some("no actuator is driven: without a control none makes a force"),
        _ if !s.actuated => Some("actuators are switched off"),
        _ => None,
    }
}

fn count(n: usize, one: &str, many: &str) -> Option<String> {
    match n {
        0 => None,
        1 => Some(one.to_string()),
        n => Some(format!("{n} {many}")),
    }
}

fn contacts(s: &ModelAnalysis) -> Option<String> {
    match s.pairs {
        n if n > collision::MOST_LISTED => {
            Some(format!("more than {} pairs of geoms can touch", collision::MOST_LISTED))
        }
        n => count(n, "one pair of geoms can touch", "pairs of geoms can touch"),
    }
}

fn constraints(s: &ModelAnalysis) -> Option<String> {
    contacts(s)
        .or_else(|| count(s.limited, "one joint is limited", "joints are limited"))
        .or_else(|| count(s.limited_tendons, "one tendon is limited", "tendons are limited"))
        .or_else(|| count(s.friction, "one thing has dry friction", "things have dry friction"))
        .or_else(|| count(s.equalities, "there is one equality constraint", "equality constraints hold"))
}

/// What runs in a part of a forward pass, in order; a plan keeps some of it, a bit each.
pub(crate) struct Sequence<const N: usize> {
    run: [Run; N],
    stage: [Stage; N],
}

/// How many rows run something in a part.
const fn count_of(part: PassPart) -> usize {
    let (mut n, mut row) = (0, 0);
    while row < STAGES.len() {
        let mut k = 0;
        while k < STAGES[row].run.len() {
            n += (STAGES[row].run[k].0 as u8 == part as u8) as usize;
            k += 1;
        }
        row += 1;
    }
    n
}

impl<const N: usize> Sequence<N> {
    const fn new(part: PassPart) -> Sequence<N> {
        let mut all = Sequence { run: [nothing as Run; N], stage: [Stage::Sleep; N] };
        let (mut n, mut row) = (0, 0);
        while row < STAGES.len() {
            let mut k = 0;
            while k < STAGES[row].run.len() {
                if STAGES[row].run[k].0 as u8 == part as u8 {
                    all.run[n] = STAGES[row].run[k].1;
                    all.stage[n] = STAGES[row].stage;
                    n += 1;
                }
                k += 1;
            }
            row += 1;
        }
        all
    }

    /// The bits of what belongs to some stages.
    fn bits(&self, of: impl Fn(Stage) -> bool) -> u32 {
        self.stage.iter().enumerate().filter(|(_, s)| of(**s)).map(|(i, _)| 1 << i).sum()
    }

    /// The bits of the stages before one.
    pub(crate) fn before(&self, stage: Stage) -> u32 {
        let n = self.stage.iter().position(|s| *s == stage);
        let n = n.unwrap_or_else(|| broken_invariant("a stage runs in this part of a pass"));
        (1 << n) - 1
    }

    /// The bits of one stage.
    pub(crate) fn stage_bits(&self, stage: Stage) -> u32 {
        self.bits(|s| s == stage)
    }

    /// Runs what the bits say.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(crate) fn run(&self, m: &Model, d: &mut Workspace, mut bits: u32) {
        if bits & CLOCKED != 0 {
            return clocked::walk(&self.run, &self.stage, m, d, bits);
        }
        while let Some(run) = self.run.get(bits.trailing_zeros() as usize) {
            bits &= bits - 1;
            run(m, d);
        }
    }
}

fn nothing(_: &Model, _: &mut Workspace) {}

pub(crate) static POSITIONS: Sequence<{ count_of(PassPart::Positions) }> = Sequence::new(PassPart::Positions);
pub(crate) static VELOCITIES: Sequence<{ count_of(PassPart::Velocities) }> =
    Sequence::new(PassPart::Velocities);
pub(crate) static INPUTS: Sequence<{ count_of(PassPart::Inputs) }> = Sequence::new(PassPart::Inputs);

/// The same passes by the clock.
pub(crate) fn by_the_clock(passes: [[u32; 3]; 2]) -> [[u32; 3]; 2] {
    passes.map(|pass| pass.map(|bits| bits | CLOCKED))
}

/// What a forward pass runs of each part, for the stages that are kept.
pub(crate) fn passes(keeps: impl Fn(Stage) -> bool) -> [u32; 3] {
    [POSITIONS.bits(&keeps), VELOCITIES.bits(&keeps), INPUTS.bits(&keeps)]
}
