//! Geoms that penetrate each other deeply at the start.

use super::{digits, element_span, format_name};
use crate::mjcf::rules;
use crate::mjcf::text::diagnostic::Diagnostics;
use crate::mjcf::text::tree::ElementTree;
use crate::model::extents::half_thickness_of_pair;
use crate::model::{Fields, Model, Obj};
use crate::step::forward::position;
use crate::step::workspace::Workspace;

/// A penetration deeper than this fraction of the smaller geom's half thickness is reported.
const MIN_REPORTED_DEPTH: f64 = 0.3;
/// Models with more geoms or degrees of freedom are not checked.
const MOST: usize = 500;
/// The check of a model stops after this work, in units of the engine: about 50 ms.
const WORK: u64 = 50_000_000;

pub(super) fn check_overlaps(tree: &ElementTree, m: &Model, report: &mut Diagnostics) {
    let Some(d) = data_after_position_stages(m) else { return };
    let depth = |pair: [usize; 2], dist: f64| {
        (-dist > MIN_REPORTED_DEPTH * half_thickness_of_pair(m, pair)).then_some(-dist)
    };
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
        .note(rules::OVERLAP, element_span(tree, &["geom"], name(b)), message)
        .why("a lab that begins here, without a keyframe or a setup, throws the two apart")
        .help("move them until they only touch, or exclude the pair from contact");
}

/// The data after the position stages, or `None` if the model is too large.
fn data_after_position_stages(m: &Model) -> Option<Fields> {
    if m.ngeom > MOST || m.nv > MOST || m.nv == 0 {
        return None;
    }
    // The solver does not run: the poses and contacts are sufficient.
    let Workspace { fields: mut d, scratch: mut s } = Workspace::new(m);
    d.meter.limit = WORK;
    position(m, &mut d, &mut s);
    (!d.meter.over()).then_some(d)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, clippy::panic)] // a panic is the report of a failed test
mod tests {
    use super::*;
    use crate::mjcf::compile;

    /// Many geoms at the same position, distributed over bodies with hinges.
    fn coincident_geoms(geoms: usize, bodies: usize, geom: &str) -> Model {
        let inside = geom.repeat(geoms / bodies);
        let body = format!("<body><joint/>{inside}</body>");
        compile(&format!("<mujoco><worldbody>{}</worldbody></mujoco>", body.repeat(bodies))).unwrap()
    }

    /// The work of the check is bounded, for any number of geoms at the same position.
    #[test]
    fn coincident_geoms_take_bounded_work() {
        for geom in [
            "<geom size='.1'/>",
            "<geom type='box' size='.1 .1 .1'/>",
            "<geom type='capsule' size='.1 .1'/>",
            "<geom type='cylinder' size='.1 .1'/>",
            "<geom type='ellipsoid' size='.1 .2 .3'/>",
        ] {
            for (geoms, bodies) in [(20, 10), (200, 100), (500, 250), (500, 500)] {
                let m = coincident_geoms(geoms, bodies, geom);
                let Workspace { fields: mut d, scratch: mut s } = Workspace::new(&m);
                d.meter.limit = WORK;
                position(&m, &mut d, &mut s);
                // The excess over the limit is at most one test of a pair, and the stages that use the contacts found so far.
                assert!(d.meter.cost < 2 * WORK, "{geoms} of {geom} in {bodies}: {}", d.meter.cost);
                assert_eq!(data_after_position_stages(&m).is_some(), !d.meter.over());
            }
            assert!(data_after_position_stages(&coincident_geoms(20, 10, geom)).is_some(), "{geom}");
            // A model with more geoms than the limit is not checked, and a model with ten thousand geoms is an error.
            assert!(data_after_position_stages(&coincident_geoms(5000, 10, geom)).is_none(), "{geom}");
        }
        let many = "<geom size='.1'/>".repeat(10_000);
        let xml = format!("<mujoco><worldbody><body><joint/>{many}</body></worldbody></mujoco>");
        assert!(compile(&xml).unwrap_err().iter().any(|f| f.code == "mjcf-limit"));
    }
}
