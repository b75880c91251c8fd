//! The stages of a step as a table: the results that each stage needs, the reasons to run it or not, and its functions.
//!
//! A row describes a stage completely. The forward pass runs the rows in this order. The plan is computed from them, from the
//! last to the first, because a stage runs if a later one needs it. `labspec plan` prints them. The field table lists the fields
//! that a stage computes under its [`Stage`]. All stages have the same signature: they read the model, and write the fields and
//! the scratch, of which each uses the part of its module.

use super::analysis::ModelAnalysis;
use super::clocked::Run;
use super::{calls, sleep};
use crate::dynamics::{com, kinematics, tree_algorithms};
use crate::forces::{actuation, passive, tendon, transmission};
use crate::kinds::{disable, integrator, trntype, wraptype};
use crate::model::Obj;
use crate::model::reflect::{data, model};
use crate::model::stage::Stage;
use crate::sensor::SensorStage;
use crate::{collision, constraint, sensor};

/// The part of a forward pass in which a function runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PassPart {
    /// Computations that depend on `qpos` alone.
    Positions,
    /// Computations that depend on `qvel` as well.
    Velocities,
    /// Computations that depend on inputs as well.
    Inputs,
}

/// Stages whose results a stage uses (all stages if the list is empty), and a condition on the scene.
type Need = (&'static [Stage], fn(&ModelAnalysis, Stage) -> bool);

/// A stage.
pub(super) struct PipelineRow {
    pub(super) stage: Stage,
    /// The name for people, before "stage".
    pub(super) name: &'static str,
    pub(super) needs: &'static [Need],
    /// The reason to run the stage even if no later stage needs it.
    pub(super) keep_reason: fn(&ModelAnalysis) -> Option<String>,
    /// The reason why the stage does not run if nothing needs it.
    pub(super) omit_reason: fn(&ModelAnalysis) -> &'static str,
    pub(super) run: &'static [(PassPart, Run)],
}

impl PipelineRow {
    /// Whether the stage uses the results of another one in a scene.
    pub(super) fn uses(&self, analysis: &ModelAnalysis, stage: Stage) -> bool {
        self.needs
            .iter()
            .any(|(stages, when)| (stages.is_empty() || stages.contains(&stage)) && when(analysis, stage))
    }
}

/// The condition for every scene in which the stage runs.
const ALWAYS: fn(&ModelAnalysis, Stage) -> bool = |_, _| true;

fn reason_if(yes: bool, why: &str) -> Option<String> {
    yes.then(|| why.to_string())
}

/// The stages, in their order.
pub(super) const STAGES: [PipelineRow; 26] = [
    PipelineRow {
        stage: Stage::Sleep,
        name: "sleep",
        needs: &[],
        keep_reason: |s| reason_if(s.sleeps, "trees at rest fall asleep"),
        omit_reason: |s| if s.m.ntree == 0 { "nothing can move" } else { "the sleep flag is off" },
        run: &[
            (PassPart::Positions, |m, d, s| sleep::wake(m, d, &mut s.sleep)),
            (PassPart::Inputs, |m, d, s| sleep::keep(m, d, &mut s.sleep)),
        ],
    },
    PipelineRow {
        stage: Stage::Kinematics,
        name: "kinematics",
        needs: &[],
        keep_reason: |s| s.reads(Stage::Kinematics),
        omit_reason: |_| "nothing can touch and nothing reads a pose",
        run: &[(PassPart::Positions, |m, d, s| tree_algorithms::forward_kinematics(m, d, &mut s.dynamics))],
    },
    PipelineRow {
        stage: Stage::Orientations,
        name: "orientation",
        needs: &[(&[Stage::Kinematics], ALWAYS)],
        keep_reason: |s| s.reads(Stage::Orientations),
        omit_reason: |_| "nothing reads an orientation as a quaternion",
        run: &[(PassPart::Positions, |_, d, s| tree_algorithms::orientations(d, &mut s.dynamics))],
    },
    PipelineRow {
        stage: Stage::GeomPoses,
        name: "geom-pose",
        needs: &[(&[Stage::Kinematics], ALWAYS)],
        keep_reason: |s| s.reads(Stage::GeomPoses),
        omit_reason: |_| "no contact is possible and nothing reads a geom's pose",
        run: &[(PassPart::Positions, |m, d, _| kinematics::geoms(m, d))],
    },
    PipelineRow {
        stage: Stage::SitePoses,
        name: "site-pose",
        needs: &[(&[Stage::Kinematics], ALWAYS)],
        keep_reason: |s| s.reads(Stage::SitePoses),
        omit_reason: |s| match s.m.nsite {
            0 => "the model has no sites",
            _ => "nothing reads a site's pose",
        },
        run: &[(PassPart::Positions, |m, d, _| kinematics::sites(m, d))],
    },
    PipelineRow {
        stage: Stage::ComPos,
        name: "centre-of-mass",
        needs: &[(&[Stage::Kinematics], ALWAYS)],
        keep_reason: |s| s.reads(Stage::ComPos),
        omit_reason: |_| NO_SPATIAL_BODIES,
        run: &[(PassPart::Positions, |m, d, _| com::com_pos(m, d))],
    },
    PipelineRow {
        stage: Stage::CameraPoses,
        name: "camera-pose",
        needs: &[(&[Stage::Orientations, Stage::ComPos], ALWAYS)],
        keep_reason: |s| s.reads(Stage::CameraPoses),
        omit_reason: |s| match s.m.ncam + s.m.nlight {
            0 => "the model has no cameras and lights",
            _ => "nothing reads the pose of a camera or light",
        },
        run: &[(PassPart::Positions, |m, d, _| calls::cameras_and_lights(m, d))],
    },
    PipelineRow {
        stage: Stage::Tendon,
        name: "tendon",
        needs: &[
            (&[Stage::Kinematics], ALWAYS),
            (&[Stage::SitePoses], |s, _| s.m.wrap_type.contains(&wraptype::SITE)),
            (&[Stage::GeomPoses], |s, _| s.m.wrap_type.iter().any(|&t| t > wraptype::SITE)),
        ],
        keep_reason: |s| {
            let wakes = s.sleeps && s.m.tendon_limited.contains(&true);
            s.reads(Stage::Tendon)
                .or_else(|| reason_if(wakes, "tendons at their limits wake the trees that they connect"))
        },
        omit_reason: without_tendons,
        run: &[(PassPart::Positions, |m, d, _| calls::tendons(m, d))],
    },
    PipelineRow {
        stage: Stage::MassMatrix,
        name: "mass-matrix",
        needs: &[
            (&[Stage::ComPos], |s, _| s.large || s.reads_field(data::crb)),
            (&[Stage::Tendon], |s, _| s.tendon_armature),
        ],
        // Constant if all bodies are simple: only the composite inertias would be computed.
        keep_reason: |s| match s.general {
            true => Some(MOVING_MASS.into()),
            false => reason_if(s.reads_field(data::crb), "data.crb is read"),
        },
        omit_reason: |_| CONSTANT_MASS,
        run: &[(PassPart::Positions, calls::mass_matrix)],
    },
    PipelineRow {
        stage: Stage::Factor,
        name: "factorization",
        needs: &[],
        keep_reason: |s| reason_if(s.general, MOVING_MASS),
        omit_reason: |_| CONSTANT_MASS,
        run: &[(PassPart::Positions, calls::factor)],
    },
    PipelineRow {
        stage: Stage::Collision,
        name: "collision",
        needs: &[(&[Stage::GeomPoses], ALWAYS)],
        keep_reason: contacts,
        omit_reason: |s| {
            let off = s.m.opt.disabled(disable::CONTACT) || s.m.opt.disabled(disable::CONSTRAINT);
            match s.m.ngeom {
                _ if off => "contacts are switched off",
                0 => "the model has no geoms",
                _ => "no pair of geoms can ever touch",
            }
        },
        run: &[(PassPart::Positions, calls::collide)],
    },
    PipelineRow {
        stage: Stage::Constraint,
        name: "constraint",
        needs: &[
            (&[Stage::Orientations], |s, _| s.welds_bodies()),
            (&[Stage::Kinematics], |s, _| s.pairs > 0 || s.constrains_bodies()),
            (&[Stage::SitePoses], |s, _| {
                s.constrains_bodies() && s.m.eq_objtype.contains(&(Obj::Site as i32))
            }),
            (&[Stage::Tendon], |s, _| s.tendon_constraints()),
        ],
        keep_reason: |s| {
            let wakes = s.sleeps && s.m.neq > 0;
            constraints(s).or_else(|| reason_if(wakes, "trees that are tied together wake each other"))
        },
        omit_reason: |_| NO_CONSTRAINTS,
        run: &[(PassPart::Positions, calls::make_constraints)],
    },
    PipelineRow {
        stage: Stage::Transmission,
        name: "transmission",
        needs: &[
            (&[Stage::Orientations, Stage::SitePoses], |s, _| s.transmits(&AT_SITES)),
            (&[Stage::Kinematics], |s, _| s.transmits(&AT_SITES) || s.transmits(&[trntype::BODY])),
            (&[Stage::Tendon], |s, _| s.transmits(&[trntype::TENDON])),
            (&[Stage::Collision, Stage::Constraint], |s, _| s.transmits(&[trntype::BODY])),
        ],
        keep_reason: |s| s.reads(Stage::Transmission),
        omit_reason: |s| {
            without_actuators(s).unwrap_or("moments are constant and no force depends on a length")
        },
        run: &[(PassPart::Positions, |m, d, s| transmission::transmissions(m, d, &mut s.forces))],
    },
    PipelineRow {
        stage: Stage::TendonVel,
        name: "tendon-velocity",
        needs: &[(&[Stage::Tendon], ALWAYS)],
        keep_reason: |s| s.reads(Stage::TendonVel),
        omit_reason: without_tendons,
        run: &[(PassPart::Velocities, |m, d, _| tendon::velocities(m, d))],
    },
    PipelineRow {
        stage: Stage::ActuatorVel,
        name: "actuator-velocity",
        needs: &[(&[Stage::Transmission], ALWAYS)],
        keep_reason: |s| s.reads(Stage::ActuatorVel),
        omit_reason: |s| without_actuators(s).unwrap_or("no force depends on the velocity of an actuator"),
        run: &[(PassPart::Velocities, |m, d, _| transmission::velocities(m, d))],
    },
    PipelineRow {
        stage: Stage::ComVel,
        name: "body-velocity",
        needs: &[(&[Stage::ComPos], ALWAYS)],
        keep_reason: |s| s.reads(Stage::ComVel),
        omit_reason: |_| NO_SPATIAL_BODIES,
        run: &[(PassPart::Velocities, |m, d, _| com::com_vel(m, d))],
    },
    PipelineRow {
        stage: Stage::Passive,
        name: "passive-force",
        needs: &[
            (&[Stage::Tendon], |s, _| s.tendon_forces()),
            (&[Stage::TendonVel], |s, _| s.tendon_dampers),
            (&[Stage::Kinematics], |s, _| s.body_forces() || s.adhesion),
            (&[Stage::ComVel], |s, _| s.fluid),
            (&[Stage::GeomPoses], |s, _| s.fluid && s.ellipsoids()),
        ],
        keep_reason: |s| {
            reason_if(s.joint_forces || s.tendon_forces(), "joints or tendons have springs or dampers")
                .or_else(|| reason_if(s.fluid, "bodies move in a medium"))
                .or_else(|| reason_if(s.adhesion, "contacts pull"))
                .or_else(|| reason_if(s.gravcomp, "the weight of bodies is compensated"))
        },
        omit_reason: |_| "no joint or tendon has a spring or a damper, and bodies move in a vacuum",
        run: &[(PassPart::Velocities, |m, d, _| passive::passive(m, d))],
    },
    PipelineRow {
        stage: Stage::Reference,
        name: "reference",
        needs: &[(&[Stage::ComVel], |s, _| s.constrains_bodies())],
        keep_reason: constraints,
        omit_reason: |_| NO_CONSTRAINTS,
        run: &[(PassPart::Velocities, |m, d, s| constraint::reference(m, d, &s.constraint))],
    },
    PipelineRow {
        stage: Stage::Bias,
        name: "bias-force",
        needs: &[
            (&[Stage::Tendon], |s, _| s.tendon_armature),
            (&[Stage::ComVel], |s, _| s.tendon_armature || s.large),
            (&[Stage::Kinematics], |s, _| tree_algorithms::bias_depends_on_poses(s.m, s.algorithms)),
        ],
        keep_reason: |s| reason_if(s.m.nv > 0, "gravity and the motion of bodies make forces"),
        omit_reason: |_| "nothing moves",
        run: &[(PassPart::Velocities, calls::bias)],
    },
    PipelineRow {
        stage: Stage::Actuation,
        name: "actuation",
        needs: &[
            (&[Stage::Transmission, Stage::ActuatorVel], |s, _| s.lengths_act()),
            (&[Stage::Passive], |s, _| {
                s.m.jnt_actgravcomp.contains(&true) || s.writes(&[model::jnt_actgravcomp])
            }),
        ],
        keep_reason: |s| reason_if(s.actuated, "actuators make forces"),
        omit_reason: |s| without_actuators(s).unwrap_or("actuators are switched off"),
        run: &[(PassPart::Inputs, |m, d, s| actuation::actuation(m, d, &mut s.forces))],
    },
    PipelineRow {
        stage: Stage::Acceleration,
        name: "acceleration",
        needs: &[
            (&[Stage::ComVel], |s, _| s.bias_slopes()),
            // The discrete integrator evaluates springs at the end of the step, so it needs velocities.
            (&[Stage::Tendon, Stage::TendonVel], |s, _| {
                s.tendon_forces() && s.may_integrate_by(integrator::DISCRETE)
            }),
            (&[Stage::Kinematics], |s, _| s.has_applied_forces()),
        ],
        keep_reason: |s| reason_if(s.m.nv > 0, "the integrator needs it"),
        omit_reason: |_| "nothing moves",
        run: &[(PassPart::Inputs, calls::acceleration)],
    },
    PipelineRow {
        stage: Stage::Solve,
        name: "solver",
        needs: &[],
        keep_reason: constraints,
        omit_reason: |_| NO_CONSTRAINTS,
        run: &[(PassPart::Inputs, calls::solve)],
    },
    PipelineRow {
        stage: Stage::SubtreeVel,
        name: "subtree-momentum",
        needs: &[(&[Stage::ComVel], ALWAYS)],
        // The fields are computed only if a sensor needs them.
        keep_reason: |s| s.reads(Stage::SubtreeVel).filter(|_| sensor::needs(s.m, Stage::SubtreeVel)),
        omit_reason: |_| "no sensor measures the momentum of a subtree",
        run: &[(PassPart::Velocities, |m, d, _| calls::subtree_velocities(m, d))],
    },
    PipelineRow {
        stage: Stage::RnePost,
        name: "body-force",
        needs: &[
            (&[Stage::ComVel], ALWAYS),
            // Spatial tendons exert forces on bodies.
            (&[Stage::Tendon, Stage::TendonVel, Stage::Actuation], |s, _| {
                s.m.wrap_type.contains(&wraptype::SITE)
            }),
        ],
        keep_reason: |s| s.reads(Stage::RnePost).filter(|_| sensor::needs(s.m, Stage::RnePost)),
        omit_reason: |_| "no sensor measures a force or an acceleration",
        run: &[(PassPart::Inputs, |m, d, _| calls::body_forces(m, d))],
    },
    PipelineRow {
        stage: Stage::Sensors,
        name: "sensor",
        needs: &[
            (&[Stage::Orientations], |s, _| {
                let poses = [Stage::Kinematics, Stage::GeomPoses, Stage::SitePoses, Stage::CameraPoses];
                poses.into_iter().any(|stage| s.is_used_by_sensors(stage))
            }),
            (&[], |s, stage| s.is_used_by_sensors(stage)),
        ],
        keep_reason: |s| reason_if(s.sensors, "sensor values are read"),
        omit_reason: |s| match s.m.nsensor {
            0 => "the model has no sensors",
            _ => "nothing reads sensordata",
        },
        run: &[
            (PassPart::Positions, |m, d, s| sensor::evaluate(m, d, &mut s.sensor, SensorStage::Position)),
            (PassPart::Velocities, |m, d, s| sensor::evaluate(m, d, &mut s.sensor, SensorStage::Velocity)),
            (PassPart::Inputs, |m, d, s| sensor::evaluate(m, d, &mut s.sensor, SensorStage::Acceleration)),
        ],
    },
    PipelineRow {
        stage: Stage::Energy,
        name: "energy",
        needs: &[
            (&[Stage::Sensors], |s, _| sensor::measures_energy(s.m)),
            (&[Stage::Kinematics], ALWAYS),
            (&[Stage::Tendon], |s, _| s.tendon_springs),
        ],
        keep_reason: |s| s.reads(Stage::Energy).filter(|_| s.energy || sensor::measures_energy(s.m)),
        omit_reason: |s| if s.energy { "nothing reads the energy" } else { "the energy flag is off" },
        run: &[
            (PassPart::Positions, calls::potential_energy),
            (PassPart::Velocities, |m, d, _| calls::kinetic_energy(m, d)),
        ],
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
