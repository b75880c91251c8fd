//! Which pairs of geoms may touch, and in which order they are tested.

use crate::geometry::pair::{self, Method};
use crate::kinds::disable;
use crate::model::Model;
use crate::model::index::element_range;

/// Two geoms, ordered so that the first has the smaller type.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pair {
    pub(crate) geom1: u32,
    pub(crate) geom2: u32,
    /// The explicit pair that names them, [`Pair::DYNAMIC`] if none.
    pub(crate) explicit: u32,
    /// How they are tested.
    pub(crate) method: Method,
}

impl Pair {
    /// No explicit pair: bodies, bits and parents decide.
    pub(crate) const DYNAMIC: u32 = u32::MAX;

    /// Geoms ordered by type; equal types stay as they are. `None` when such types pass through each other.
    fn for_geoms(m: &Model, a: usize, b: usize, explicit: u32) -> Option<Pair> {
        let (a, b) = if m.geom_type[a] <= m.geom_type[b] { (a, b) } else { (b, a) };
        let method = pair::method(m.geom_type[a], m.geom_type[b])?;
        Some(Pair { geom1: a as u32, geom2: b as u32, explicit, method })
    }

    /// Pairs are tested by bodies; for the same bodies explicit pairs come first, in their own order, the others by
    /// geoms: in the order of types, or without the midphase as the bodies have them.
    pub(super) fn order(&self, m: &Model) -> (i32, i32, u32, u32, u32) {
        let (g1, g2) = (self.geom1, self.geom2);
        let (b1, b2) = (m.geom_bodyid[g1 as usize], m.geom_bodyid[g2 as usize]);
        // Explicit numbers are smaller than DYNAMIC.
        let by_type = self.explicit == Pair::DYNAMIC && !m.opt.disabled(disable::MIDPHASE);
        let (first, second) = match self.explicit {
            Pair::DYNAMIC if by_type => (g1, g2),
            Pair::DYNAMIC => (g1.min(g2), g1.max(g2)),
            _ => (0, 0),
        };
        (b1.min(b2), b1.max(b2), self.explicit, first, second)
    }
}

/// Whether the contact bits of two geoms admit a contact. They may be written while a lab runs.
pub fn can_collide(m: &Model, g1: usize, g2: usize) -> bool {
    (m.geom_contype[g1] & m.geom_conaffinity[g2]) | (m.geom_contype[g2] & m.geom_conaffinity[g1]) != 0
}

/// Whether the contact bits of two bodies admit contacts of their geoms: those of their geoms when the model was compiled, unless
/// they are written. A geom whose bits are switched on alone touches nothing (measured on MuJoCo 3.14.0:
/// `tests/golden/switched.py`).
fn bodies_collide(m: &Model, b1: usize, b2: usize) -> bool {
    (m.body_contype[b1] & m.body_conaffinity[b2]) | (m.body_contype[b2] & m.body_conaffinity[b1]) != 0
}

/// Whether the bounding volumes of two bodies lead to two of their geoms: they were made of the geoms that had contact bits when the
/// model was compiled, and are looked at where both bodies have some, unless the midphase is off.
fn volumes_hold(m: &Model, g1: usize, g2: usize) -> bool {
    let visual = |g: usize| m.visual_geoms.binary_search(&(g as i32)).is_ok();
    let hold = |g: usize| {
        let b = m.geom_bodyid[g] as usize;
        (element_range(m.body_geomadr[b], m.body_geomnum[b])).any(|other| !visual(other))
    };
    m.visual_geoms.is_empty()
        || m.opt.disabled(disable::MIDPHASE)
        || !(visual(g1) || visual(g2))
        || !(hold(g1) && hold(g2))
}

/// Whether two bodies can ever touch: not welded to each other, and at least one can move.
pub(super) fn bodies_may_touch(m: &Model, b1: usize, b2: usize) -> bool {
    let (w1, w2) = (m.body_weldid[b1] as usize, m.body_weldid[b2] as usize);
    let moves = |w: usize| m.body_dofnum[w] > 0 || m.body_treeid[w] >= 0;
    w1 != w2 && (moves(w1) || moves(w2)) && !excluded(m, b1, b2)
}

/// Whether the model keeps two bodies apart.
pub(super) fn excluded(m: &Model, b1: usize, b2: usize) -> bool {
    m.exclude_bodies.binary_search(&[b1.min(b2) as i32, b1.max(b2) as i32]).is_ok()
}

/// Whether the parent filter keeps two geoms apart: parent and child overlap on purpose, unless the parent is
/// fixed to the world.
pub(super) fn parent_and_child(m: &Model, g1: usize, g2: usize) -> bool {
    let weld = |g: usize| m.body_weldid[m.geom_bodyid[g] as usize] as usize;
    let above = |w: usize| m.body_weldid[m.body_parentid[w] as usize] as usize;
    let (w1, w2) = (weld(g1), weld(g2));
    !m.opt.disabled(disable::FILTERPARENT) && ((w1 != 0 && w1 == above(w2)) || (w2 != 0 && w2 == above(w1)))
}

/// The explicit pairs that can make contacts, in their order. Geoms that do not move, and geoms of one body, make contacts
/// like all others, without effect; a model of the world alone has none (measured on MuJoCo 3.14.0).
pub(super) fn explicit_pairs(m: &Model) -> impl Iterator<Item = Pair> + '_ {
    let pairs = if m.nbody > 1 { m.npair } else { 0 };
    (0..pairs).filter_map(move |p| {
        let (a, b) = (m.pair_geom1[p] as usize, m.pair_geom2[p] as usize);
        Pair::for_geoms(m, a, b, p as u32)
    })
}

/// Two geoms as a pair, when they can ever touch. Contact bits and the parent filter count only when they may not
/// change later.
pub(super) fn dynamic_pair(m: &Model, a: usize, b: usize, may_change: bool) -> Option<Pair> {
    let (ba, bb) = (m.geom_bodyid[a] as usize, m.geom_bodyid[b] as usize);
    if ba == bb || !(may_change || admitted(m, a, b)) || !bodies_may_touch(m, ba, bb) {
        return None;
    }
    let named = |p: usize| {
        let (x, y) = (m.pair_geom1[p] as usize, m.pair_geom2[p] as usize);
        (x, y) == (a, b) || (x, y) == (b, a)
    };
    let pair = Pair::for_geoms(m, a, b, Pair::DYNAMIC)?;
    (!(0..m.npair).any(named)).then_some(pair)
}

/// Whether two geoms can make contacts, by an explicit pair or by their bits and bodies.
pub fn may_touch(m: &Model, a: usize, b: usize) -> bool {
    let both = [a.min(b) as u32, a.max(b) as u32];
    let named = |p: Pair| [p.geom1.min(p.geom2), p.geom1.max(p.geom2)] == both;
    dynamic_pair(m, a, b, false).is_some() || explicit_pairs(m).any(named)
}

/// Two geoms whose contacts the general algorithm would have to find, whatever their contact bits, which may change.
pub fn searched_pair(m: &Model) -> Option<[usize; 2]> {
    let searched = |a: usize, b: usize| pair::is_searched(m.geom_type[a], m.geom_type[b], false);
    if let Some(p) = explicit_pairs(m).find(|p| searched(p.geom1 as usize, p.geom2 as usize)) {
        return Some([p.geom1 as usize, p.geom2 as usize]);
    }
    let bodies = |a: usize, b: usize| [m.geom_bodyid[a] as usize, m.geom_bodyid[b] as usize];
    let may = |a: usize, b: usize| {
        let [ba, bb] = bodies(a, b);
        ba != bb && searched(a, b) && bodies_may_touch(m, ba, bb)
    };
    (0..m.ngeom).find_map(|a| (a + 1..m.ngeom).find(|&b| may(a, b)).map(|b| [a, b]))
}

/// Whether contact bits, those of bodies as well, and the parent filter admit a contact now.
pub(super) fn admitted(m: &Model, g1: usize, g2: usize) -> bool {
    masks_admit(m, g1, g2) && !parent_and_child(m, g1, g2)
}

/// Whether the contact bits of two geoms and of their bodies admit a contact.
pub(super) fn masks_admit(m: &Model, g1: usize, g2: usize) -> bool {
    can_collide(m, g1, g2)
        && bodies_collide(m, m.geom_bodyid[g1] as usize, m.geom_bodyid[g2] as usize)
        && volumes_hold(m, g1, g2)
}
