//! Equality constraints, contact pairs and exclusions to the arrays of [`Model`].

use crate::mjcf::arrays::{flat, ints};
use crate::mjcf::gather::listed;
use crate::mjcf::spec::{EqualitySpec, ExcludeSpec, PairSpec};
use crate::model::Model;

/// All fields of equality constraints.
pub(crate) fn equalities(m: &mut Model, list: &[EqualitySpec]) {
    m.eq_type = ints(list, |e| e.kind);
    m.eq_objtype = ints(list, |e| e.objtype);
    m.eq_obj1id = ints(list, |e| e.obj1);
    m.eq_obj2id = ints(list, |e| e.obj2);
    m.eq_active0 = listed(list.iter().map(|e| e.active));
    m.eq_solref = flat(list, |e| e.solref);
    m.eq_solimp = flat(list, |e| e.solimp);
    m.eq_data = flat(list, |e| e.data);
}

/// All fields of contact pairs and exclusions.
pub(crate) fn contacts(m: &mut Model, pairs: &[PairSpec], excludes: &[ExcludeSpec]) {
    m.pair_dim = ints(pairs, |p| p.condim);
    m.pair_geom1 = ints(pairs, |p| p.geoms[0]);
    m.pair_geom2 = ints(pairs, |p| p.geoms[1]);
    m.pair_signature = ints(pairs, |p| p.signature);
    m.pair_solref = flat(pairs, |p| p.solref);
    m.pair_solreffriction = flat(pairs, |p| p.solreffriction);
    m.pair_solimp = flat(pairs, |p| p.solimp);
    m.pair_margin = flat(pairs, |p| [p.margin]);
    m.pair_gap = flat(pairs, |p| [p.gap]);
    m.pair_adhesion = flat(pairs, |p| [p.adhesion]);
    m.pair_friction = flat(pairs, |p| p.friction);
    m.exclude_signature = ints(excludes, |e| e.signature);
    m.exclude_bodies = listed(excludes.iter().map(|e| e.bodies));
}
