//! The fields of the model whose values determine which stages a plan keeps.

use super::access::AccessSet;
use crate::collision;
use crate::dynamics::tree_algorithms;
use crate::model::Model;
use crate::model::reflect::{FieldId, FieldSet, model, option};
use crate::step::idle;

/// The fields from which the parameters of a contact are computed.
pub(super) const CONTACT_PARAMS: [FieldId; 18] = [
    model::geom_rbound,
    model::geom_condim,
    model::geom_priority,
    model::geom_solmix,
    model::geom_solref,
    model::geom_solimp,
    model::geom_friction,
    model::geom_margin,
    model::geom_gap,
    model::geom_adhesion,
    model::pair_dim,
    model::pair_friction,
    model::pair_solref,
    model::pair_solreffriction,
    model::pair_solimp,
    model::pair_margin,
    model::pair_gap,
    model::pair_adhesion,
];
/// A field, and its numbers.
pub(super) type Numbers = (FieldId, fn(&Model) -> &[f64]);
/// The parameters of passive joint forces.
pub(super) const JOINT_FORCES: [Numbers; 4] = [
    (model::dof_damping, |m| &m.dof_damping),
    (model::dof_dampingpoly, |m| &m.dof_dampingpoly),
    (model::jnt_stiffness, |m| &m.jnt_stiffness),
    (model::jnt_stiffnesspoly, |m| &m.jnt_stiffnesspoly),
];
/// The parameters of passive tendon forces, springs first.
pub(super) const TENDON_FORCES: [Numbers; 4] = [
    (model::tendon_stiffness, |m| &m.tendon_stiffness),
    (model::tendon_stiffnesspoly, |m| &m.tendon_stiffnesspoly),
    (model::tendon_damping, |m| &m.tendon_damping),
    (model::tendon_dampingpoly, |m| &m.tendon_dampingpoly),
];
/// Damping of actuators, which acts on joints and tendons.
pub(super) const ACTUATOR_DAMPING: [Numbers; 2] = [
    (model::actuator_damping, |m| &m.actuator_damping),
    (model::actuator_dampingpoly, |m| &m.actuator_dampingpoly),
];
/// Dry friction.
pub(super) const FRICTION_LOSS: [Numbers; 2] = [
    (model::dof_frictionloss, |m| &m.dof_frictionloss),
    (model::tendon_frictionloss, |m| &m.tendon_frictionloss),
];
pub(super) const ACTUATOR_ARMATURE: Numbers = (model::actuator_armature, |m| &m.actuator_armature);
pub(super) const TENDON_ARMATURE: Numbers = (model::tendon_armature, |m| &m.tendon_armature);
/// The fluid coefficients of individual geoms.
pub(super) const ELLIPSOIDS: Numbers = (model::geom_fluid, |m| &m.geom_fluid);
/// Adhesion of contacts, and velocities of surfaces.
pub(super) const ADHESION: [Numbers; 2] =
    [(model::geom_adhesion, |m| &m.geom_adhesion), (model::pair_adhesion, |m| &m.pair_adhesion)];
pub(super) const SURFACES: Numbers = (model::geom_surfacevel, |m| &m.geom_surfacevel);
pub(super) const GRAVCOMP: Numbers = (model::body_gravcomp, |m| &m.body_gravcomp);
pub(super) const OVERRIDES: [FieldId; 5] =
    [option::o_margin, option::o_solref, option::o_solimp, option::o_friction, option::enableflags];

/// Other fields: limits, options and contact bits.
pub(super) const OTHERS: [FieldId; 12] = [
    model::geom_contype,
    model::geom_conaffinity,
    model::body_contype,
    model::body_conaffinity,
    model::jnt_limited,
    model::tendon_limited,
    model::actuator_group,
    option::density,
    option::viscosity,
    option::integrator,
    option::disableflags,
    option::disableactuator,
];

/// The results of `mj_setConst` on which plans depend: the actuators whose damping and armature act on joints and tendons, and
/// the frames of geoms.
pub fn constants(m: &Model) -> [&[i32]; 4] {
    [&m.jnt_actuatorid, &m.tendon_actuatorid, &m.geom_sameframe, &m.body_sameframe]
}

/// The fields of the model whose values determine which stages a plan keeps. If programs write one of them, a plan is made for
/// its current value, or for any value: see `api/assumed`. The values of all other fields are not used.
pub fn deciding() -> FieldSet {
    let mut set = FieldSet::EMPTY;
    let numbers = [
        &JOINT_FORCES[..],
        &TENDON_FORCES,
        &ACTUATOR_DAMPING,
        &FRICTION_LOSS,
        &ADHESION,
        &[ACTUATOR_ARMATURE, TENDON_ARMATURE, ELLIPSOIDS, SURFACES, GRAVCOMP],
    ];
    numbers.into_iter().flatten().for_each(|(field, _)| set.insert(*field));
    [&OTHERS[..], &CONTACT_PARAMS, &OVERRIDES, &collision::PLACES, &idle::ACTUATORS, &idle::EQUALITIES]
        .into_iter()
        .flatten()
        .for_each(|field| set.insert(*field));
    tree_algorithms::copied().for_each(|field| set.insert(field));
    set
}

/// The written fields that determine nothing. A plan never uses their values.
pub fn undecisive_writes(access: &AccessSet) -> FieldSet {
    access.writes.difference(&deciding())
}
