//! Writes tendons to the arrays of [`Model`].

use crate::forces::tendon;
use crate::kinds::wraptype;
use crate::mjcf::arrays::{flat, padded};
use crate::mjcf::gather::listed;
use crate::mjcf::rules;
use crate::mjcf::spec::{BodySpec, TendonSpec};
use crate::mjcf::text::diagnostic::Diagnostics;
use crate::model::Model;

/// Limit for the entries of the Jacobians of all tendons.
const MAX_JACOBIAN: usize = 10_000_000;

/// Sets the sizes of the model for tendons.
pub(crate) fn count(m: &mut Model, list: &[TendonSpec]) {
    m.ntendon = list.len();
    m.nwrap = list.iter().map(|t| t.path.len()).sum();
}

/// Clears the flag `simple` of bodies whose mass matrix is not diagonal because of a tendon. A spatial tendon with armature
/// couples the degrees of freedom of the bodies that it is attached to. The armature that an actuator adds to a tendon does not
/// clear the flag, as in MuJoCo: for a simple body, M contains only the diagonal of that term.
pub(crate) fn clear_simple_flags(simple: &mut [i32], bodies: &[BodySpec], list: &[TendonSpec]) {
    let site_body: Vec<usize> =
        listed(bodies.iter().enumerate().flat_map(|(i, b)| b.sites.iter().map(move |_| i)));
    let sites = list.iter().filter(|t| t.armature > 0.0).flat_map(|t| &t.path);
    for site in sites.filter(|w| w.kind == wraptype::SITE) {
        let body = usize::try_from(site.id).ok().and_then(|s| site_body.get(s));
        if let Some(s) = body.and_then(|&b| simple.get_mut(b)) {
            *s = 0;
        }
    }
}

/// Fills all fields of tendons and of the objects on their paths.
pub(crate) fn tendons(m: &mut Model, list: &[TendonSpec]) {
    let mut next = 0;
    flat(&mut m.tendon_adr, list, |t| {
        next += t.path.len() as i32;
        [next - t.path.len() as i32]
    });
    flat(&mut m.tendon_num, list, |t| [t.path.len() as i32]);
    m.tendon_matid = vec![-1; list.len()];
    m.tendon_actuatorid = vec![-1; list.len()];
    flat(&mut m.tendon_group, list, |t| [t.group]);
    flat(&mut m.tendon_limited, list, |t| [t.limited]);
    flat(&mut m.tendon_actfrclimited, list, |t| [t.actfrclimited]);
    flat(&mut m.tendon_width, list, |t| [t.width]);
    flat(&mut m.tendon_solref_lim, list, |t| t.solref_limit);
    flat(&mut m.tendon_solimp_lim, list, |t| t.solimp_limit);
    flat(&mut m.tendon_solref_fri, list, |t| t.solref_friction);
    flat(&mut m.tendon_solimp_fri, list, |t| t.solimp_friction);
    flat(&mut m.tendon_range, list, |t| t.range);
    flat(&mut m.tendon_actfrcrange, list, |t| t.actfrcrange);
    flat(&mut m.tendon_margin, list, |t| [t.margin]);
    flat(&mut m.tendon_stiffness, list, |t| [t.stiffness[0]]);
    flat(&mut m.tendon_stiffnesspoly, list, |t| [t.stiffness[1], t.stiffness[2]]);
    flat(&mut m.tendon_damping, list, |t| [t.damping[0]]);
    flat(&mut m.tendon_dampingpoly, list, |t| [t.damping[1], t.damping[2]]);
    flat(&mut m.tendon_armature, list, |t| [t.armature]);
    flat(&mut m.tendon_frictionloss, list, |t| [t.frictionloss]);
    flat(&mut m.tendon_lengthspring, list, |t| t.springlength);
    flat(&mut m.tendon_rgba, list, |t| t.rgba);
    padded(&mut m.tendon_user, list.iter().map(|t| &t.user), m.nuser_tendon);

    let wraps = || list.iter().flat_map(|t| &t.path);
    flat(&mut m.wrap_type, wraps(), |w| [w.kind]);
    flat(&mut m.wrap_objid, wraps(), |w| [w.id]);
    flat(&mut m.wrap_prm, wraps(), |w| [w.prm]);
}

/// Computes the sparsity pattern of the Jacobians. `None`, with an error in the report, if it is too large.
pub(crate) fn pattern(m: &mut Model, list: &[TendonSpec], report: &mut Diagnostics) -> Option<()> {
    let span = list.first().map_or(0..0, |t| t.span.clone());
    if tendon::set_pattern(m, MAX_JACOBIAN).is_some() {
        return report.take(2 * m.nJten, span, "the Jacobians of all tendons").then_some(());
    }
    let message = format!("the Jacobians of all tendons have more than {MAX_JACOBIAN} entries");
    report.error(rules::LIMIT, span, message).help("remove what the lesson does not need");
    None
}
