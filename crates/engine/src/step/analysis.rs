//! Analyses a scene before it runs: facts that follow from the model and from the fields that programs read and write.

pub use super::access::AccessSet;

use super::deciding::{
    ACTUATOR_ARMATURE, ACTUATOR_DAMPING, ADHESION, CONTACT_PARAMS, ELLIPSOIDS, FRICTION_LOSS, GRAVCOMP,
    JOINT_FORCES, Numbers, OVERRIDES, SURFACES, TENDON_ARMATURE, TENDON_FORCES,
};

use crate::dynamics::tree_algorithms;
use crate::forces::{actuation, derivative, tendon};
use crate::kinds::{biastype, disable, dyntype, enable, eqtype, gaintype, integrator, joint, trntype};
use crate::model::plan::PlanFlag;
use crate::model::reflect::{FieldId, FieldSet, Object, Stage, data, model, option};
use crate::model::tree_algorithm::TreeAlgorithms;
use crate::model::{Model, PlanTable};
use crate::step::{damping, idle};
use crate::{collision, sensor};

/// The condition for a flag.
type Test = fn(&ModelAnalysis) -> bool;

/// The flags that follow from the analysis, each with its condition. Four others depend on the stages that a plan keeps:
/// [`PlanFlag::Unforced`], [`PlanFlag::Ballistic`], [`PlanFlag::BodyInertias`] and [`PlanFlag::MassForRows`].
pub(super) const FLAGS: [(PlanFlag, Test); 23] = [
    (PlanFlag::General, |s| s.general),
    (PlanFlag::Composite, |s| s.large || s.reads_field(data::crb)),
    (PlanFlag::Recursion, |s| s.large),
    (PlanFlag::Equalities, |s| s.equalities > 0),
    (PlanFlag::FrictionLoss, |s| s.friction > 0),
    (PlanFlag::Limits, |s| s.limited > 0 || s.limited_tendons > 0),
    (PlanFlag::Adhesion, |s| s.adhesion),
    (PlanFlag::Surfaces, |s| s.pairs > 0 && s.has_nonzero(&[SURFACES])),
    (PlanFlag::ConstantDamping, |s| s.damped().is_some()),
    (PlanFlag::JointDampers, |s| s.damped() == Some(true)),
    (PlanFlag::Springs, |s| s.has_nonzero(&JOINT_FORCES[2..]) || s.tendon_springs),
    (PlanFlag::Dampers, |s| s.damped() != Some(false) || s.tendon_dampers),
    (PlanFlag::ActuatorDampers, |s| s.damped().is_none() || s.m.jnt_actuatorid.iter().any(|&i| i != -1)),
    (PlanFlag::Motors, |s| s.actuators_are(ModelAnalysis::is_motor)),
    (PlanFlag::Servos, |s| s.actuators_are(ModelAnalysis::is_servo)),
    (PlanFlag::ConstantVelocityDerivatives, |s| s.has_constant_velocity_derivatives()),
    (PlanFlag::ForceLimits, |s| {
        s.m.actuator_forcelimited.contains(&true)
            || s.m.jnt_actfrclimited.contains(&true)
            || s.writes(&[model::actuator_forcelimited, model::jnt_actfrclimited])
    }),
    (PlanFlag::SolverDetails, |s| s.reads_field(data::efc_b) || s.reads_field(data::efc_state)),
    (PlanFlag::BodyForces, |s| s.body_forces()),
    (PlanFlag::AppliedForces, |s| s.has_applied_forces()),
    (PlanFlag::PairsChange, |s| s.pairs_change),
    (PlanFlag::ContactParamsChange, |s| s.changes().params),
    (PlanFlag::PlacesChange, |s| s.changes().places),
];

/// Which inputs of the selection of geom pairs may change, according to a plan.
pub fn changes(plan: &PlanTable) -> collision::Changes {
    collision::Changes {
        bits: plan.has(PlanFlag::PairsChange),
        params: plan.has(PlanFlag::ContactParamsChange),
        places: plan.has(PlanFlag::PlacesChange),
    }
}

/// Facts about a scene that are known before it runs.
pub(super) struct ModelAnalysis<'a> {
    pub(super) m: &'a Model,
    pub(super) access: &'a AccessSet,
    /// The allowed tree algorithms.
    pub(super) algorithms: TreeAlgorithms,
    /// M of some tree depends on the configuration.
    pub(super) general: bool,
    /// M and the bias force of some tree are computed by the general algorithm.
    pub(super) large: bool,
    /// The set of pairs of geoms that may touch can change during a run.
    pub(super) pairs_change: bool,
    /// Number of pairs of geoms that may touch.
    pub(super) pairs: usize,
    /// Number of joints and tendons with limits, or of all if limits may be switched during a run.
    pub(super) limited: usize,
    pub(super) limited_tendons: usize,
    /// Number of degrees of freedom and tendons with dry friction, or of all if friction may be changed during a run.
    pub(super) friction: usize,
    pub(super) equalities: usize,
    /// Springs and dampers of joints, springs of tendons, dampers of tendons.
    pub(super) joint_forces: bool,
    pub(super) tendon_springs: bool,
    pub(super) tendon_dampers: bool,
    pub(super) gravcomp: bool,
    /// Contacts may be adhesive.
    pub(super) adhesion: bool,
    /// Fluid forces may act.
    pub(super) fluid: bool,
    pub(super) tendon_armature: bool,
    pub(super) actuated: bool,
    /// There are actuators, and the force of all of them is zero.
    pub(super) idle: bool,
    pub(super) sensors: bool,
    /// Sensors are evaluated even if nothing reads them: those with buffers, which are part of the state, and those of energies,
    /// whose results are also in `energy`.
    pub(super) every_sensor: bool,
    pub(super) energy: bool,
    /// Trees may sleep.
    pub(super) sleeps: bool,
}

impl<'a> ModelAnalysis<'a> {
    pub(super) fn new(m: &'a Model, access: &'a AccessSet, algorithms: TreeAlgorithms) -> ModelAnalysis<'a> {
        let mut analysis = ModelAnalysis {
            m,
            access,
            algorithms,
            general: !tree_algorithms::are_constant(m, algorithms),
            large: tree_algorithms::need_composite_bodies(m, algorithms),
            pairs_change: false,
            pairs: 0,
            limited: 0,
            limited_tendons: 0,
            friction: 0,
            equalities: 0,
            joint_forces: false,
            tendon_springs: false,
            tendon_dampers: false,
            gravcomp: false,
            adhesion: false,
            fluid: false,
            tendon_armature: false,
            actuated: false,
            idle: false,
            sensors: false,
            every_sensor: m.nhistory > 0 || sensor::measures_energy(m),
            energy: false,
            sleeps: false,
        };
        analysis.sleeps = m.ntree > 0 && analysis.may_enable(enable::SLEEP);
        analysis.energy = analysis.may_enable(enable::ENERGY);
        analysis.find_constraints();
        analysis.find_forces();
        analysis.find_actuation();
        // The armature of a tendon also adds to M of simple bodies.
        analysis.general |= analysis.tendon_armature;
        analysis.sensors = m.nsensor > 0
            && (analysis.reads(Stage::Sensors).is_some()
                || m.nhistory > 0 && analysis.reads_field(data::history));
        analysis
    }

    /// Whether an optional part of a step is enabled, or programs may enable it.
    fn may_enable(&self, bit: i32) -> bool {
        self.m.opt.enabled(bit) || self.writes(&[option::enableflags])
    }

    /// Counts the pairs that can touch, the limits, dry friction and equality constraints.
    fn find_constraints(&mut self) {
        let m = self.m;
        self.pairs_change = self.writes(&[
            model::geom_contype,
            model::geom_conaffinity,
            model::body_contype,
            model::body_conaffinity,
            option::disableflags,
        ]);
        // A part that a flag disables counts only if programs may clear the flag.
        let may_act = |bit: i32| {
            self.writes(&[option::disableflags])
                || !(m.opt.disabled(disable::CONSTRAINT) || m.opt.disabled(bit))
        };
        let [contacts, limits, friction, equalities] =
            [disable::CONTACT, disable::LIMIT, disable::FRICTIONLOSS, disable::EQUALITY].map(may_act);
        if contacts {
            self.pairs = collision::candidate_pairs(m, self.changes()).len();
        }
        if limits {
            self.limited = self.limits(model::jnt_limited, &m.jnt_limited);
            self.limited_tendons = self.limits(model::tendon_limited, &m.tendon_limited);
        }
        if friction {
            self.friction = FRICTION_LOSS.iter().map(|f| self.count_nonzero(f)).sum();
        }
        let stay_off = !self.may_differ(data::eq_active)
            && !self.writes(&idle::EQUALITIES)
            && !m.eq_active0.contains(&true);
        if equalities && !stay_off {
            self.equalities = m.neq;
        }
    }

    /// The number of active limits, or of all if programs may change them.
    fn limits(&self, field: FieldId, limited: &[bool]) -> usize {
        match self.writes(&[field]) {
            true => limited.len(),
            false => limited.iter().filter(|&&l| l).count(),
        }
    }

    /// Whether an input may differ from its value after a reset.
    fn may_differ(&self, input: FieldId) -> bool {
        self.sleeps || self.writes(&[input])
    }

    /// Finds the passive forces and the armature.
    fn find_forces(&mut self) {
        let m = self.m;
        self.fluid = m.opt.density > 0.0
            || m.opt.viscosity > 0.0
            || self.writes(&[option::density, option::viscosity]);
        self.gravcomp = self.has_nonzero(&[GRAVCOMP]);
        self.adhesion = self.pairs > 0 && self.has_nonzero(&ADHESION);
        let damping = self.has_nonzero(&ACTUATOR_DAMPING);
        let on_joints = self.transmits(&[trntype::JOINT, trntype::JOINTINPARENT]);
        let on_tendons = self.transmits(&[trntype::TENDON]);
        self.joint_forces = self.has_nonzero(&JOINT_FORCES) || on_joints && damping;
        self.tendon_springs = self.has_nonzero(&TENDON_FORCES[..2]);
        self.tendon_dampers = self.has_nonzero(&TENDON_FORCES[2..]) || on_tendons && damping;
        self.tendon_armature =
            self.has_nonzero(&[TENDON_ARMATURE]) || on_tendons && self.has_nonzero(&[ACTUATOR_ARMATURE]);
    }

    /// Finds whether actuators make forces, or would make them if they had a control.
    fn find_actuation(&mut self) {
        let m = self.m;
        let on = !m.opt.disabled(disable::ACTUATION) || self.writes(&[option::disableflags]);
        let any = m.nactuator > 0 && on;
        self.idle = any
            && !(self.may_differ(data::ctrl) || self.writes(&idle::ACTUATORS))
            && idle::actuators_are_idle(m, |i| self.is_servo(i));
        self.actuated = any && !self.idle;
    }

    /// Which inputs of the selection of geom pairs may change.
    fn changes(&self) -> collision::Changes {
        collision::Changes {
            bits: self.pairs_change,
            params: self.writes(&CONTACT_PARAMS) || self.writes(&OVERRIDES),
            places: self.writes(&collision::PLACES),
        }
    }

    /// Whether at least one of these numbers is not zero, or may become so.
    pub(super) fn has_nonzero(&self, groups: &[Numbers]) -> bool {
        groups.iter().any(|numbers| self.count_nonzero(numbers) > 0)
    }

    /// The number of these numbers that are not zero, or may become so.
    pub(super) fn count_nonzero(&self, (field, numbers): &Numbers) -> usize {
        let numbers = numbers(self.m);
        if self.writes(&[*field]) {
            return numbers.len();
        }
        numbers.iter().filter(|&&x| x != 0.0).count()
    }

    /// Whether joints have dampers, or `None` if programs may change that.
    pub(super) fn damped(&self) -> Option<bool> {
        let joint_forces = [JOINT_FORCES[0].0, JOINT_FORCES[1].0];
        let actuators = ACTUATOR_DAMPING.map(|f| f.0);
        let changes = self.writes(&joint_forces)
            || self.writes(&actuators)
            || self.writes(&[ACTUATOR_ARMATURE.0])
            || self.writes(&[option::disableflags]);
        (!changes).then(|| damping::has_dampers(self.m))
    }

    /// Whether the inertias of bodies are used: by trees with the general algorithm, by derivatives of the bias force, or by
    /// forces between bodies.
    pub(super) fn needs_body_inertias(&self, plan: &PlanTable) -> bool {
        let m = self.m;
        let explicit = m.opt.integrator == integrator::EULER || integrator::many_stages(m.opt.integrator);
        self.large
            || !explicit
            || self.writes(&[option::integrator])
            || plan.keeps(Stage::RnePost)
            || [data::cinert, data::crb].into_iter().any(|f| self.reads_field(f))
    }

    /// Whether only constraints use M: the tree algorithms and the integrator do not need its general rows.
    pub(super) fn mass_for_rows(&self, plan: &PlanTable) -> bool {
        let m = self.m;
        let fields = [data::M, data::qLD, data::qLDiagInv, data::crb];
        let integrates = m.opt.integrator == integrator::EULER || integrator::many_stages(m.opt.integrator);
        let changes = [option::integrator, option::enableflags];
        self.general
            && integrates
            && !self.writes(&changes)
            && !m.opt.enabled(enable::DIAGEXACT)
            && !self.tendon_armature
            && !self.sleeps
            && !plan.keeps(Stage::Energy)
            && !(plan.keeps(Stage::Sensors) && self.is_used_by_sensors(Stage::MassMatrix))
            && !fields.into_iter().any(|f| self.reads_field(f))
            && tree_algorithms::solve_without_mass_rows(m, self.algorithms)
    }

    /// Whether forces of actuators depend on their lengths or velocities, or their moments on the configuration.
    pub(super) fn lengths_act(&self) -> bool {
        let m = self.m;
        let dynamics = |i: usize| {
            let without = [dyntype::NONE, dyntype::INTEGRATOR, dyntype::FILTER, dyntype::FILTEREXACT];
            without.contains(&m.actuator_dyntype[i])
        };
        self.sleeps
            || self.writes(&[model::actuator_gear])
            || !(0..m.nactuator).all(|i| self.is_motor(i) && dynamics(i))
    }

    /// Whether an actuator acts on a slide or a hinge, with a force that is proportional to its input.
    pub(super) fn is_motor(&self, i: usize) -> bool {
        self.is_servo(i)
            && self.m.actuator_trntype[i] != trntype::TENDON
            && self.m.actuator_biastype[i] == biastype::NONE
    }

    /// Whether an actuator acts on a slide, a hinge or a tendon, with a force that is linear in its input, its length and its
    /// velocity.
    pub(super) fn is_servo(&self, i: usize) -> bool {
        let m = self.m;
        let joint = usize::try_from(m.actuator_trnid[2 * i]).ok().filter(|&j| j < m.njnt);
        let on = match m.actuator_trntype[i] {
            trntype::JOINT | trntype::JOINTINPARENT => {
                joint.is_some_and(|j| matches!(m.jnt_type[j], joint::SLIDE | joint::HINGE))
            }
            kind => kind == trntype::TENDON,
        };
        on && m.actuator_gaintype[i] == gaintype::FIXED
            && matches!(m.actuator_biastype[i], biastype::NONE | biastype::AFFINE)
    }

    /// Whether all actuators are of a kind, have one control each, and can never be disabled.
    pub(super) fn actuators_are(&self, of_kind: fn(&ModelAnalysis<'a>, usize) -> bool) -> bool {
        let m = self.m;
        let plain = |i: usize| {
            of_kind(self, i)
                && m.actuator_dyntype[i] == dyntype::NONE
                && m.actuator_ctrlnum[i] == 1
                && !actuation::switched_off(m, i)
        };
        let switched = self.writes(&[option::disableactuator])
            || self.writes(&[model::actuator_group, model::actuator_gear]);
        !self.sleeps && !switched && m.nhistory == 0 && m.nout == m.nactuator && (0..m.nactuator).all(plain)
    }

    /// Whether the derivatives of forces with respect to velocities are constants of the model, except for those of actuator
    /// forces. This requires linear dampers and servos, along joints and fixed tendons.
    pub(super) fn has_constant_velocity_derivatives(&self) -> bool {
        let growth = [JOINT_FORCES[1], TENDON_FORCES[3], ACTUATOR_DAMPING[1]];
        let numbers = [model::wrap_prm, TENDON_FORCES[2].0];
        !self.sleeps
            && !self.fluid
            && self.damped().is_some()
            && !self.has_nonzero(&growth)
            && !self.writes(&numbers)
            && (self.m.nactuator == 0 || self.actuators_are(ModelAnalysis::is_servo))
            && (0..self.m.ntendon).all(|t| tendon::is_fixed(self.m, t))
    }

    /// Whether some sensor that is evaluated uses the results of a stage.
    pub(super) fn is_used_by_sensors(&self, stage: Stage) -> bool {
        let read =
            |s: usize| self.every_sensor || sensor::is_read(self.m, s, self.access.reads.sensed_elements());
        sensor::needs_of(self.m, stage, read)
    }

    /// Whether fluid forces act on individual geoms.
    pub(super) fn ellipsoids(&self) -> bool {
        self.has_nonzero(&[ELLIPSOIDS])
    }

    /// Whether forces are applied to bodies or along degrees of freedom.
    pub(super) fn applies_forces(&self) -> bool {
        self.writes(&[data::xfrc_applied, data::qfrc_applied])
    }

    /// Whether forces are applied to bodies.
    pub(super) fn has_applied_forces(&self) -> bool {
        self.writes(&[data::xfrc_applied])
    }

    /// Whether gravity compensation or fluid forces act on bodies.
    pub(super) fn body_forces(&self) -> bool {
        self.gravcomp || self.fluid
    }

    /// Whether there are constraints between frames of bodies.
    pub(super) fn welds_bodies(&self) -> bool {
        self.equalities > 0 && self.m.eq_type.contains(&eqtype::WELD)
    }

    /// Whether there are constraints between points or frames of bodies.
    pub(super) fn constrains_bodies(&self) -> bool {
        self.equalities > 0 && self.m.eq_type.iter().any(|&t| t == eqtype::CONNECT || t == eqtype::WELD)
    }

    /// Whether there are constraints on the lengths of tendons.
    pub(super) fn tendon_constraints(&self) -> bool {
        let m = self.m;
        self.limited_tendons > 0
            || self.equalities > 0 && m.eq_type.contains(&eqtype::TENDON)
            || self.has_nonzero(&[(model::tendon_frictionloss, |m| &m.tendon_frictionloss)])
    }

    /// Whether there are forces along tendons.
    pub(super) fn tendon_forces(&self) -> bool {
        self.tendon_springs || self.tendon_dampers
    }

    /// Whether the options select an integrator, or programs may select it.
    pub(super) fn may_integrate_by(&self, kind: i32) -> bool {
        self.m.opt.integrator == kind || self.writes(&[option::integrator])
    }

    /// Whether an integrator needs the derivative of the bias force with respect to velocities, which is computed from composite
    /// bodies.
    pub(super) fn bias_slopes(&self) -> bool {
        let bodies = |&t: &usize| {
            derivative::is_free_rigid(self.m, t)
                && !tree_algorithms::bias_is_free_torque(self.m, self.algorithms, t)
        };
        let free = || (0..self.m.ntree).any(|t| bodies(&t));
        let of_free = [integrator::IMPLICITFAST, integrator::DISCRETE];
        self.may_integrate_by(integrator::IMPLICIT)
            || of_free.into_iter().any(|kind| self.may_integrate_by(kind)) && free()
    }

    /// A reason that names the first field of a stage that is read.
    pub(super) fn reads(&self, stage: Stage) -> Option<String> {
        if self.access.reads == FieldSet::ALL {
            return Some("its results may be read".into());
        }
        let of_stage = |f: &FieldId| f.info().object == Object::Data && f.info().stage == stage;
        self.access.reads.iter().find(of_stage).map(|f| format!("data.{} is read", f.info().name))
    }

    pub(super) fn reads_field(&self, field: FieldId) -> bool {
        self.access.reads.contains(field)
    }

    pub(super) fn writes(&self, fields: &[FieldId]) -> bool {
        fields.iter().any(|f| self.access.writes.contains(*f))
    }

    /// Whether an actuator acts through one of these transmissions.
    pub(super) fn transmits(&self, kinds: &[i32]) -> bool {
        self.m.actuator_trntype.iter().any(|t| kinds.contains(t))
    }
}
