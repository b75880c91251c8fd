//! Explicit contact pairs, and pairs of bodies that are excluded from contacts.

use crate::mjcf::context::Context;
use crate::mjcf::gather::listed;
use crate::mjcf::ids::References;
use crate::mjcf::rules;
use crate::mjcf::spec::{BodySpec, ExcludeSpec, PairSpec, SOLIMP, SOLREF};
use crate::mjcf::text::tree::{ElementNode, name};
use labspec_finding::order::sort_by_key;

/// All pairs and exclusions, each in the order of their bodies.
pub(crate) fn contacts(
    cx: &mut Context,
    refs: References,
    bodies: &[BodySpec],
) -> (Vec<PairSpec>, Vec<ExcludeSpec>) {
    let body_of: Vec<i32> =
        listed(bodies.iter().enumerate().flat_map(|(i, b)| b.geoms.iter().map(move |_| i as i32)));
    let (mut pairs, mut excludes) = (Vec::new(), Vec::new());
    let tree = cx.tree;
    for (_, node) in tree.sections("contact").flat_map(|(section, _)| tree.children(section)) {
        if node.element.name == "pair" {
            pairs.extend(pair(cx, refs, node, &body_of));
        } else {
            let body1 = refs.required("body", node, "body1", cx.report);
            let body2 = refs.required("body", node, "body2", cx.report);
            if let (Some(a), Some(b)) = (body1, body2) {
                let bodies = [a.min(b), a.max(b)];
                excludes.push(ExcludeSpec {
                    name: name(node),
                    bodies,
                    signature: signature(bodies[0], bodies[1]),
                });
            }
        }
    }
    sort_by_key(&mut pairs, |p| p.bodies);
    sort_by_key(&mut excludes, |e| e.bodies);
    (pairs, excludes)
}

/// MuJoCo's signature of a pair of bodies in one integer, the smaller id first. With more than 65,535 bodies, two pairs can have
/// the same signature.
fn signature(body1: i32, body2: i32) -> i32 {
    body1.wrapping_shl(16).wrapping_add(body2)
}

fn pair(cx: &mut Context, refs: References, node: &ElementNode, body_of: &[i32]) -> Option<PairSpec> {
    let p = cx.classes.props_of("pair", node, None);
    let geom1 = refs.required("geom", node, "geom1", cx.report);
    let geom2 = refs.required("geom", node, "geom2", cx.report);
    let condim = p.int("condim").unwrap_or(3);
    if !matches!(condim, 1 | 3 | 4 | 6) {
        let span = p.span("condim").unwrap_or(node.span.clone());
        cx.report
            .error(rules::VALUE, span, format!("`condim` of {} is {condim}", node.describe()))
            .help("write 1 (frictionless), 3 (sliding), 4 (and spinning) or 6 (and rolling friction)");
    }
    let mut geoms = [geom1?, geom2?];
    let body = |g: i32| usize::try_from(g).ok().and_then(|g| body_of.get(g)).copied().unwrap_or(0);
    if body(geoms[0]) > body(geoms[1]) {
        geoms.reverse();
    }
    Some(PairSpec {
        name: name(node),
        geoms,
        bodies: geoms.map(body),
        signature: signature(body(geoms[0]), body(geoms[1])),
        condim,
        friction: p.reals("friction", [1.0, 1.0, 0.005, 0.0001, 0.0001]),
        solref: p.reals("solref", SOLREF),
        solreffriction: p.reals("solreffriction", [0.0; 2]),
        solimp: p.reals("solimp", SOLIMP),
        margin: p.real("margin").unwrap_or(0.0),
        gap: p.real("gap").unwrap_or(0.0),
        adhesion: p.real("adhesion").unwrap_or(0.0),
    })
}
