//! The plan: which stages a scene needs, with the reason for each, decided once and followed by every step.
//!
//! It follows from the structure of the model, from what will be read, and from what will be written: a
//! parameter that some program writes is treated as if it had any value. A plan never changes a number: the
//! stages it leaves out compute nothing that what is kept, or read, depends on.

use crate::dynamics::{articulated, chain, kinematics};
use crate::forces::{actuation, derivative};
use crate::kinds::{
    biastype, disable, dyntype, enable, eqtype, gaintype, integrator, joint, trntype, wraptype,
};
use crate::model::plan::Plan;
use crate::model::reflect::{FieldId, FieldSet, Object, Stage, field};
use crate::model::{Model, Obj};
use crate::step::damping;
use crate::{collision, sensor};

/// What programs read and write.
#[derive(Clone, Copy, Debug)]
pub struct Demand {
    /// Fields that are read between steps.
    pub reads: FieldSet,
    /// Fields that are written between steps.
    pub writes: FieldSet,
}

impl Demand {
    /// Anything may be read or written: what an embedding program gets that says nothing.
    pub const ANY: Demand = Demand { reads: FieldSet::ALL, writes: FieldSet::ALL };
    /// Anything may be read, only state and controls are written.
    pub const OBSERVE: Demand = Demand { reads: FieldSet::ALL, writes: FieldSet::EMPTY };
}

impl Plan {
    /// Every stage runs, needed or not: the reference that plans are held against.
    pub fn full() -> Plan {
        let mut plan = Plan::default();
        for stage in STAGES {
            plan.decide(stage, true, "the full pipeline was asked for".into());
        }
        plan
    }

    /// Every stage but the one that lets trees sleep: what computes constants wants all of them awake.
    pub fn awake() -> Plan {
        let mut plan = Plan::full();
        plan.kept &= !(1 << Stage::Sleep as u32);
        plan
    }

    /// The stages that this scene needs.
    ///
    /// From the last stage to the first: a stage runs when it is wanted for its own sake, or when a later
    /// stage that runs uses its results.
    pub fn new(m: &Model, demand: &Demand) -> Plan {
        let scene = Scene::new(m, demand);
        let mut plan = Plan {
            some_general: scene.general,
            composite: scene.large || scene.reads_field("crb"),
            recursion: scene.large,
            mass_for_rows: false,
            simple_bodies: m.dof_simplenum.iter().any(|&n| n > 0),
            chains_may_change: scene.writes(Object::Model, &chain::FIELDS),
            frames_may_change: scene.writes(Object::Model, &kinematics::FIELDS),
            equalities: scene.equalities > 0,
            friction_loss: scene.friction > 0,
            limits: scene.limited > 0 || scene.limited_tendons > 0,
            adhesion: scene.adhesion,
            surfaces: scene.pairs > 0 && scene.some(&[SURFACES]),
            damped: scene.damped(),
            springs: scene.some(&JOINT_FORCES[2..]) || scene.tendon_springs,
            dampers: scene.damped() != Some(false) || scene.tendon_dampers,
            actuator_dampers: scene.damped().is_none() || m.jnt_actuatorid.iter().any(|&i| i != -1),
            motors: scene.motors(),
            force_limits: m.actuator_forcelimited.contains(&true)
                || m.jnt_actfrclimited.contains(&true)
                || scene.writes(Object::Model, &["actuator_forcelimited", "jnt_actfrclimited"]),
            solver_details: scene.reads_field("efc_b") || scene.reads_field("efc_state"),
            body_forces: scene.body_forces(),
            applied_forces: scene.writes(Object::Data, &["xfrc_applied"]),
            pairs_may_change: scene.pairs_change,
            contact_params_may_change: scene.writes(Object::Model, &CONTACT_PARAMS)
                || scene.writes(Object::Option, &OVERRIDES),
            ..Plan::default()
        };
        for stage in STAGES.into_iter().rev() {
            let user = STAGES.into_iter().find(|&later| plan.keeps(later) && scene.uses(later, stage));
            let why = scene.wants(stage).or_else(|| user.map(|u| format!("the {} stage uses it", name(u))));
            match why {
                Some(reason) => plan.decide(stage, true, reason),
                None => plan.decide(stage, false, scene.leaves_out(stage).into()),
            }
        }
        plan.decisions.reverse();
        plan.mass_for_rows = scene.mass_for_rows(&plan);
        plan
    }
}

/// The stages of a forward pass, in order.
const STAGES: [Stage; 26] = [
    Stage::Sleep,
    Stage::Kinematics,
    Stage::Orientations,
    Stage::GeomPoses,
    Stage::SitePoses,
    Stage::ComPos,
    Stage::CameraPoses,
    Stage::Tendon,
    Stage::MassMatrix,
    Stage::Factor,
    Stage::Collision,
    Stage::Constraint,
    Stage::Transmission,
    Stage::TendonVel,
    Stage::ActuatorVel,
    Stage::ComVel,
    Stage::Passive,
    Stage::Reference,
    Stage::Bias,
    Stage::Actuation,
    Stage::Acceleration,
    Stage::Solve,
    Stage::SubtreeVel,
    Stage::RnePost,
    Stage::Sensors,
    Stage::Energy,
];

/// What the parameters of a contact are mixed from.
const CONTACT_PARAMS: [&str; 18] = [
    "geom_rbound",
    "geom_condim",
    "geom_priority",
    "geom_solmix",
    "geom_solref",
    "geom_solimp",
    "geom_friction",
    "geom_margin",
    "geom_gap",
    "geom_adhesion",
    "pair_dim",
    "pair_friction",
    "pair_solref",
    "pair_solreffriction",
    "pair_solimp",
    "pair_margin",
    "pair_gap",
    "pair_adhesion",
];
/// The name of a field, and its numbers.
type Numbers = (&'static str, fn(&Model) -> &[f64]);
/// What makes passive forces of joints.
const JOINT_FORCES: [Numbers; 4] = [
    ("dof_damping", |m| &m.dof_damping),
    ("dof_dampingpoly", |m| &m.dof_dampingpoly),
    ("jnt_stiffness", |m| &m.jnt_stiffness),
    ("jnt_stiffnesspoly", |m| &m.jnt_stiffnesspoly),
];
/// What makes passive forces of tendons, springs first.
const TENDON_FORCES: [Numbers; 4] = [
    ("tendon_stiffness", |m| &m.tendon_stiffness),
    ("tendon_stiffnesspoly", |m| &m.tendon_stiffnesspoly),
    ("tendon_damping", |m| &m.tendon_damping),
    ("tendon_dampingpoly", |m| &m.tendon_dampingpoly),
];
/// Damping of actuators, which joints and tendons have.
const ACTUATOR_DAMPING: [Numbers; 2] =
    [("actuator_damping", |m| &m.actuator_damping), ("actuator_dampingpoly", |m| &m.actuator_dampingpoly)];
/// Dry friction.
const FRICTION_LOSS: [Numbers; 2] =
    [("dof_frictionloss", |m| &m.dof_frictionloss), ("tendon_frictionloss", |m| &m.tendon_frictionloss)];
const ACTUATOR_ARMATURE: Numbers = ("actuator_armature", |m| &m.actuator_armature);
const TENDON_ARMATURE: Numbers = ("tendon_armature", |m| &m.tendon_armature);
/// Geoms on which the medium acts one by one.
const ELLIPSOIDS: Numbers = ("geom_fluid", |m| &m.geom_fluid);
/// Contacts that pull, and surfaces that move by themselves.
const ADHESION: [Numbers; 2] =
    [("geom_adhesion", |m| &m.geom_adhesion), ("pair_adhesion", |m| &m.pair_adhesion)];
const SURFACES: Numbers = ("geom_surfacevel", |m| &m.geom_surfacevel);
const GRAVCOMP: Numbers = ("body_gravcomp", |m| &m.body_gravcomp);
const OVERRIDES: [&str; 5] = ["o_margin", "o_solref", "o_solimp", "o_friction", "enableflags"];

/// A stage's name in words.
fn name(stage: Stage) -> &'static str {
    match stage {
        Stage::Orientations => "orientation",
        Stage::GeomPoses => "geom-pose",
        Stage::SitePoses => "site-pose",
        Stage::ComPos => "centre-of-mass",
        Stage::CameraPoses => "camera-pose",
        Stage::Tendon => "tendon",
        Stage::Transmission => "transmission",
        Stage::TendonVel => "tendon-velocity",
        Stage::ActuatorVel => "actuator-velocity",
        Stage::Actuation => "actuation",
        Stage::SubtreeVel => "subtree-momentum",
        Stage::RnePost => "body-force",
        Stage::MassMatrix => "mass-matrix",
        Stage::Factor => "factorization",
        Stage::Collision => "collision",
        Stage::Constraint => "constraint",
        Stage::ComVel => "body-velocity",
        Stage::Passive => "passive-force",
        Stage::Reference => "reference",
        Stage::Bias => "bias-force",
        Stage::Acceleration => "acceleration",
        Stage::Solve => "solver",
        Stage::Sensors => "sensor",
        Stage::Energy => "energy",
        Stage::Sleep => "sleep",
        _ => "kinematics",
    }
}

/// What is known of a scene before it runs.
struct Scene<'a> {
    m: &'a Model,
    demand: &'a Demand,
    /// Some tree is more than one simple body.
    general: bool,
    /// Some tree is more than a simple body or a short chain.
    large: bool,
    /// Which pairs of geoms may touch can change while it runs.
    pairs_change: bool,
    /// Number of pairs of geoms that may touch.
    pairs: usize,
    /// Number of joints and tendons with limits, or all when limits are switched while it runs.
    limited: usize,
    limited_tendons: usize,
    /// Number of degrees of freedom and tendons with dry friction, likewise.
    friction: usize,
    equalities: usize,
    /// Springs and dampers of joints, springs of tendons, dampers of tendons.
    joint_forces: bool,
    tendon_springs: bool,
    tendon_dampers: bool,
    gravcomp: bool,
    /// Contacts pull.
    adhesion: bool,
    /// The medium resists.
    fluid: bool,
    tendon_armature: bool,
    actuated: bool,
    sensors: bool,
    energy: bool,
    /// Trees may sleep.
    sleeps: bool,
}

impl<'a> Scene<'a> {
    fn new(m: &'a Model, demand: &'a Demand) -> Scene<'a> {
        let mut scene = Scene {
            m,
            demand,
            general: (0..m.nv).any(|i| m.dof_simplenum[i] == 0),
            large: (0..m.nv).any(|i| m.dof_simplenum[i] == 0 && !chain::covers(m, i)),
            pairs_change: false,
            pairs: 0,
            limited: m.jnt_limited.iter().filter(|&&l| l).count(),
            limited_tendons: m.tendon_limited.iter().filter(|&&l| l).count(),
            friction: 0,
            equalities: m.neq,
            joint_forces: false,
            tendon_springs: false,
            tendon_dampers: false,
            gravcomp: false,
            adhesion: false,
            fluid: m.opt.density > 0.0 || m.opt.viscosity > 0.0,
            tendon_armature: false,
            actuated: m.nactuator > 0 && !m.opt.disabled(disable::ACTUATION),
            sensors: false,
            energy: m.opt.enabled(enable::ENERGY),
            sleeps: false,
        };
        scene.sleeps =
            m.ntree > 0 && (m.opt.enabled(enable::SLEEP) || scene.writes(Object::Option, &["enableflags"]));
        scene.pairs_change = scene.writes(Object::Model, &["geom_contype", "geom_conaffinity"])
            || scene.writes(Object::Option, &["disableflags"]);
        // What a flag switches off counts only if the flag may be cleared.
        let off = |bit: i32| {
            (m.opt.disabled(disable::CONSTRAINT) || m.opt.disabled(bit))
                && !scene.writes(Object::Option, &["disableflags"])
        };
        let [no_contacts, no_limits, no_friction, no_equalities] =
            [disable::CONTACT, disable::LIMIT, disable::FRICTIONLOSS, disable::EQUALITY].map(off);
        if !no_contacts {
            scene.pairs = collision::candidate_pairs(m, scene.pairs_change).len();
        }
        if scene.writes(Object::Model, &["jnt_limited"]) {
            scene.limited = m.njnt;
        }
        if scene.writes(Object::Model, &["tendon_limited"]) {
            scene.limited_tendons = m.ntendon;
        }
        scene.friction = FRICTION_LOSS.iter().map(|f| scene.others_than_zero(f)).sum();
        if no_limits {
            (scene.limited, scene.limited_tendons) = (0, 0);
        }
        if no_friction {
            scene.friction = 0;
        }
        if no_equalities {
            scene.equalities = 0;
        }
        scene.fluid |= scene.writes(Object::Option, &["density", "viscosity"]);
        scene.gravcomp = scene.some(&[GRAVCOMP]);
        scene.adhesion = scene.pairs > 0 && scene.some(&ADHESION);
        scene.joint_forces = scene.some(&JOINT_FORCES);
        scene.tendon_springs = scene.some(&TENDON_FORCES[..2]);
        scene.tendon_dampers = scene.some(&TENDON_FORCES[2..]);
        scene.tendon_armature = scene.some(&[TENDON_ARMATURE]);
        let damping = scene.some(&ACTUATOR_DAMPING);
        scene.joint_forces |= damping && scene.transmits(&[trntype::JOINT, trntype::JOINTINPARENT]);
        let on_tendons = scene.transmits(&[trntype::TENDON]);
        scene.tendon_dampers |= on_tendons && damping;
        scene.tendon_armature |= on_tendons && scene.some(&[ACTUATOR_ARMATURE]);
        // A tendon's inertia adds to that of simple bodies, too.
        scene.general |= scene.tendon_armature;
        scene.actuated |= m.nactuator > 0 && scene.writes(Object::Option, &["disableflags"]);
        scene.sensors = m.nsensor > 0
            && (scene.reads(Stage::Sensors).is_some() || m.nhistory > 0 && scene.reads_field("history"));
        scene.energy |= scene.writes(Object::Option, &["enableflags"]);
        scene
    }

    /// Whether one of these numbers is or may become other than zero.
    fn some(&self, of: &[Numbers]) -> bool {
        of.iter().any(|numbers| self.others_than_zero(numbers) > 0)
    }

    /// How many of these numbers are or may become other than zero.
    fn others_than_zero(&self, (name, numbers): &Numbers) -> usize {
        let numbers = numbers(self.m);
        if self.writes(Object::Model, &[name]) {
            return numbers.len();
        }
        numbers.iter().filter(|&&x| x != 0.0).count()
    }

    /// Whether joints have dampers, unless programs may change that.
    fn damped(&self) -> Option<bool> {
        let own = [JOINT_FORCES[0].0, JOINT_FORCES[1].0];
        let actuators = ACTUATOR_DAMPING.map(|f| f.0);
        let changes = self.writes(Object::Model, &own)
            || self.writes(Object::Model, &actuators)
            || self.writes(Object::Model, &[ACTUATOR_ARMATURE.0])
            || self.writes(Object::Option, &["disableflags"]);
        (!changes).then(|| damping::has_dampers(self.m))
    }

    /// Whether only constraints look at M: all trees are single bodies, short chains, or factorized as articulated
    /// bodies, and the integrator does without.
    fn mass_for_rows(&self, plan: &Plan) -> bool {
        let m = self.m;
        let fields = ["M", "qLD", "qLDiagInv", "crb"];
        let integrates = matches!(m.opt.integrator, integrator::EULER | integrator::RK4);
        let changes = ["integrator", "enableflags"];
        self.general
            && integrates
            && !self.writes(Object::Option, &changes)
            && !m.opt.enabled(enable::DIAGEXACT)
            && !self.tendon_armature
            && !self.sleeps
            && !plan.keeps(Stage::Energy)
            && !sensor::needs(m, Stage::MassMatrix)
            && !fields.into_iter().any(|f| self.reads_field(f))
            && (0..m.nv).all(|k| m.dof_simplenum[k] > 0 || chain::covers(m, k) || articulated::covers(m, k))
    }

    /// Whether forces of actuators depend on their lengths or velocities, or their moments on the configuration.
    fn lengths_act(&self) -> bool {
        let m = self.m;
        let dynamics = |i: usize| {
            let without = [dyntype::NONE, dyntype::INTEGRATOR, dyntype::FILTER, dyntype::FILTEREXACT];
            without.contains(&m.actuator_dyntype[i])
        };
        self.sleeps
            || self.writes(Object::Model, &["actuator_gear"])
            || !(0..m.nactuator).all(|i| self.is_motor(i) && dynamics(i))
    }

    /// Whether an actuator acts on a slide or a hinge, with a force in proportion to its input.
    fn is_motor(&self, i: usize) -> bool {
        let m = self.m;
        let joint = usize::try_from(m.actuator_trnid[2 * i]).ok().filter(|&j| j < m.njnt);
        matches!(m.actuator_trntype[i], trntype::JOINT | trntype::JOINTINPARENT)
            && joint.is_some_and(|j| matches!(m.jnt_type[j], joint::SLIDE | joint::HINGE))
            && m.actuator_gaintype[i] == gaintype::FIXED
            && m.actuator_biastype[i] == biastype::NONE
    }

    /// Whether all actuators are motors, each with one control and none of them ever switched off.
    fn motors(&self) -> bool {
        let m = self.m;
        let plain = |i: usize| {
            self.is_motor(i)
                && m.actuator_dyntype[i] == dyntype::NONE
                && m.actuator_ctrlnum[i] == 1
                && !actuation::switched_off(m, i)
        };
        let switched = self.writes(Object::Option, &["disableactuator"])
            || self.writes(Object::Model, &["actuator_group", "actuator_gear"]);
        !self.sleeps && !switched && m.nhistory == 0 && m.nout == m.nactuator && (0..m.nactuator).all(plain)
    }

    /// Forces on bodies as such.
    fn body_forces(&self) -> bool {
        self.gravcomp || self.fluid
    }

    /// Constraints between points or frames of bodies.
    fn ties_bodies(&self) -> bool {
        self.m.eq_type.iter().any(|&t| t == eqtype::CONNECT || t == eqtype::WELD)
    }

    /// Constraints of the lengths of tendons.
    fn tendon_constraints(&self) -> bool {
        let m = self.m;
        self.limited_tendons > 0
            || m.eq_type.contains(&eqtype::TENDON)
            || self.some(&[("tendon_frictionloss", |m| &m.tendon_frictionloss)])
    }

    /// Forces along tendons.
    fn tendon_forces(&self) -> bool {
        self.tendon_springs || self.tendon_dampers
    }

    /// Why a stage is wanted for its own sake.
    fn wants(&self, stage: Stage) -> Option<String> {
        let m = self.m;
        let because = |yes: bool, why: &str| yes.then(|| why.to_string());
        let count = |n: usize, one: &str, many: &str| match n {
            0 => None,
            1 => Some(one.to_string()),
            n => Some(format!("{n} {many}")),
        };
        let contacts = || match self.pairs {
            n if n > collision::MOST_LISTED => {
                Some(format!("more than {} pairs of geoms can touch", collision::MOST_LISTED))
            }
            n => count(n, "one pair of geoms can touch", "pairs of geoms can touch"),
        };
        let single = || {
            count(self.limited, "one joint is limited", "joints are limited")
                .or_else(|| count(self.limited_tendons, "one tendon is limited", "tendons are limited"))
                .or_else(|| count(self.friction, "one thing has dry friction", "things have dry friction"))
                .or_else(|| {
                    count(self.equalities, "there is one equality constraint", "equality constraints hold")
                })
        };
        match stage {
            Stage::Sleep => because(self.sleeps, "trees at rest fall asleep"),
            Stage::MassMatrix | Stage::Factor if self.general => {
                Some("the mass matrix depends on the configuration".into())
            }
            // Constant where all bodies are simple: only the composite inertias would be computed.
            Stage::MassMatrix => because(self.reads_field("crb"), "data.crb is read"),
            Stage::Factor => None,
            Stage::Collision => contacts(),
            Stage::Constraint | Stage::Reference | Stage::Solve => contacts().or_else(single),
            Stage::Passive if self.joint_forces || self.tendon_forces() => {
                Some("joints or tendons have springs or dampers".into())
            }
            Stage::Passive if self.fluid => Some("bodies move in a medium".into()),
            Stage::Passive if self.adhesion => Some("contacts pull".into()),
            Stage::Passive => because(self.gravcomp, "the weight of bodies is compensated"),
            Stage::Actuation => because(self.actuated, "actuators make forces"),
            Stage::Bias => because(m.nv > 0, "gravity and the motion of bodies make forces"),
            Stage::Acceleration => because(m.nv > 0, "it is what the integrator needs"),
            // Their fields show something only where a sensor asks for it.
            Stage::SubtreeVel | Stage::RnePost => self.reads(stage).filter(|_| sensor::needs(m, stage)),
            Stage::Sensors => because(self.sensors, "sensor values are read"),
            Stage::Energy => self.reads(stage).filter(|_| self.energy || sensor::measures_energy(m)),
            _ => self.reads(stage),
        }
    }

    /// Whether one stage uses the results of another.
    fn uses(&self, stage: Stage, of: Stage) -> bool {
        let m = self.m;
        match (stage, of) {
            (
                Stage::Orientations | Stage::GeomPoses | Stage::SitePoses | Stage::ComPos,
                Stage::Kinematics,
            ) => true,
            (Stage::CameraPoses, Stage::Orientations) => true,
            (Stage::Constraint, Stage::Orientations) => self.ties_bodies(),
            (Stage::Transmission, Stage::Orientations) => {
                self.transmits(&[trntype::SITE, trntype::SLIDERCRANK, trntype::SO3])
            }
            (Stage::Sensors, Stage::Orientations) => {
                [Stage::Kinematics, Stage::GeomPoses, Stage::SitePoses, Stage::CameraPoses]
                    .into_iter()
                    .any(|poses| sensor::needs(m, poses))
            }
            (Stage::ComVel, Stage::ComPos) => true,
            (Stage::MassMatrix, Stage::ComPos) => self.large || self.reads_field("crb"),
            (Stage::CameraPoses, Stage::ComPos) => true,
            (Stage::Sleep, Stage::Tendon) => self.sleeps && m.tendon_limited.contains(&true),
            (Stage::Tendon, Stage::Kinematics) => true,
            (Stage::Tendon, Stage::SitePoses) => m.wrap_type.contains(&wraptype::SITE),
            (Stage::Tendon, Stage::GeomPoses) => m.wrap_type.iter().any(|&t| t > wraptype::SITE),
            (Stage::TendonVel, Stage::Tendon) => true,
            (Stage::MassMatrix | Stage::Bias, Stage::Tendon) => self.tendon_armature,
            (Stage::Bias, Stage::ComVel) if self.tendon_armature => true,
            (Stage::Passive, Stage::Tendon) => self.tendon_forces(),
            (Stage::Passive, Stage::TendonVel) => self.tendon_dampers,
            (Stage::Passive, Stage::Kinematics) => self.body_forces() || self.adhesion,
            (Stage::Passive, Stage::ComVel) => self.fluid,
            (Stage::Passive, Stage::GeomPoses) => self.fluid && self.some(&[ELLIPSOIDS]),
            (Stage::Transmission, Stage::Kinematics) => {
                self.transmits(&[trntype::SITE, trntype::SLIDERCRANK, trntype::SO3, trntype::BODY])
            }
            (Stage::Transmission, Stage::SitePoses) => {
                self.transmits(&[trntype::SITE, trntype::SLIDERCRANK, trntype::SO3])
            }
            (Stage::Transmission, Stage::Tendon) => self.transmits(&[trntype::TENDON]),
            (Stage::Transmission, Stage::Collision | Stage::Constraint) => self.transmits(&[trntype::BODY]),
            (Stage::ActuatorVel, Stage::Transmission) => true,
            (Stage::Actuation, Stage::Transmission | Stage::ActuatorVel) => self.lengths_act(),
            (Stage::Actuation, Stage::Passive) => m.jnt_actgravcomp.contains(&true),
            (Stage::Collision, Stage::GeomPoses) => true,
            (Stage::Constraint, Stage::Kinematics) => self.pairs > 0 || self.ties_bodies(),
            (Stage::Constraint, Stage::SitePoses) => {
                self.ties_bodies() && m.eq_objtype.contains(&(Obj::Site as i32))
            }
            (Stage::Constraint, Stage::Tendon) => self.tendon_constraints(),
            (Stage::Reference, Stage::ComVel) => self.ties_bodies(),
            (Stage::Bias, Stage::ComVel) => self.large,
            (Stage::Acceleration, Stage::ComVel) => self.bias_slopes(),
            // The discrete integrator takes springs at the end of the step, where velocities lead.
            (Stage::Acceleration, Stage::Tendon | Stage::TendonVel) => {
                self.tendon_forces() && self.may_integrate_by(integrator::DISCRETE)
            }
            (Stage::Bias, Stage::Kinematics) if self.large => true,
            // A simple body's weight acts along its slides.
            (Stage::Bias, Stage::Kinematics) => (0..m.njnt)
                .any(|j| m.jnt_type[j] == joint::SLIDE && m.body_simple[m.jnt_bodyid[j] as usize] > 0),
            (Stage::Acceleration, Stage::Kinematics) => self.writes(Object::Data, &["xfrc_applied"]),
            (Stage::SubtreeVel | Stage::RnePost, Stage::ComVel) => true,
            // Spatial tendons pull at bodies.
            (Stage::RnePost, Stage::Tendon | Stage::TendonVel | Stage::Actuation) => {
                m.wrap_type.contains(&wraptype::SITE)
            }
            (Stage::Sensors, _) => sensor::needs(m, of),
            (Stage::Energy, Stage::Sensors) => sensor::measures_energy(m),
            (Stage::Energy, Stage::Kinematics) => true,
            (Stage::Energy, Stage::Tendon) => self.tendon_springs,
            _ => false,
        }
    }

    /// Whether the options name an integrator, or may come to name it.
    fn may_integrate_by(&self, kind: i32) -> bool {
        self.m.opt.integrator == kind || self.writes(Object::Option, &["integrator"])
    }

    /// Whether an integrator asks how the bias force changes with velocities: that is found from composite bodies.
    fn bias_slopes(&self) -> bool {
        let free = || (0..self.m.ntree).any(|t| derivative::is_free_rigid(self.m, t));
        self.may_integrate_by(integrator::IMPLICIT)
            || self.may_integrate_by(integrator::IMPLICITFAST) && free()
    }

    /// Why a stage is left out.
    fn leaves_out(&self, stage: Stage) -> &'static str {
        let m = self.m;
        match stage {
            Stage::Sleep if m.ntree == 0 => "nothing can move",
            Stage::Sleep => "the sleep flag is off",
            Stage::Kinematics => "nothing can touch and nothing reads a pose",
            Stage::Orientations => "nothing reads an orientation as a quaternion",
            Stage::GeomPoses => "no contact is possible and nothing reads a geom's pose",
            Stage::SitePoses if m.nsite == 0 => "the model has no sites",
            Stage::SitePoses => "nothing reads a site's pose",
            Stage::ComPos | Stage::ComVel => {
                "every tree is one simple body or a short chain, whose equations need no composite bodies"
            }
            Stage::MassMatrix | Stage::Factor => {
                "every moving body is a single free or sliding one: its mass matrix is diagonal and constant"
            }
            Stage::Collision if m.opt.disabled(disable::CONTACT) || m.opt.disabled(disable::CONSTRAINT) => {
                "contacts are switched off"
            }
            Stage::Collision if m.ngeom == 0 => "the model has no geoms",
            Stage::Collision => "no pair of geoms can ever touch",
            Stage::Constraint | Stage::Reference | Stage::Solve => "no contact and no limit is possible",
            Stage::Passive => "no joint or tendon has a spring or a damper, and bodies move in a vacuum",
            Stage::CameraPoses if m.ncam + m.nlight == 0 => "the model has no cameras and lights",
            Stage::CameraPoses => "nothing reads the pose of a camera or light",
            Stage::Tendon | Stage::TendonVel if m.ntendon == 0 => "the model has no tendons",
            Stage::Tendon | Stage::TendonVel => "nothing uses the tendons",
            Stage::Transmission | Stage::ActuatorVel | Stage::Actuation if m.nactuator == 0 => {
                "the model has no actuators"
            }
            Stage::Actuation => "actuators are switched off",
            Stage::Transmission | Stage::ActuatorVel if !self.actuated => "actuators are switched off",
            Stage::Transmission => "moments are constant and no force depends on a length",
            Stage::ActuatorVel => "no force depends on the velocity of an actuator",
            Stage::SubtreeVel => "no sensor measures the momentum of a subtree",
            Stage::RnePost => "no sensor measures a force or an acceleration",
            Stage::Sensors if m.nsensor == 0 => "the model has no sensors",
            Stage::Sensors => "nothing reads sensordata",
            Stage::Energy if self.energy => "nothing reads the energy",
            Stage::Energy => "the energy flag is off",
            _ => "nothing moves",
        }
    }

    /// The first field of a stage that is read, as a reason.
    fn reads(&self, stage: Stage) -> Option<String> {
        if self.demand.reads == FieldSet::ALL {
            return Some("its results may be read".into());
        }
        let of_stage = |f: &FieldId| f.info().object == Object::Data && f.info().stage == stage;
        self.demand.reads.iter().find(of_stage).map(|f| format!("data.{} is read", f.info().name))
    }

    fn reads_field(&self, name: &str) -> bool {
        field(Object::Data, name).is_some_and(|f| self.demand.reads.contains(f))
    }

    fn writes(&self, object: Object, names: &[&str]) -> bool {
        names.iter().any(|n| field(object, n).is_some_and(|f| self.demand.writes.contains(f)))
    }

    /// Whether an actuator acts through one of these transmissions.
    fn transmits(&self, kinds: &[i32]) -> bool {
        self.m.actuator_trntype.iter().any(|t| kinds.contains(t))
    }
}
