//! Statistics of the pairs of geoms: how many can ever touch, and why the others cannot.

use super::candidates::{Changes, candidate_pairs};
use super::extent::Extents;
use super::filter::{Pair, dynamic_pair, excluded, explicit_pairs, masks_admit, parent_and_child};
use super::{Scratch, params, sweep};
use crate::geometry::pair;
use crate::model::{Fields, Model};
use labspec_finding::order;
use std::collections::BTreeSet;

/// What becomes of a pair of geoms.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum PairFilterReason {
    /// They can touch: they are looked at in every step.
    CanTouch,
    /// They belong to one body.
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
    /// Such shapes pass through each other.
    Shapes,
    /// They are out of reach of each other, wherever their joints are.
    OutOfReach,
}

impl PairFilterReason {
    /// Why such a pair never touches, in words; of one that can, that it can.
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

/// How many pairs of geoms meet each fate, each pair counted once; fates that none meets are not listed. What programs may write
/// keeps no pair apart.
pub fn pair_statistics(m: &Model, change: Changes) -> Vec<(PairFilterReason, usize)> {
    let extents = (!change.places && !change.params).then(|| Extents::new(m));
    let named: BTreeSet<[i32; 2]> = (0..m.npair).map(|p| ordered(m.pair_geom1[p], m.pair_geom2[p])).collect();
    let mut counts: Vec<(PairFilterReason, usize)> = Vec::new();
    for a in 0..m.ngeom {
        for b in a + 1..m.ngeom {
            let named = named.contains(&[a as i32, b as i32]);
            let mut reason = reason(m, a, b, change.bits, named);
            if reason == PairFilterReason::CanTouch && extents.as_ref().is_some_and(|e| apart(m, e, a, b)) {
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

/// Whether two geoms are out of reach of each other, by the pairs that name them as well.
fn apart(m: &Model, extents: &Extents, a: usize, b: usize) -> bool {
    let both = ordered(a as i32, b as i32);
    let of = |p: &Pair| ordered(p.geom1 as i32, p.geom2 as i32) == both;
    let mut pairs = explicit_pairs(m).filter(of).chain(dynamic_pair(m, a, b, true));
    pairs.all(|p| extents.keep_apart(m, &p, params::params(m, &p).reach))
}

fn ordered(a: i32, b: i32) -> [i32; 2] {
    [a.min(b), a.max(b)]
}

/// What becomes of two geoms; a pair that the model names asks for neither bits nor parents.
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

/// How the pairs that can touch are tested, by the types of their geoms: how many there are, and whether their contacts are
/// searched for by the general algorithm. Of a scene with too many pairs for a list, those at its start.
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

/// How many of the pairs of the plan have bounds within reach of each other where the geoms are now: the others cost one
/// comparison each.
pub fn in_reach(m: &Model, d: &Fields, w: &Scratch) -> usize {
    if let Some(sweep) = &w.pairs.sweep {
        return sweep.near.len();
    }
    let near = |pair: &&Pair| {
        let [g1, g2] = [pair.geom1 as usize, pair.geom2 as usize];
        !sweep::far_apart(m, d, g1, g2, params::params(m, pair).reach)
    };
    w.pairs.pairs.iter().filter(near).count()
}
