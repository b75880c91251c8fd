//! Waking sleeping trees.

use super::{AWAKE, SleepScratch, coordinates, rest, update};
use crate::kinds::eqtype;
use crate::model::asleep::{on, some};
use crate::model::{Fields, Model};

/// Wakes the trees that the user changed since the last position stage: their positions, applied forces or velocities.
pub(crate) fn wake(m: &Model, d: &mut Fields, w: &mut SleepScratch) {
    if some(m, d) {
        let allowed = on(m, d);
        for tree in 0..m.ntree {
            if d.tree_asleep[tree] >= 0
                && (!allowed || was_moved(m, d, w, tree) || !rest::may_fall_asleep(m, d, tree, 0.0))
            {
                wake_island(d, tree, AWAKE);
            }
        }
        update(m, d);
    }
    if on(m, d) {
        w.seen.copy_from_slice(&d.qpos);
    }
}

/// Wakes trees that a tendon at its limit connects to an awake tree.
pub(crate) fn wake_by_tendons(m: &Model, d: &mut Fields) {
    if !some(m, d) {
        return;
    }
    for t in (0..m.ntendon).filter(|&t| m.tendon_treenum[t] == 2) {
        // A stored model may count two trees and name fewer. Such a tendon connects nothing.
        let [Ok(a), Ok(b)] = [m.tendon_treeid[2 * t], m.tendon_treeid[2 * t + 1]].map(usize::try_from) else {
            continue;
        };
        let length = d.ten_length[t];
        let [lower, upper] = [m.tendon_range[2 * t], m.tendon_range[2 * t + 1]];
        let margin = m.tendon_margin[t];
        if m.tendon_limited[t] && (length < lower + margin || length > upper - margin) {
            wake_one(d, [a, b]);
        }
    }
    update(m, d);
}

/// Wakes trees that touch an awake body. Returns `true` if there are any, because these may touch others.
pub(crate) fn wake_touched(m: &Model, d: &mut Fields) -> bool {
    if !some(m, d) {
        return false;
    }
    let before = d.ntree_awake;
    for c in 0..d.contact.len() {
        let bodies = [d.contact[c].geom1, d.contact[c].geom2].map(|g| m.geom_bodyid[g] as usize);
        match bodies.map(|body| usize::try_from(m.body_treeid[body]).ok()) {
            [Some(a), Some(b)] => wake_one(d, [a, b]),
            // A mocap body.
            [Some(tree), None] | [None, Some(tree)] if d.tree_awake[tree] == 0 => wake_island(d, tree, AWAKE),
            _ => {}
        }
    }
    update(m, d);
    d.ntree_awake > before
}

/// Wakes trees that an equality connects to an awake tree, or to a tree of another sleep cycle.
pub(crate) fn wake_by_equalities(m: &Model, d: &mut Fields) {
    if !some(m, d) {
        return;
    }
    for e in 0..m.neq {
        let Some([a, b]) = trees_of_equality(m, e).filter(|_| d.eq_active[e]) else { continue };
        let asleep = [d.tree_awake[a] == 0, d.tree_awake[b] == 0];
        if a != b && asleep != [false, false] && (asleep != [true, true] || !fell_asleep_together(d, a, b)) {
            for (tree, _) in [a, b].into_iter().zip(asleep).filter(|&(_, asleep)| asleep) {
                wake_island(d, tree, AWAKE);
            }
        }
    }
    update(m, d);
}

/// If exactly one of two trees sleeps, wakes it, and copies the count of slow steps from the other.
fn wake_one(d: &mut Fields, [a, b]: [usize; 2]) {
    match (d.tree_awake[a] != 0, d.tree_awake[b] != 0) {
        (true, false) => wake_island(d, b, d.tree_asleep[a]),
        (false, true) => wake_island(d, a, d.tree_asleep[b]),
        _ => {}
    }
}

/// The two trees that an equality connects, or `None` if one side cannot move.
fn trees_of_equality(m: &Model, e: usize) -> Option<[usize; 2]> {
    let body = |list: &[i32], id: i32| Some(*list.get(usize::try_from(id).ok()?)? as usize);
    let sides = [m.eq_obj1id[e], m.eq_obj2id[e]].map(|id| match m.eq_type[e] {
        eqtype::CONNECT | eqtype::WELD if m.eq_objtype[e] == crate::model::Obj::Body as i32 => {
            usize::try_from(id).ok()
        }
        eqtype::CONNECT | eqtype::WELD => body(&m.site_bodyid, id),
        eqtype::JOINT => body(&m.jnt_bodyid, id),
        _ => None,
    });
    let [a, b] = sides.map(|body| usize::try_from(m.body_treeid[body?]).ok());
    Some([a?, b?])
}

/// Whether the coordinates of a tree differ from those of the last position stage.
fn was_moved(m: &Model, d: &Fields, w: &SleepScratch, tree: usize) -> bool {
    let of_tree = coordinates(m, tree);
    d.qpos[of_tree.clone()] != w.seen[of_tree]
}

/// Wakes a tree and those that fell asleep with it. A tree that is already awake continues to count from `value` if that is
/// smaller.
///
/// A written `tree_asleep` may contain any number, so that the walk makes no assumptions: every tree that it visits is awake
/// afterwards, and it ends at the first tree that is already awake.
fn wake_island(d: &mut Fields, tree: usize, value: i32) {
    let value = if value < 0 { value } else { AWAKE };
    let mut current = tree;
    while let Some(slot) = d.tree_asleep.get_mut(current) {
        let next = *slot;
        *slot = next.min(value);
        match usize::try_from(next) {
            Ok(next) => current = next,
            Err(_) => return,
        }
    }
}

/// Whether two sleeping trees fell asleep together.
fn fell_asleep_together(d: &Fields, a: usize, b: usize) -> bool {
    let mut current = a;
    for _ in 0..d.tree_asleep.len() {
        match d.tree_asleep.get(current).map(|&next| usize::try_from(next)) {
            Some(Ok(next)) if next == b => return true,
            Some(Ok(next)) => current = next,
            _ => return false,
        }
    }
    false
}
