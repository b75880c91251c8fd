//! Geoms that are deep inside of each other where the model begins.

use super::{digits, place, shown};
use crate::kinds::geom;
use crate::mjcf::rules;
use crate::mjcf::text::diagnostic::Report;
use crate::mjcf::text::tree::Tree;
use crate::model::{Model, Obj};
use crate::step::forward::position;
use crate::step::workspace::Data;

/// A contact deeper than this part of the smaller geom's half thickness is no contact.
const DEEP: f64 = 0.3;
/// Larger models are not looked at.
const MOST: usize = 500;

pub(super) fn tell(tree: &Tree, m: &Model, report: &mut Report) {
    if m.ngeom > MOST || m.nv > MOST || m.nv == 0 {
        return;
    }
    // Nothing is solved: where things are is enough.
    let mut d = Data::new(m);
    position(m, &mut d);
    let depth = |pair: [usize; 2], dist: f64| {
        let size = pair.iter().map(|g| half(m, *g)).fold(f64::INFINITY, f64::min);
        (-dist > DEEP * size).then_some(-dist)
    };
    let deep = d.contact.iter().filter(|c| c.efc_address.is_some());
    let deep = deep.filter_map(|c| Some(([c.geom1, c.geom2], depth([c.geom1, c.geom2], c.dist)?)));
    let Some(([a, b], depth)) = deep.max_by(|x, y| x.1.total_cmp(&y.1)) else { return };
    let name = |g: usize| m.names.of(Obj::Geom).get(g).map_or("", String::as_str);
    let message = format!(
        "{} begins {} mm inside of {}",
        shown("geom", name(b), b),
        digits(1000.0 * depth),
        shown("geom", name(a), a)
    );
    report
        .note(rules::OVERLAP, place(tree, &["geom"], name(b)), message)
        .why("a lab that begins here, without a keyframe or a setup, throws the two apart")
        .help("let them touch at most, or leave the pair out of contact");
}

/// Half of the smallest extent of a geom, m; infinite where it has none.
fn half(m: &Model, g: usize) -> f64 {
    let size = |k: usize| m.geom_size.get(3 * g + k).copied().unwrap_or(0.0);
    match m.geom_type.get(g).copied() {
        Some(geom::SPHERE | geom::CAPSULE) => size(0),
        Some(geom::CYLINDER) => size(0).min(size(1)),
        Some(geom::BOX | geom::ELLIPSOID) => size(0).min(size(1)).min(size(2)),
        _ => f64::INFINITY,
    }
}
