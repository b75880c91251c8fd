//! Writes actuators to the arrays of [`Model`].

use super::check_actuator::{controls, outputs};
use crate::forces::{history, transmission};
use crate::kinds::choice;
use crate::mjcf::arrays::{flat, padded};
use crate::mjcf::gather::listed;
use crate::mjcf::rules;
use crate::mjcf::spec::{ActuatorSpec, NumberList, RangeSpec};
use crate::mjcf::text::diagnostic::Diagnostics;
use crate::model::Model;
use crate::setup::lengthrange::{self, RangeError, RangeSearch};
use crate::step::workspace::Workspace;

/// Limit for the product of steps and degrees of freedom in the search for all length ranges. A larger search would take minutes.
const MAX_SEARCH: f64 = 2e7;

/// The sizes of actuators that keyframes depend on.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct ActuatorCounts {
    pub(crate) nu: usize,
    pub(crate) nout: usize,
    pub(crate) na: usize,
    pub(crate) nhistory: usize,
}

/// Counts the sizes of all actuators.
pub(crate) fn count(list: &[ActuatorSpec], report: &mut Diagnostics) -> ActuatorCounts {
    let mut n = ActuatorCounts::default();
    for a in list {
        let nu = controls(a).len();
        n.nu += nu;
        n.nout += outputs(a);
        n.na += activations(a);
        n.nhistory = n.nhistory.saturating_add(history::size(samples(a), nu));
    }
    let span = list.iter().find(|a| a.nsample > 0).map_or(0..0, |a| a.span.clone());
    if !report.take(n.nhistory, span, "the history of all actuators, by their `nsample`,") {
        n.nhistory = 0;
    }
    n
}

fn activations(a: &ActuatorSpec) -> usize {
    usize::try_from(a.actdim).unwrap_or(0)
}

fn samples(a: &ActuatorSpec) -> usize {
    usize::try_from(a.nsample).unwrap_or(0)
}

/// The address of the values of each actuator: -1 if there are none, unless `always` is set.
fn addresses(array: &mut Vec<i32>, list: &[ActuatorSpec], size: fn(&ActuatorSpec) -> usize, always: bool) {
    let mut next = 0;
    flat(array, list, |a| {
        let address = if size(a) == 0 && !always { -1 } else { next as i32 };
        next += size(a);
        [address]
    });
}

/// Fills all fields of actuators.
pub(crate) fn actuators(m: &mut Model, list: &[ActuatorSpec]) {
    flat(&mut m.actuator_trntype, list, |a| [a.transmission.map_or(0, |t| t.kind)]);
    flat(&mut m.actuator_trnid, list, |a| a.transmission.map_or([-1; 2], |t| t.id));
    flat(&mut m.actuator_dyntype, list, |a| [a.dyntype]);
    flat(&mut m.actuator_gaintype, list, |a| [a.gaintype]);
    flat(&mut m.actuator_biastype, list, |a| [a.biastype]);
    flat(&mut m.actuator_ctrlspec, list, |a| [a.ctrlspec]);
    addresses(&mut m.actuator_ctrladr, list, |a| controls(a).len(), true);
    flat(&mut m.actuator_ctrlnum, list, |a| [controls(a).len() as i32]);
    addresses(&mut m.actuator_outadr, list, outputs, true);
    flat(&mut m.actuator_outnum, list, |a| [outputs(a) as i32]);
    addresses(&mut m.actuator_actadr, list, activations, false);
    flat(&mut m.actuator_actnum, list, |a| [a.actdim]);
    addresses(&mut m.actuator_historyadr, list, |a| history::size(samples(a), controls(a).len()), false);
    flat(&mut m.actuator_history, list, |a| [a.nsample, a.interp]);
    flat(&mut m.actuator_delay, list, |a| [a.delay]);
    flat(&mut m.actuator_cranklength, list, |a| [a.cranklength]);
    flat(&mut m.actuator_dynprm, list, |a| a.dynprm);
    flat(&mut m.actuator_gainprm, list, |a| a.gainprm);
    flat(&mut m.actuator_biasprm, list, |a| a.biasprm);
    flat(&mut m.actuator_actlimited, list, |a| [a.act.flag == choice::TRUE]);
    flat(&mut m.actuator_actrange, list, |a| a.act.range);
    flat(&mut m.actuator_actearly, list, |a| [a.actearly]);
    flat(&mut m.actuator_damping, list, |a| [a.damping[0]]);
    flat(&mut m.actuator_dampingpoly, list, |a| [a.damping[1], a.damping[2]]);
    flat(&mut m.actuator_armature, list, |a| [a.armature]);
    flat(&mut m.actuator_group, list, |a| [a.group]);
    flat(&mut m.actuator_forcelimited, list, |a| [a.force.flag == choice::TRUE]);
    flat(&mut m.actuator_forcerange, list, |a| a.force.range);
    let ranges: Vec<RangeSpec> = listed(list.iter().flat_map(controls));
    flat(&mut m.actuator_ctrllimited, &ranges, |r| [r.flag == choice::TRUE]);
    flat(&mut m.actuator_ctrlrange, &ranges, |r| r.range);
    let each_output = || list.iter().flat_map(|a| std::iter::repeat_n(a, outputs(a)));
    flat(&mut m.actuator_gear, each_output(), |a| a.gear);
    flat(&mut m.actuator_lengthrange, each_output(), |a| a.lengthrange);
    let users: Vec<NumberList> = listed(list.iter().map(user));
    padded(&mut m.actuator_user, users.iter(), m.nuser_actuator);
}

/// The user values of an actuator.
pub(crate) fn user(a: &ActuatorSpec) -> NumberList {
    NumberList { numbers: a.user.clone(), span: a.user_span.clone() }
}

/// Computes the number of entries of the moment matrix. `None`, with an error in the report, if it is too large.
pub(crate) fn pattern(m: &mut Model, list: &[ActuatorSpec], report: &mut Diagnostics) -> Option<()> {
    m.nJmom = transmission::entries(m);
    let span = list.first().map_or(0..0, |a| a.span.clone());
    report.take(2 * m.nJmom, span, "the moments of all actuators").then_some(())
}

/// Computes the length ranges of actuators that need one and have none.
pub(crate) fn length_ranges(
    m: &mut Model,
    list: &[ActuatorSpec],
    search: &RangeSearch,
    report: &mut Diagnostics,
) {
    let searched: Vec<usize> = listed((0..m.nactuator).filter(|&i| search.needs_search(m, i)));
    let pulled = searched.iter().filter(|&&i| search.limits(m, i).is_none()).count();
    let Some(first) = searched.first().and_then(|&i| list.get(i)) else { return };
    // With active limits, the cost of a step grows with the cube of the number of degrees of freedom.
    let nv = m.nv.max(1) as f64;
    if pulled as f64 * search.steps(m) * nv * (1.0 + (nv / 64.0).powi(2)) > MAX_SEARCH {
        let message = format!("the length ranges of {pulled} actuators take too many steps to find");
        report.error(rules::LIMIT, first.span.clone(), message).help("write a `lengthrange` for each");
        return;
    }
    let Workspace { fields: mut d, scratch: mut s } = Workspace::unplanned(m);
    for i in searched {
        let Some(spec) = list.get(i) else { continue };
        let wrong = match lengthrange::length_range(m, &mut d, &mut s, i, search) {
            Ok(()) => continue,
            _ if !lengthrange::has_length(m, i) => "its target gives it no length".to_string(),
            Err(RangeError::NoRange([lower, upper])) => {
                format!("pulling it either way gives {lower:.4} and {upper:.4}")
            }
            Err(RangeError::NotSettled([lower, upper])) => {
                format!("pulled for the maximum time, it still moves between {lower:.4} and {upper:.4}")
            }
        };
        let message = format!("no length range is found for {}: {wrong}", spec.described);
        report
            .error(rules::ACTUATOR, spec.span.clone(), message)
            .why("the force of a muscle depends on its length within its possible range")
            .help("write `lengthrange`, or limit the joints that it moves");
    }
}
