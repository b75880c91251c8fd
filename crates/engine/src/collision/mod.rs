//! Collision detection: pairs of geoms in contact, the contact points, and the contact parameters.

mod candidates;
mod extent;
mod filter;
mod pair_statistics;
mod params;
mod primitive;
mod reach;
mod sweep;

pub(crate) use candidates::{Changes, MOST_LISTED, candidate_pairs};
pub(crate) use extent::FIELDS as PLACES;
use filter::Pair;
pub use filter::searched_pair;
pub use filter::{can_collide, may_touch};
pub use pair_statistics::PairFilterReason;
pub use pair_statistics::{in_reach, pair_methods, pair_statistics};
use params::Params;
use reach::Spheres;
use sweep::Sweep;

use crate::geometry::{Narrow, Shape, pair};
use crate::kinds::geom;
use crate::math::*;
use crate::model::{Fields, Model, Warning, asleep};

/// Scratch memory of the collision stage.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CollisionScratch {
    /// Pairs of geoms to test.
    pub(crate) pairs: CandidatePairs,
    /// Buffers for the contacts of one pair.
    narrow: Narrow,
}

/// The pairs that a plan tests, with their contact parameters if these cannot change.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct CandidatePairs {
    pairs: Vec<Pair>,
    params: Vec<Params>,
    /// Bounding spheres of the pairs with fixed parameters, except for pairs of spheres and pairs with an unbounded geom.
    spheres: Spheres,
    /// Whether filters are evaluated at every step, because the fields that they depend on may be written.
    filter: bool,
    /// Replaces the list if it would have too many pairs: finds the near pairs at every step.
    sweep: Option<Box<Sweep>>,
}

/// Selects the pairs to test. If contact bits and flags may be written later, these are all pairs that can ever be in
/// contact; otherwise the pairs that the current bits and flags admit.
pub(crate) fn pairs(m: &Model, change: Changes) -> CandidatePairs {
    let pairs = candidate_pairs(m, change);
    if pairs.len() > MOST_LISTED {
        let sweep = Some(Box::new(Sweep::new(m, change.bits)));
        return CandidatePairs { sweep, ..CandidatePairs::default() };
    }
    let mut list = CandidatePairs { pairs, filter: change.bits, ..CandidatePairs::default() };
    if !change.params {
        list.params = list.pairs.iter().map(|p| params::params(m, p)).collect();
        let limit = |(pair, params): (&Pair, &Params)| {
            let [a, b] = [pair.geom1, pair.geom2].map(|g| g as usize);
            let both = m.geom_rbound[a] > 0.0 && m.geom_rbound[b] > 0.0;
            let spheres = m.geom_type[a] == geom::SPHERE && m.geom_type[b] == geom::SPHERE;
            let limit = m.geom_rbound[a] + m.geom_rbound[b] + params.reach;
            if both && !spheres { limit * limit } else { f64::INFINITY }
        };
        let limits: Vec<f64> = list.pairs.iter().zip(&list.params).map(limit).collect();
        list.spheres = Spheres::new(&list.pairs, &limits);
    }
    list
}

/// Maximum number of contacts. Further contacts are dropped with a warning.
pub(crate) const MOST_CONTACTS: usize = 1 << 16;

/// `contact`, `ncon`: tests the pairs of the plan in order.
#[inline(never)]
pub(crate) fn collide(m: &Model, d: &mut Fields, w: &mut CollisionScratch) {
    d.contact.clear();
    let CollisionScratch { pairs: list, narrow: work } = w;
    if let Some(sweep) = &mut list.sweep {
        let cost = sweep.run(m, d);
        d.meter.add(cost);
        for pair in &sweep.near {
            if d.contact.len() > MOST_CONTACTS || d.meter.over() {
                break;
            }
            if !asleep::pair(m, d, pair.geom1 as usize, pair.geom2 as usize) {
                narrow_mixed(m, d, work, pair);
            }
        }
    }
    if list.params.is_empty() {
        for pair in &list.pairs {
            if !list.excludes(m, d, pair) {
                narrow_mixed(m, d, work, pair);
            }
        }
    }
    list.spheres.compare(rows(&d.geom_xpos));
    for word in 0..list.spheres.word_count() {
        let [near, others] = list.spheres.take(word);
        let mut left = near | others;
        while left != 0 {
            let k = left.trailing_zeros() as usize;
            left &= left - 1;
            let (pair, params) = (&list.pairs[64 * word + k], &list.params[64 * word + k]);
            if list.excludes(m, d, pair) {
                continue;
            }
            if near >> k & 1 == 0 {
                narrow(m, d, work, pair, params);
            } else if !d.meter.over() {
                general(m, d, work, pair, params);
            }
        }
    }
    let looked_at = 8 * list.pairs.len() + 100 * d.contact.len();
    d.meter.add(looked_at as u64);
    if d.contact.len() > MOST_CONTACTS {
        d.contact.truncate(MOST_CONTACTS);
        d.warn(Warning::ContactFull, MOST_CONTACTS);
    }
    d.ncon = d.contact.len();
}

/// Whether the current contact filters exclude a pair.
#[cfg_attr(not(feature = "small"), inline(never))]
fn is_filtered(m: &Model, pair: &Pair) -> bool {
    pair.explicit == Pair::DYNAMIC && !filter::admitted(m, pair.geom1 as usize, pair.geom2 as usize)
}

/// Clears the contacts, for models with contacts disabled.
pub(crate) fn none(d: &mut Fields) {
    d.contact.clear();
    d.ncon = 0;
}

impl CandidatePairs {
    /// Whether contact filters or sleep exclude a pair of the list.
    #[cfg_attr(not(feature = "small"), inline(always))]
    fn excludes(&self, m: &Model, d: &Fields, pair: &Pair) -> bool {
        let [g1, g2] = [pair.geom1 as usize, pair.geom2 as usize];
        self.filter && is_filtered(m, pair) || asleep::pair(m, d, g1, g2)
    }
}

/// The exact test of a pair whose parameters may have been written.
#[inline(never)]
fn narrow_mixed(m: &Model, d: &mut Fields, work: &mut Narrow, pair: &Pair) {
    narrow(m, d, work, pair, &params::params(m, pair));
}

/// The exact test of a pair whose bounds have not been compared yet. Spheres, the most common case, take a shortcut.
#[inline(never)]
fn narrow(m: &Model, d: &mut Fields, work: &mut Narrow, pair: &Pair, params: &Params) {
    let (g1, g2) = (pair.geom1 as usize, pair.geom2 as usize);
    // If only the size of a sphere was written and not `geom_rbound`, contacts are searched within the old bounding
    // sphere, as in MuJoCo. Such a sphere cannot take the shortcut.
    let bounded = |g: usize| m.geom_rbound[g] == m.geom_size[3 * g];
    let touch = match (m.geom_type[g1], m.geom_type[g2]) {
        (geom::PLANE, geom::SPHERE) if bounded(g2) => primitive::plane_sphere(m, d, g1, g2, params.reach),
        (geom::SPHERE, geom::SPHERE) if bounded(g1) && bounded(g2) => {
            primitive::sphere_sphere(m, d, g1, g2, params.reach)
        }
        _ if sweep::out_of_reach(m, d, g1, g2, params.reach) || d.meter.over() => None,
        _ => return general(m, d, work, pair, params),
    };
    if let Some(t) = touch {
        d.contact.push(params::contact(params, g1, g2, &t, frame(t.normal)));
    }
}

/// The exact test of a pair of any types.
#[inline(never)]
fn general(m: &Model, d: &mut Fields, work: &mut Narrow, pair: &Pair, params: &Params) {
    let (g1, g2) = (pair.geom1 as usize, pair.geom2 as usize);
    work.touches.clear();
    (work.convex.cost, work.convex.most) = (0, Some(d.meter.left()));
    let (a, b) = (Shape::geom(m, d, g1), Shape::geom(m, d, g2));
    pair::contacts(
        pair.method,
        &a,
        &b,
        params.reach,
        || pair::PairSettings::from_model(m),
        &mut work.convex,
        &mut work.touches,
    );
    for t in &work.touches {
        d.contact.push(params::contact(params, g1, g2, t, frame_along(t.normal, t.tangent)));
    }
    d.meter.add(100 + work.convex.cost);
}

#[cfg(test)]
mod tests;
