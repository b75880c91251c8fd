//! Geoms that are deep inside of each other where the model begins.

use super::{digits, format_name, place};
use crate::mjcf::rules;
use crate::mjcf::text::diagnostic::Report;
use crate::mjcf::text::tree::Tree;
use crate::model::extents::half_thickness_of_pair;
use crate::model::{Fields, Model, Obj};
use crate::step::forward::position;
use crate::step::workspace::Workspace;

/// A contact deeper than this part of the smaller geom's half thickness is no contact.
const DEEP: f64 = 0.3;
/// Larger models are not looked at.
const MOST: usize = 500;
/// Nor is one looked at to the end that takes more work than this, in the units of the engine: about 50 ms.
const WORK: u64 = 50_000_000;

pub(super) fn check_overlaps(tree: &Tree, m: &Model, report: &mut Report) {
    let Some(d) = placed(m) else { return };
    let depth =
        |pair: [usize; 2], dist: f64| (-dist > DEEP * half_thickness_of_pair(m, pair)).then_some(-dist);
    let deep = d.contact.iter().filter(|c| c.efc_address.is_some());
    let deep = deep.filter_map(|c| Some(([c.geom1, c.geom2], depth([c.geom1, c.geom2], c.dist)?)));
    let Some(([a, b], depth)) = deep.max_by(|x, y| x.1.total_cmp(&y.1)) else { return };
    let name = |g: usize| m.names.of_kind(Obj::Geom).get(g).map_or("", String::as_str);
    let message = format!(
        "{} begins {} mm inside {}",
        format_name("geom", name(b), b),
        digits(1000.0 * depth),
        format_name("geom", name(a), a)
    );
    report
        .note(rules::OVERLAP, place(tree, &["geom"], name(b)), message)
        .why("a lab that begins here, without a keyframe or a setup, throws the two apart")
        .help("move them until they only touch, or exclude the pair from contact");
}

/// Everything at its place; nothing where that is too much.
fn placed(m: &Model) -> Option<Fields> {
    if m.ngeom > MOST || m.nv > MOST || m.nv == 0 {
        return None;
    }
    // Nothing is solved: where things are is enough.
    let Workspace { fields: mut d, scratch: mut s } = Workspace::new(m);
    d.meter.limit = WORK;
    position(m, &mut d, &mut s);
    (!d.meter.over()).then_some(d)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, clippy::panic)]
mod tests {
    use super::*;
    use crate::mjcf::compile;

    /// Geoms in one place, in so many bodies that turn about hinges beside each other.
    fn heap(geoms: usize, bodies: usize, geom: &str) -> Model {
        let inside = geom.repeat(geoms / bodies);
        let body = format!("<body><joint/>{inside}</body>");
        compile(&format!("<mujoco><worldbody>{}</worldbody></mujoco>", body.repeat(bodies))).unwrap()
    }

    /// However many there are in one place: what is looked at ends where it should, counted in the work of the engine.
    #[test]
    fn geoms_in_one_place_take_bounded_work() {
        for geom in [
            "<geom size='.1'/>",
            "<geom type='box' size='.1 .1 .1'/>",
            "<geom type='capsule' size='.1 .1'/>",
            "<geom type='cylinder' size='.1 .1'/>",
            "<geom type='ellipsoid' size='.1 .2 .3'/>",
        ] {
            for (geoms, bodies) in [(20, 10), (200, 100), (500, 250), (500, 500)] {
                let m = heap(geoms, bodies, geom);
                let Workspace { fields: mut d, scratch: mut s } = Workspace::new(&m);
                d.meter.limit = WORK;
                position(&m, &mut d, &mut s);
                // One test of a pair more than the limit, and what follows from the contacts that were found by then.
                assert!(d.meter.cost < 2 * WORK, "{geoms} of {geom} in {bodies}: {}", d.meter.cost);
                assert_eq!(placed(&m).is_some(), !d.meter.over());
            }
            assert!(placed(&heap(20, 10, geom)).is_some(), "{geom}");
            // The largest model that there is is not looked at; one with ten thousand geoms is none.
            assert!(placed(&heap(5000, 10, geom)).is_none(), "{geom}");
        }
        let many = "<geom size='.1'/>".repeat(10_000);
        let xml = format!("<mujoco><worldbody><body><joint/>{many}</body></worldbody></mujoco>");
        assert!(compile(&xml).unwrap_err().iter().any(|f| f.code == "mjcf-limit"));
    }
}
