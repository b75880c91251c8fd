//! What compiles but cannot be simulated yet: it is refused where the scene would need it, and accepted where
//! constraints are switched off.

use super::diagnostic::{Report, code};
use super::tree::Tree;
use crate::math::rows;
use crate::{Model, collision, disable, enable, eqtype};

/// Value of `opt.solver`.
const NEWTON: i32 = 2;

/// Reports the first element of each kind that the scene needs.
pub(crate) fn check(tree: &Tree, m: &Model, report: &mut Report) {
    if m.opt.enabled(enable::SLEEP) {
        asleep(tree, m, report);
    }
    let on = |bit: i32| !m.opt.disabled(disable::CONSTRAINT) && !m.opt.disabled(bit);
    let some = |list: &[f64]| list.iter().any(|&x| x > 0.0);
    if on(disable::EQUALITY) && m.neq > 0 {
        refuse(tree, report, "equality", "", "an equality constraint");
    }
    if on(disable::FRICTIONLOSS) && (some(&m.dof_frictionloss) || some(&m.tendon_frictionloss)) {
        refuse(tree, report, "", "frictionloss", "dry friction in a joint or tendon");
    }
    if on(disable::LIMIT) && m.tendon_limited.contains(&true) {
        refuse(tree, report, "tendon", "range", "a limited tendon");
    }
    let limited = on(disable::LIMIT) && m.jnt_limited.contains(&true);
    if m.opt.enabled(enable::DIAGEXACT) && on(0) {
        refuse(tree, report, "", "diagexact", "the exact diagonal of the constraint problem");
    }
    let touches = on(disable::CONTACT) && !collision::candidate_pairs(m, false).is_empty();
    if (limited || touches) && m.opt.solver != NEWTON {
        refuse(tree, report, "", "solver", "a solver other than Newton");
    }
    if (limited || touches) && m.opt.noslip_iterations > 0 {
        refuse(tree, report, "", "noslip_iterations", "the removal of slip");
    }
    if !touches {
        return;
    }
    if m.opt.cone != 0 {
        refuse(tree, report, "", "cone", "the elliptic friction cone");
    }
    let pairs = collision::candidate_pairs(m, false);
    let turns = |dim: i32| dim > 3;
    if pairs.iter().any(|p| [p.geom1, p.geom2].iter().any(|&g| turns(m.geom_condim[g as usize])))
        || m.pair_dim.iter().any(|&d| turns(d))
    {
        refuse(tree, report, "", "condim", "spinning and rolling friction (`condim` 4 and 6)");
    }
    if some(&m.geom_adhesion) || some(&m.pair_adhesion) {
        refuse(tree, report, "", "adhesion", "a contact that pulls");
    }
    if rows::<6>(&m.geom_surfacevel).iter().any(|v| *v != [0.0; 6]) {
        refuse(tree, report, "", "surfacevel", "a surface that moves");
    }
    let own_friction = |r: &[f64; 2]| *r != [0.0; 2];
    if rows::<2>(&m.pair_solreffriction).iter().any(own_friction) {
        refuse(tree, report, "pair", "solreffriction", "friction with a `solref` of its own");
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

/// Reports the first element below a section (any, when it is empty) that has an attribute (any, when it is
/// empty).
fn refuse(tree: &Tree, report: &mut Report, section: &str, attribute: &str, what: &str) {
    let inside = |mut at: Option<usize>| {
        while let Some(node) = at.and_then(|i| tree.nodes.get(i)) {
            if node.element.name == section {
                return true;
            }
            at = node.parent;
        }
        section.is_empty()
    };
    let place = tree.nodes.iter().find_map(|node| {
        let own = node.attributes.iter().find(|a| a.attr.name == attribute);
        let here = inside(node.parent) || node.element.name == section && !attribute.is_empty();
        match own {
            Some(a) if here => Some(a.span.clone()),
            None if here && attribute.is_empty() => Some(node.span.clone()),
            _ => None,
        }
    });
    report
        .error(code::NOT_SUPPORTED, place.unwrap_or(0..0), format!("{what} is not simulated yet"))
        .why("the scene would move as if it were not there")
        .help("remove it, or switch constraints off: `<option><flag constraint=\"disable\"/></option>`");
}
