//! Writes equality constraints, contact pairs and exclusions to the arrays of [`Model`].

use crate::mjcf::arrays::flat;
use crate::mjcf::spec::{EqualitySpec, ExcludeSpec, PairSpec};
use crate::model::Model;

/// All fields of equality constraints.
pub(crate) fn equalities(m: &mut Model, list: &[EqualitySpec]) {
    flat(&mut m.eq_type, list, |e| [e.kind]);
    flat(&mut m.eq_objtype, list, |e| [e.objtype]);
    flat(&mut m.eq_obj1id, list, |e| [e.obj1]);
    flat(&mut m.eq_obj2id, list, |e| [e.obj2]);
    flat(&mut m.eq_active0, list, |e| [e.active]);
    flat(&mut m.eq_solref, list, |e| e.solref);
    flat(&mut m.eq_solimp, list, |e| e.solimp);
    flat(&mut m.eq_data, list, |e| e.data);
}

/// All fields of contact pairs and exclusions.
pub(crate) fn contacts(m: &mut Model, pairs: &[PairSpec], excludes: &[ExcludeSpec]) {
    flat(&mut m.pair_dim, pairs, |p| [p.condim]);
    flat(&mut m.pair_geom1, pairs, |p| [p.geoms[0]]);
    flat(&mut m.pair_geom2, pairs, |p| [p.geoms[1]]);
    flat(&mut m.pair_signature, pairs, |p| [p.signature]);
    flat(&mut m.pair_solref, pairs, |p| p.solref);
    flat(&mut m.pair_solreffriction, pairs, |p| p.solreffriction);
    flat(&mut m.pair_solimp, pairs, |p| p.solimp);
    flat(&mut m.pair_margin, pairs, |p| [p.margin]);
    flat(&mut m.pair_gap, pairs, |p| [p.gap]);
    flat(&mut m.pair_adhesion, pairs, |p| [p.adhesion]);
    flat(&mut m.pair_friction, pairs, |p| p.friction);
    flat(&mut m.exclude_signature, excludes, |e| [e.signature]);
    flat(&mut m.exclude_bodies, excludes, |e| [e.bodies]);
}
