//! What compiles but cannot be simulated yet: it is refused where the scene would need it, and accepted where
//! constraints are switched off.

use super::diagnostic::{Report, code};
use super::tree::Tree;
use crate::{Model, collision, disable, enable, solver};

/// Reports the first element of each kind that the scene needs.
pub(crate) fn check(tree: &Tree, m: &Model, report: &mut Report) {
    if m.opt.enabled(enable::SLEEP) {
        let flag = tree.nodes.iter().filter(|n| n.element.name == "flag").find_map(|n| n.attribute("sleep"));
        let span = flag.map_or(0..0, |a| a.span.clone());
        report
            .error(code::NOT_SUPPORTED, span, "sleeping is not simulated yet")
            .why("trees that MuJoCo puts to sleep would go on moving a little");
    }
    let on = |bit: i32| !m.opt.disabled(disable::CONSTRAINT) && !m.opt.disabled(bit);
    let limited = on(disable::LIMIT) && m.jnt_limited.contains(&true);
    if m.opt.enabled(enable::DIAGEXACT) && on(0) {
        refuse(tree, report, "", "diagexact", "the exact diagonal of the constraint problem");
    }
    let touches = on(disable::CONTACT) && !collision::candidate_pairs(m, false).is_empty();
    if (limited || touches) && m.opt.solver == solver::PGS {
        refuse(tree, report, "", "solver", "a solver other than Newton");
    }
    if (limited || touches) && m.opt.noslip_iterations > 0 {
        refuse(tree, report, "", "noslip_iterations", "the removal of slip");
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
