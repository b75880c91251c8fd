//! Refuses models that compile but cannot be simulated.

use crate::kinds::{disable, enable, eqtype, integrator};
use crate::mjcf::rules;
use crate::mjcf::text::diagnostic::Diagnostics;
use crate::mjcf::text::tree::ElementTree;
use crate::model::asleep::policy;
use crate::model::{Model, Obj};
use crate::step::workspace::Workspace;

/// Reports requested features that are not supported.
pub(crate) fn report_unsimulated(tree: &ElementTree, m: &Model, report: &mut Diagnostics) {
    if m.opt.enabled(enable::SLEEP) {
        asleep(tree, m, report);
    }
}

/// Reports features that are not supported together with sleep.
fn asleep(tree: &ElementTree, m: &Model, report: &mut Diagnostics) {
    let flag = || tree.nodes.iter().filter(|n| n.element.name == "flag").find_map(|n| n.attribute("sleep"));
    let span = || flag().map_or(0..0, |a| a.span.clone());
    let acts = |e: usize| m.eq_type[e] == eqtype::TENDON && m.eq_active0[e];
    if (0..m.neq).any(acts) {
        report
            .error(rules::NOT_SUPPORTED, span(), "trees cannot sleep while an equality connects tendons")
            .why("MuJoCo has no rule for what wakes them, and refuses such a model too")
            .help("switch sleeping off, or remove the equality between tendons");
        return;
    }
    if m.opt.integrator == integrator::DISCRETE && m.opt.disabled(disable::ISLAND) {
        report
            .error(
                rules::NOT_SUPPORTED,
                span(),
                "trees cannot sleep with the discrete integrator without islands",
            )
            .why("without islands the engine does not know which trees are connected; MuJoCo refuses such a model too")
            .help("keep islands switched on, or choose another integrator");
        return;
    }
    if !m.tree_sleep_policy.contains(&policy::INIT) {
        return;
    }
    let d = Workspace::new(m).fields;
    let awake = |t: &usize| m.tree_sleep_policy[*t] == policy::INIT && d.tree_asleep[*t] < 0;
    for t in (0..m.ntree).filter(awake) {
        let body = m.names.of_kind(Obj::Body).get(m.tree_bodyadr[t] as usize).filter(|name| !name.is_empty());
        let who = body.map_or("a body without a name".into(), |name| format!("body `{name}`"));
        report
            .error(rules::JOINT, span(), format!("{who} cannot start asleep"))
            .why("it is in contact with, or tied to, a body that does not start asleep: connected bodies sleep together")
            .help("give `sleep=\"init\"` to all bodies in contact at the start, or move them apart");
    }
}
