//! Which pairs of geoms can be in contact, and the order in which they are tested.

use crate::geometry::pair::{self, Method};
use crate::kinds::disable;
use crate::model::Model;
use crate::model::index::element_range;

/// Two geoms, ordered so that the first has the smaller type.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pair {
    pub(crate) geom1: u32,
    pub(crate) geom2: u32,
    /// The index of the explicit pair of these geoms; [`Pair::DYNAMIC`] if there is none.
    pub(crate) explicit: u32,
    /// The method that computes their contacts.
    pub(crate) method: Method,
}

impl Pair {
    /// Marks a pair without an explicit pair, which is filtered by bodies, contact bits and parents.
    pub(crate) const DYNAMIC: u32 = u32::MAX;

    /// Orders two geoms by type; the order of equal types is kept. Returns `None` if geoms of these types do not
    /// collide.
    fn for_geoms(m: &Model, a: usize, b: usize, explicit: u32) -> Option<Pair> {
        let (a, b) = if m.geom_type[a] <= m.geom_type[b] { (a, b) } else { (b, a) };
        let method = pair::method(m.geom_type[a], m.geom_type[b])?;
        Some(Pair { geom1: a as u32, geom2: b as u32, explicit, method })
    }

    /// Sort key: pairs are tested in the order of their bodies. For the same bodies, explicit pairs come first, in
    /// their own order. The others are ordered by geoms: by type with the midphase, by index without it.
    pub(super) fn order(&self, m: &Model) -> (i32, i32, u32, u32, u32) {
        let (g1, g2) = (self.geom1, self.geom2);
        let (b1, b2) = (m.geom_bodyid[g1 as usize], m.geom_bodyid[g2 as usize]);
        // Indexes of explicit pairs are smaller than DYNAMIC.
        let by_type = self.explicit == Pair::DYNAMIC && !m.opt.disabled(disable::MIDPHASE);
        let (first, second) = match self.explicit {
            Pair::DYNAMIC if by_type => (g1, g2),
            Pair::DYNAMIC => (g1.min(g2), g1.max(g2)),
            _ => (0, 0),
        };
        (b1.min(b2), b1.max(b2), self.explicit, first, second)
    }
}

/// Whether the contact bits of two geoms admit a contact. The bits can be written during a run.
pub fn can_collide(m: &Model, g1: usize, g2: usize) -> bool {
    (m.geom_contype[g1] & m.geom_conaffinity[g2]) | (m.geom_contype[g2] & m.geom_conaffinity[g1]) != 0
}

/// Whether the contact bits of two bodies admit contacts of their geoms. They are computed from the bits of the geoms
/// when the model is compiled, and change only if they are written themselves. Setting only the bits of a geom
/// therefore does not cause contacts (measured on MuJoCo 3.14.0: `tests/golden/switched.py`).
fn bodies_collide(m: &Model, b1: usize, b2: usize) -> bool {
    (m.body_contype[b1] & m.body_conaffinity[b2]) | (m.body_contype[b2] & m.body_conaffinity[b1]) != 0
}

/// Whether the midphase can find two geoms. The bounding volumes of bodies contain only the geoms that had contact
/// bits when the model was compiled. They are used if both bodies have such geoms, unless the midphase is disabled.
fn midphase_contains(m: &Model, g1: usize, g2: usize) -> bool {
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

/// Whether two bodies can be in contact: they are not welded to each other, at least one can move, and they are not
/// excluded.
pub(super) fn bodies_may_touch(m: &Model, b1: usize, b2: usize) -> bool {
    let (w1, w2) = (m.body_weldid[b1] as usize, m.body_weldid[b2] as usize);
    let moves = |w: usize| m.body_dofnum[w] > 0 || m.body_treeid[w] >= 0;
    w1 != w2 && (moves(w1) || moves(w2)) && !excluded(m, b1, b2)
}

/// Whether the model excludes contacts of two bodies (`exclude`).
pub(super) fn excluded(m: &Model, b1: usize, b2: usize) -> bool {
    m.exclude_bodies.binary_search(&[b1.min(b2) as i32, b1.max(b2) as i32]).is_ok()
}

/// Whether the parent filter excludes contacts of two geoms. Parent and child usually overlap by design. The filter
/// does not apply if the parent is fixed to the world.
pub(super) fn parent_and_child(m: &Model, g1: usize, g2: usize) -> bool {
    let weld = |g: usize| m.body_weldid[m.geom_bodyid[g] as usize] as usize;
    let above = |w: usize| m.body_weldid[m.body_parentid[w] as usize] as usize;
    let (w1, w2) = (weld(g1), weld(g2));
    !m.opt.disabled(disable::FILTERPARENT) && ((w1 != 0 && w1 == above(w2)) || (w2 != 0 && w2 == above(w1)))
}

/// The explicit pairs that can have contacts, in their order. Geoms that cannot move, and geoms of the same body,
/// have contacts like all others, but these have no effect. A model that consists only of the world body has no
/// contacts (measured on MuJoCo 3.14.0).
pub(super) fn explicit_pairs(m: &Model) -> impl Iterator<Item = Pair> + '_ {
    let pairs = if m.nbody > 1 { m.npair } else { 0 };
    (0..pairs).filter_map(move |p| {
        let (a, b) = (m.pair_geom1[p] as usize, m.pair_geom2[p] as usize);
        Pair::for_geoms(m, a, b, p as u32)
    })
}

/// The pair of two geoms, if they can ever be in contact. If `may_change` is set, contact bits and the parent filter
/// are ignored, because they can change later.
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

/// Whether two geoms can be in contact, through an explicit pair or by their bits and bodies.
pub fn may_touch(m: &Model, a: usize, b: usize) -> bool {
    let both = [a.min(b) as u32, a.max(b) as u32];
    let named = |p: Pair| [p.geom1.min(p.geom2), p.geom1.max(p.geom2)] == both;
    dynamic_pair(m, a, b, false).is_some() || explicit_pairs(m).any(named)
}

/// The first pair of geoms whose contacts need the general algorithm, whatever their contact bits, which can change.
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

/// Whether the current contact bits, including those of the bodies, and the parent filter admit a contact.
pub(super) fn admitted(m: &Model, g1: usize, g2: usize) -> bool {
    masks_admit(m, g1, g2) && !parent_and_child(m, g1, g2)
}

/// Whether the contact bits of two geoms and of their bodies, and the midphase, admit a contact.
pub(super) fn masks_admit(m: &Model, g1: usize, g2: usize) -> bool {
    can_collide(m, g1, g2)
        && bodies_collide(m, m.geom_bodyid[g1] as usize, m.geom_bodyid[g2] as usize)
        && midphase_contains(m, g1, g2)
}
