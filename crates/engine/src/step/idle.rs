//! Detects unused elements of a scene: actuators whose controls are zero, and equality constraints that are inactive.
//!
//! Both depend on inputs of the data. If no program writes these inputs, a plan assumes their values after a reset. Data with
//! other values get a new plan (`api/data`).

use crate::forces::tendon;
use crate::kinds::{biastype, dyntype, trntype};
use crate::math::rows;
use crate::model::Model;
use crate::model::reflect::{FieldId, model};

/// The fields that determine the force of an actuator whose control is zero.
pub(super) const ACTUATORS: [FieldId; 12] = [
    model::actuator_gainprm,
    model::actuator_gear,
    model::actuator_ctrllimited,
    model::actuator_ctrlrange,
    model::actuator_forcelimited,
    model::actuator_forcerange,
    model::jnt_actfrclimited,
    model::jnt_actfrcrange,
    model::jnt_actgravcomp,
    model::tendon_actfrclimited,
    model::tendon_actfrcrange,
    model::wrap_prm,
];
/// The field that determines whether equality constraints are active after a reset.
pub(super) const EQUALITIES: [FieldId; 1] = [model::eq_active0];

/// Whether zero is within each of these ranges that is active.
fn ranges_contain_zero(limited: &[bool], ranges: &[f64]) -> bool {
    limited
        .iter()
        .zip(rows::<2>(ranges))
        .all(|(limited, range)| !limited || range[0] <= 0.0 && range[1] >= 0.0)
}

/// Whether the forces of all actuators are zero in every state, given that their controls are zero and stay so. `linear`
/// returns whether the force of an actuator is linear in its control, its length and its velocity.
pub(super) fn actuators_are_idle(m: &Model, linear: impl Fn(usize) -> bool) -> bool {
    let makes_none = |i: usize| {
        let fixed = |t: i32| usize::try_from(t).is_ok_and(|t| t < m.ntendon && tendon::is_fixed(m, t));
        let numbers = [m.actuator_gainprm[10 * i], m.actuator_gear[6 * i]];
        // The moment of a joint is its gear, and that of a fixed tendon consists of its coefficients. Both are independent of the
        // state.
        linear(i)
            && m.actuator_biastype[i] == biastype::NONE
            && m.actuator_dyntype[i] == dyntype::NONE
            && (m.actuator_trntype[i] != trntype::TENDON || fixed(m.actuator_trnid[2 * i]))
            && numbers.iter().all(|x| x.is_finite())
    };
    (m.nhistory, m.nout) == (0, m.nactuator)
        && !m.jnt_actgravcomp.contains(&true)
        && m.wrap_prm.iter().all(|x| x.is_finite())
        && ranges_contain_zero(&m.actuator_ctrllimited, &m.actuator_ctrlrange)
        && ranges_contain_zero(&m.actuator_forcelimited, &m.actuator_forcerange)
        && ranges_contain_zero(&m.jnt_actfrclimited, &m.jnt_actfrcrange)
        && (0..m.nactuator).all(makes_none)
}
