//! Sensors that need a distance without a closed form.

use super::pair::geoms;
use super::table::kind;
use crate::geometry::pair::is_searched;
use crate::model::Model;

/// The first pair of geoms whose distance a sensor needs and the general algorithm would compute.
pub fn searched_pair(m: &Model) -> Option<[usize; 2]> {
    let of_pairs =
        |&s: &usize| matches!(m.sensor_type[s], kind::GEOMDIST | kind::GEOMNORMAL | kind::GEOMFROMTO);
    let searched = |a: usize, b: usize| is_searched(m.geom_type[a], m.geom_type[b], true);
    (0..m.nsensor).filter(of_pairs).find_map(|s| {
        geoms(m, m.sensor_objtype[s], m.sensor_objid[s]).find_map(|a| {
            let mut others = geoms(m, m.sensor_reftype[s], m.sensor_refid[s]);
            others.find(|&b| searched(a, b)).map(|b| [a, b])
        })
    })
}
