//! What compiles but cannot be simulated yet: it is refused.

use super::diagnostic::{Report, code};
use super::tree::Tree;
use crate::{Model, collision, disable, enable, eqtype};

/// Reports what the model asks for and does not get.
pub(crate) fn check(tree: &Tree, m: &Model, report: &mut Report) {
    if m.opt.enabled(enable::SLEEP) {
        asleep(tree, m, report);
    }
}

/// Reports sleeping where it would have to know of constraints.
fn asleep(tree: &Tree, m: &Model, report: &mut Report) {
    let flag = || tree.nodes.iter().filter(|n| n.element.name == "flag").find_map(|n| n.attribute("sleep"));
    let span = || flag().map_or(0..0, |a| a.span.clone());
    let off = |bit: i32| m.opt.disabled(disable::CONSTRAINT) || m.opt.disabled(bit);
    let acts = |e: usize| m.eq_type[e] == eqtype::TENDON && m.eq_active0[e];
    if (0..m.neq).any(acts) {
        report
            .error(code::NOT_SUPPORTED, span(), "trees cannot sleep while an equality ties tendons")
            .why("MuJoCo has no rule for what wakes them, and refuses such a model, too")
            .help("switch sleeping off, or remove the equality between tendons");
    } else if !off(disable::LIMIT) && (m.jnt_limited.contains(&true) || m.tendon_limited.contains(&true))
        || !off(disable::EQUALITY) && m.neq > 0
        || !off(disable::CONTACT) && !collision::candidate_pairs(m, false).is_empty()
    {
        report
            .error(
                code::NOT_SUPPORTED,
                span(),
                "sleeping is not simulated yet where bodies can touch, or have limits",
            )
            .why("trees that MuJoCo puts to sleep would go on moving a little")
            .help("switch sleeping off: at rest the numbers differ by less than `sleep_tolerance`");
    }
}
