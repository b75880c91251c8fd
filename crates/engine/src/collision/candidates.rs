//! The pairs of geoms to test: all pairs that can ever be in contact, under every change that may be written later.

use super::extent::Extents;
use super::filter::{Pair, bodies_may_touch, dynamic_pair, explicit_pairs};
use super::params;
use crate::model::Model;
use crate::model::index::element_range;
use labspec_finding::order;

/// Maximum number of pairs in the list of a scene. Scenes with more pairs search for the near ones at every step.
pub(crate) const MOST_LISTED: usize = 4096;

/// Fields that may be written after the pairs were selected.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Changes {
    /// Contact bits and flags.
    pub(crate) bits: bool,
    /// Contact parameters.
    pub(crate) params: bool,
    /// Positions and orientations of bodies, joints and geoms in the model.
    pub(crate) places: bool,
}

/// All pairs that can ever be in contact, in the order in which they are tested. The function stops early, with an
/// incomplete list, when the list becomes longer than [`MOST_LISTED`].
pub(crate) fn candidate_pairs(m: &Model, change: Changes) -> Vec<Pair> {
    let extents = (!change.places && !change.params).then(|| Extents::new(m));
    let meet = |p: &Pair| !extents.as_ref().is_some_and(|e| e.never_within(m, p, params::params(m, p).reach));
    let geoms = |b: usize| element_range(m.body_geomadr[b], m.body_geomnum[b]);
    let with_geoms: Vec<usize> = (0..m.nbody).filter(|&b| m.body_geomnum[b] > 0).collect();
    let mut out: Vec<Pair> = explicit_pairs(m).filter(meet).collect();
    for (i, &b1) in with_geoms.iter().enumerate() {
        for &b2 in &with_geoms[i + 1..] {
            if !bodies_may_touch(m, b1, b2) {
                continue;
            }
            for g1 in geoms(b1) {
                out.extend(geoms(b2).filter_map(|g2| dynamic_pair(m, g1, g2, change.bits)).filter(meet));
            }
            if out.len() > MOST_LISTED {
                return out;
            }
        }
    }
    order::sort_by(&mut out, |p, q| p.order(m).cmp(&q.order(m)));
    out
}
