//! What compiles but cannot be simulated yet: it is refused.

use super::diagnostic::{Report, code};
use super::tree::Tree;
use crate::{Model, enable};

/// Reports what the model asks for and does not get.
pub(crate) fn check(tree: &Tree, m: &Model, report: &mut Report) {
    if m.opt.enabled(enable::SLEEP) {
        let flag = tree.nodes.iter().filter(|n| n.element.name == "flag").find_map(|n| n.attribute("sleep"));
        let span = flag.map_or(0..0, |a| a.span.clone());
        report
            .error(code::NOT_SUPPORTED, span, "sleeping is not simulated yet")
            .why("trees that MuJoCo puts to sleep would go on moving a little");
    }
}
