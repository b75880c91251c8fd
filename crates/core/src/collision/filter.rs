//! Which pairs of geoms can ever touch, decided once per plan from what cannot change.

use crate::{Model, disable};

/// Two geoms, ordered so that the first has the smaller type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Pair {
    pub(crate) geom1: u32,
    pub(crate) geom2: u32,
}

/// Whether the contact bits of two geoms admit a contact. They may be written while a lab runs.
#[inline]
pub fn can_collide(m: &Model, g1: usize, g2: usize) -> bool {
    (m.geom_contype[g1] & m.geom_conaffinity[g2]) | (m.geom_contype[g2] & m.geom_conaffinity[g1]) != 0
}

/// Whether two bodies can ever touch: not welded to each other, and at least one can move.
fn bodies_may_touch(m: &Model, b1: usize, b2: usize) -> bool {
    let (w1, w2) = (m.body_weldid[b1] as usize, m.body_weldid[b2] as usize);
    let moves = |w: usize| m.body_dofnum[w] > 0 || m.body_treeid[w] >= 0;
    w1 != w2 && (moves(w1) || moves(w2))
}

/// Whether the parent filter keeps two geoms apart: parent and child overlap on purpose, unless the parent is
/// fixed to the world.
#[inline]
pub(super) fn parent_and_child(m: &Model, g1: usize, g2: usize) -> bool {
    let weld = |g: usize| m.body_weldid[m.geom_bodyid[g] as usize] as usize;
    let above = |w: usize| m.body_weldid[m.body_parentid[w] as usize] as usize;
    let (w1, w2) = (weld(g1), weld(g2));
    !m.opt.disabled(disable::FILTERPARENT) && ((w1 != 0 && w1 == above(w2)) || (w2 != 0 && w2 == above(w1)))
}

/// All pairs that can ever touch, in the order of bodies, then geoms. Contact bits and the parent filter count
/// only when they may not change later.
pub(crate) fn candidate_pairs(m: &Model, may_change: bool) -> Vec<Pair> {
    let geoms = |b: usize| {
        let first = m.body_geomadr[b].max(0) as usize;
        first..first + m.body_geomnum[b] as usize
    };
    let mut out = Vec::new();
    for b1 in 0..m.nbody {
        if m.body_geomnum[b1] == 0 {
            continue;
        }
        for b2 in b1 + 1..m.nbody {
            if m.body_geomnum[b2] == 0 || !bodies_may_touch(m, b1, b2) {
                continue;
            }
            for g1 in geoms(b1) {
                for g2 in geoms(b2) {
                    let (a, b) = if m.geom_type[g1] <= m.geom_type[g2] { (g1, g2) } else { (g2, g1) };
                    let both_planes = m.geom_type[b] == crate::geom::PLANE;
                    if !both_planes && (may_change || admitted(m, a, b)) {
                        out.push(Pair { geom1: a as u32, geom2: b as u32 });
                    }
                }
            }
        }
    }
    out
}

/// Whether contact bits and the parent filter admit a contact now.
#[inline]
pub(super) fn admitted(m: &Model, g1: usize, g2: usize) -> bool {
    can_collide(m, g1, g2) && !parent_and_child(m, g1, g2)
}
