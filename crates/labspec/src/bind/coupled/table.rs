//! The pairs: a parameter, the partner that depends on it, and the dependency.

use super::change::Changes;
use super::statements::StatementWriter;
use super::{bits, follow, repair};
use crate::rules::{self, Rule};
use labspec_core::Model;
use labspec_core::reflect::{FieldId, model, option};
use std::ops::Range;

/// Writes the statements that change the partner of these objects; `None` where that is impossible.
type Repair = fn(&mut StatementWriter<'_>, &[usize]) -> Option<()>;

/// A parameter of a model, and the partner that must change with it.
#[derive(Debug)]
pub(crate) struct CoupledPair {
    /// The field of the parameter.
    pub(crate) parameter: FieldId,
    /// The field of the partner.
    pub(crate) partner: FieldId,
    /// The rule that a change of the parameter alone violates.
    pub(crate) rule: &'static Rule,
    /// The partner in a message about its omission.
    pub(crate) left: &'static str,
    /// The corrected partner in a message, after "with".
    pub(crate) corrected: &'static str,
    /// The help, where no statements were tested.
    pub(crate) help: &'static str,
    /// The changes of the partner that follow from the model before and after a program. A partner that the program itself
    /// changed is kept.
    pub(super) follow: fn(&Model, &Model) -> Changes,
    /// The elements of the partner that belong to an element of the parameter.
    pub(super) partners: fn(usize) -> Range<usize>,
    /// The correction as statements; `None` where it has none.
    pub(super) repair: Option<Repair>,
}

/// All pairs.
pub(crate) const PAIRS: &[CoupledPair] = &[
    CoupledPair {
        parameter: model::body_mass,
        partner: model::body_inertia,
        left: "`model.body_inertia`",
        rule: rules::MASS_ALONE,
        corrected: "the inertia that this mass has",
        help: "multiply all three numbers of `model.body_inertia` by the factor of the mass, then call `mj.mj_setConst(model, data)`",
        follow: follow::inertia_of_mass,
        partners: |b| 3 * b..3 * b + 3,
        repair: Some(repair::inertia_of_mass),
    },
    CoupledPair {
        parameter: model::body_inertia,
        partner: model::body_mass,
        left: "`model.body_mass`",
        rule: rules::INERTIA_ALONE,
        corrected: "the mass that this inertia needs",
        help: "change `model.body_mass` by the same factor, or keep the inertia below the mass times the square of the body's reach",
        follow: follow::mass_of_inertia,
        partners: |i| i / 3..i / 3 + 1,
        repair: None,
    },
    CoupledPair {
        parameter: model::body_inertia,
        partner: model::body_inertia,
        left: "the other principal moments",
        rule: rules::INERTIA_ALONE,
        corrected: "all three principal moments scaled together",
        help: "change all three numbers of `model.body_inertia` together: none can exceed the sum of the other two",
        follow: follow::other_moments,
        partners: |_| 0..0,
        repair: None,
    },
    CoupledPair {
        parameter: model::geom_size,
        partner: model::geom_rbound,
        left: "`model.geom_rbound`",
        rule: rules::SHAPE_ALONE,
        corrected: "the bounding radius of this size",
        help: "set `model.geom_rbound` to the bounding radius of the new size",
        follow: follow::bound_of_size,
        partners: |i| i / 3..i / 3 + 1,
        repair: Some(repair::bound_of_size),
    },
    CoupledPair {
        parameter: model::geom_size,
        partner: model::body_inertia,
        left: "`model.body_inertia`",
        rule: rules::SHAPE_ALONE,
        corrected: "the inertia of this shape",
        help: "set `model.body_inertia` to the inertia of the new shape, then call `mj.mj_setConst(model, data)`",
        follow: follow::inertia_of_size,
        partners: |_| 0..0,
        repair: Some(repair::inertia_of_size),
    },
    CoupledPair {
        parameter: model::geom_pos,
        partner: model::body_ipos,
        left: "`model.body_ipos`",
        rule: rules::SHAPE_ALONE,
        corrected: "the centre of mass where the geom is",
        help: "move `model.body_ipos` as far as `model.geom_pos`, then call `mj.mj_setConst(model, data)`",
        follow: follow::centre_of_place,
        partners: |_| 0..0,
        repair: Some(repair::centre_of_place),
    },
    CoupledPair {
        parameter: model::actuator_gainprm,
        partner: model::actuator_biasprm,
        left: "`model.actuator_biasprm`",
        rule: rules::GAIN_ALONE,
        corrected: "the bias of this gain",
        help: "also set the number of `model.actuator_biasprm` that is minus the gain",
        follow: follow::bias_of_gain,
        partners: |i| i + 1..i + 3,
        repair: Some(repair::bias_of_gain),
    },
    CoupledPair {
        parameter: model::actuator_biasprm,
        partner: model::actuator_gainprm,
        left: "`model.actuator_gainprm`",
        rule: rules::GAIN_ALONE,
        corrected: "the gain of this bias",
        help: "also set `model.actuator_gainprm[10 * actuator]` to minus the bias",
        follow: follow::gain_of_bias,
        partners: |i| i / 10 * 10..i / 10 * 10 + 1,
        repair: Some(repair::gain_of_bias),
    },
    CoupledPair {
        parameter: model::geom_contype,
        partner: model::body_contype,
        left: "`model.body_contype`",
        rule: rules::CONTYPE_ALONE,
        corrected: "the contact types of its geoms in the body",
        help: "also set the bits of `model.body_contype`",
        follow: bits::types_of_bodies,
        partners: |_| 0..0,
        repair: Some(bits::repair_types),
    },
    CoupledPair {
        parameter: model::geom_conaffinity,
        partner: model::body_conaffinity,
        left: "`model.body_conaffinity`",
        rule: rules::CONTYPE_ALONE,
        corrected: "the contact affinities of its geoms in the body",
        help: "also set the bits of `model.body_conaffinity`",
        follow: bits::affinities_of_bodies,
        partners: |_| 0..0,
        repair: Some(bits::repair_affinities),
    },
    MIDPHASE,
    CoupledPair { parameter: model::geom_conaffinity, ..MIDPHASE },
];

/// A geom whose contact bits are set although it is missing in the tree of bounding volumes of its body.
const MIDPHASE: CoupledPair = CoupledPair {
    parameter: model::geom_contype,
    partner: option::disableflags,
    left: "the bounding volumes of its body",
    rule: rules::CONTYPE_ALONE,
    corrected: "the midphase switched off",
    help: "set the contact bits of the geom in the model and switch it off in the setup, or switch the midphase off",
    follow: bits::midphase,
    partners: |_| 0..0,
    repair: Some(bits::repair_midphase),
};
