//! Statistics of the pairs of geoms: how many can be in contact, and why the others cannot.

use super::candidates::{Changes, candidate_pairs};
use super::extent::Extents;
use super::filter::{Pair, dynamic_pair, excluded, explicit_pairs, masks_admit, parent_and_child};
use super::{CollisionScratch, params, sweep};
use crate::geometry::pair;
use crate::model::{Fields, Model};
use labspec_finding::order;
use std::collections::BTreeSet;

/// Whether a pair of geoms can be in contact, and the reason if it cannot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum PairFilterReason {
    /// The geoms can be in contact; the pair is tested at every step.
    CanTouch,
    /// The geoms belong to one body.
    SameBody,
    /// Their bodies are welded together.
    Welded,
    /// Neither of their bodies can move.
    Static,
    /// The model excludes contacts of their bodies.
    Excluded,
    /// Their bodies are parent and child.
    ParentAndChild,
    /// Their contact bits admit no contact.
    Masks,
    /// Geoms of these types do not collide.
    Shapes,
    /// The geoms cannot reach each other in any configuration.
    OutOfReach,
}

impl PairFilterReason {
    /// The reason as a phrase.
    pub fn reason(self) -> &'static str {
        match self {
            PairFilterReason::CanTouch => "they can touch",
            PairFilterReason::SameBody => "both belong to one body",
            PairFilterReason::Welded => "their bodies are welded together",
            PairFilterReason::Static => "neither of them can move",
            PairFilterReason::Excluded => "the model excludes them",
            PairFilterReason::ParentAndChild => "their bodies are parent and child",
            PairFilterReason::Masks => "their contact bits admit no contact",
            PairFilterReason::Shapes => "such shapes pass through each other",
            PairFilterReason::OutOfReach => "they are out of reach of each other in every configuration",
        }
    }
}

/// The number of pairs of geoms for each reason. Each pair is counted once, and reasons without pairs are omitted.
/// Filters that depend on fields in `change` exclude no pair.
pub fn pair_statistics(m: &Model, change: Changes) -> Vec<(PairFilterReason, usize)> {
    let extents = (!change.places && !change.params).then(|| Extents::new(m));
    let named: BTreeSet<[i32; 2]> = (0..m.npair).map(|p| ordered(m.pair_geom1[p], m.pair_geom2[p])).collect();
    let mut counts: Vec<(PairFilterReason, usize)> = Vec::new();
    for a in 0..m.ngeom {
        for b in a + 1..m.ngeom {
            let named = named.contains(&[a as i32, b as i32]);
            let mut reason = reason(m, a, b, change.bits, named);
            if reason == PairFilterReason::CanTouch
                && extents.as_ref().is_some_and(|e| is_out_of_reach(m, e, a, b))
            {
                reason = PairFilterReason::OutOfReach;
            }
            match counts.iter_mut().find(|(f, _)| *f == reason) {
                Some((_, n)) => *n += 1,
                None => counts.push((reason, 1)),
            }
        }
    }
    order::sort_by_key(&mut counts, |(reason, _)| *reason);
    counts
}

/// Whether two geoms are out of reach of each other, also with the margins of their explicit pairs.
fn is_out_of_reach(m: &Model, extents: &Extents, a: usize, b: usize) -> bool {
    let both = ordered(a as i32, b as i32);
    let has_both = |p: &Pair| ordered(p.geom1 as i32, p.geom2 as i32) == both;
    let mut pairs = explicit_pairs(m).filter(has_both).chain(dynamic_pair(m, a, b, true));
    pairs.all(|p| extents.never_within(m, &p, params::params(m, &p).reach))
}

fn ordered(a: i32, b: i32) -> [i32; 2] {
    [a.min(b), a.max(b)]
}

/// The reason for one pair of geoms. Explicit pairs (`named`) are not filtered by bits and parents.
fn reason(m: &Model, a: usize, b: usize, may_change: bool, named: bool) -> PairFilterReason {
    let bodies @ [ba, bb] = [a, b].map(|g| m.geom_bodyid[g] as usize);
    let welds @ [wa, wb] = bodies.map(|body| m.body_weldid[body] as usize);
    let (small, large) = (m.geom_type[a].min(m.geom_type[b]), m.geom_type[a].max(m.geom_type[b]));
    let still = welds.iter().all(|&w| m.body_dofnum[w] == 0 && m.body_treeid[w] < 0);
    let rules = !named;
    match () {
        () if rules && ba == bb => PairFilterReason::SameBody,
        () if still && (rules || m.nbody == 1) => PairFilterReason::Static,
        () if rules && wa == wb => PairFilterReason::Welded,
        () if rules && excluded(m, ba, bb) => PairFilterReason::Excluded,
        () if rules && !may_change && parent_and_child(m, a, b) => PairFilterReason::ParentAndChild,
        () if rules && !may_change && !masks_admit(m, a, b) => PairFilterReason::Masks,
        () if pair::method(small, large).is_none() => PairFilterReason::Shapes,
        () => PairFilterReason::CanTouch,
    }
}

/// The pairs that can be in contact, grouped by types: types, number of pairs, and whether the general algorithm
/// computes their contacts. If a scene has too many pairs for a list, only the first ones are counted.
pub fn pair_methods(m: &Model, change: Changes) -> Vec<([i32; 2], usize, bool)> {
    let mut out: Vec<([i32; 2], usize, bool)> = Vec::new();
    for Pair { geom1, geom2, .. } in candidate_pairs(m, change) {
        let types = [geom1, geom2].map(|g| m.geom_type[g as usize]);
        match out.iter_mut().find(|(t, ..)| *t == types) {
            Some((_, n, _)) => *n += 1,
            None => out.push((types, 1, pair::is_searched(types[0], types[1], false))),
        }
    }
    order::sort_by_key(&mut out, |(types, ..)| *types);
    out
}

/// The number of planned pairs whose bounding spheres are currently within reach of each other. Each of the other
/// pairs costs one comparison.
pub fn in_reach(m: &Model, d: &Fields, w: &CollisionScratch) -> usize {
    if let Some(sweep) = &w.pairs.sweep {
        return sweep.near.len();
    }
    let near = |pair: &&Pair| {
        let [g1, g2] = [pair.geom1 as usize, pair.geom2 as usize];
        !sweep::out_of_reach(m, d, g1, g2, params::params(m, pair).reach)
    };
    w.pairs.pairs.iter().filter(near).count()
}
