//! Tendons to the arrays of [`Model`].

use crate::forces::tendon;
use crate::kinds::{trntype, wraptype};
use crate::mjcf::arrays::{flat, ints, padded};
use crate::mjcf::gather::listed;
use crate::mjcf::rules;
use crate::mjcf::spec::{ActuatorSpec, BodySpec, TendonSpec};
use crate::mjcf::text::diagnostic::Report;
use crate::model::Model;

/// More entries than this in the Jacobians of all tendons are refused.
const MAX_JACOBIAN: usize = 10_000_000;

/// Sizes.
pub(crate) fn count(m: &mut Model, list: &[TendonSpec]) {
    m.ntendon = list.len();
    m.nwrap = list.iter().map(|t| t.path.len()).sum();
}

/// Bodies that a spatial tendon with inertia touches do not have a diagonal mass matrix.
pub(crate) fn demote_simple(
    simple: &mut [i32],
    bodies: &[BodySpec],
    list: &[TendonSpec],
    actuators: &[ActuatorSpec],
) {
    let site_body: Vec<usize> =
        listed(bodies.iter().enumerate().flat_map(|(i, b)| b.sites.iter().map(move |_| i)));
    let rotors: Vec<i32> = actuators
        .iter()
        .filter_map(|a| a.transmission.filter(|t| a.armature != 0.0 && t.kind == trntype::TENDON))
        .map(|t| t.id[0])
        .collect();
    let heavy = |&(t, spec): &(usize, &TendonSpec)| spec.armature > 0.0 || rotors.contains(&(t as i32));
    let sites = list.iter().enumerate().filter(heavy).flat_map(|(_, t)| &t.path);
    for site in sites.filter(|w| w.kind == wraptype::SITE) {
        let body = usize::try_from(site.id).ok().and_then(|s| site_body.get(s));
        if let Some(s) = body.and_then(|&b| simple.get_mut(b)) {
            *s = 0;
        }
    }
}

/// All fields of tendons and of the objects on their paths.
pub(crate) fn tendons(m: &mut Model, list: &[TendonSpec]) {
    let mut next = 0;
    m.tendon_adr = ints(list, |t| {
        next += t.path.len() as i32;
        next - t.path.len() as i32
    });
    m.tendon_num = ints(list, |t| t.path.len() as i32);
    m.tendon_matid = vec![-1; list.len()];
    m.tendon_actuatorid = vec![-1; list.len()];
    m.tendon_group = ints(list, |t| t.group);
    m.tendon_limited = listed(list.iter().map(|t| t.limited));
    m.tendon_actfrclimited = listed(list.iter().map(|t| t.actfrclimited));
    m.tendon_width = flat(list, |t| [t.width]);
    m.tendon_solref_lim = flat(list, |t| t.solref_limit);
    m.tendon_solimp_lim = flat(list, |t| t.solimp_limit);
    m.tendon_solref_fri = flat(list, |t| t.solref_friction);
    m.tendon_solimp_fri = flat(list, |t| t.solimp_friction);
    m.tendon_range = flat(list, |t| t.range);
    m.tendon_actfrcrange = flat(list, |t| t.actfrcrange);
    m.tendon_margin = flat(list, |t| [t.margin]);
    m.tendon_stiffness = flat(list, |t| [t.stiffness[0]]);
    m.tendon_stiffnesspoly = flat(list, |t| [t.stiffness[1], t.stiffness[2]]);
    m.tendon_damping = flat(list, |t| [t.damping[0]]);
    m.tendon_dampingpoly = flat(list, |t| [t.damping[1], t.damping[2]]);
    m.tendon_armature = flat(list, |t| [t.armature]);
    m.tendon_frictionloss = flat(list, |t| [t.frictionloss]);
    m.tendon_lengthspring = flat(list, |t| t.springlength);
    m.tendon_rgba = flat(list, |t| t.rgba);
    m.tendon_user = padded(list.iter().map(|t| &t.user), m.nuser_tendon);

    let wraps = || list.iter().flat_map(|t| &t.path);
    m.wrap_type = ints(wraps(), |w| w.kind);
    m.wrap_objid = ints(wraps(), |w| w.id);
    m.wrap_prm = flat(wraps(), |w| [w.prm]);
}

/// The pattern of the Jacobians; `None` after reporting that it is too large.
pub(crate) fn pattern(m: &mut Model, list: &[TendonSpec], report: &mut Report) -> Option<()> {
    let span = list.first().map_or(0..0, |t| t.span.clone());
    if tendon::set_pattern(m, MAX_JACOBIAN).is_some() {
        return report.take(2 * m.nJten, span, "the Jacobians of all tendons").then_some(());
    }
    let message = format!("the Jacobians of all tendons have more than {MAX_JACOBIAN} entries");
    report.error(rules::LIMIT, span, message).help("leave out what the lesson does not need");
    None
}
