//! Falling asleep, and keeping the state and the results of sleeping trees.

use super::{AWAKE, SleepScratch, coordinates};
use crate::constraint::Islands;
use crate::kinds::disable;
use crate::model::asleep::{self, on, policy, some};
use crate::model::index::element_range;
use crate::model::{Fields, Model};

/// Whether the policy of a tree allows sleep.
fn may_sleep(m: &Model, tree: usize) -> bool {
    !matches!(m.tree_sleep_policy[tree], policy::AUTO_NEVER | policy::NEVER)
}

/// Whether a tree may sleep, no force is applied to it, and it is slower than `tolerance`. For a tolerance of 0, its velocity
/// must be zero.
pub(super) fn may_fall_asleep(m: &Model, d: &Fields, tree: usize, tolerance: f64) -> bool {
    // A negative zero counts as an applied force, because it was written explicitly.
    let zero = |list: &[f64]| list.iter().all(|x| x.to_bits() == 0);
    let first = 6 * m.tree_bodyadr[tree] as usize;
    let pushed = &d.xfrc_applied[first..first + 6 * m.tree_bodynum[tree] as usize];
    let dofs = m.tree_dofs(tree);
    let slow = |k: usize| m.dof_length[k] * d.qvel[k].abs() < tolerance;
    may_sleep(m, tree)
        && zero(pushed)
        && zero(&d.qfrc_applied[dofs.clone()])
        && if tolerance == 0.0 { zero(&d.qvel[dofs]) } else { dofs.into_iter().all(slow) }
}

/// Resets sleeping trees after a step: their positions are those in `start`, and their velocities are zero.
pub(crate) fn freeze_sleeping_trees(m: &Model, d: &mut Fields, start: &[f64]) {
    for tree in (0..m.ntree).filter(|&t| d.tree_awake[t] == 0) {
        d.qvel[m.tree_dofs(tree)].fill(0.0);
        let q = coordinates(m, tree);
        d.qpos[q.clone()].copy_from_slice(&start[q]);
    }
}

/// Counts the steps in which trees were slow, and stops those that fall asleep: islands in which all trees have been
/// slow for long enough. Returns `true` if there are any; fields that depend on their velocities must then be computed again.
pub(crate) fn fall_asleep(m: &Model, d: &mut Fields, islands: &Islands) -> bool {
    if d.nefc > 0 && m.opt.disabled(disable::ISLAND) {
        // Without islands, it is not known which trees are connected by constraints.
        return false;
    }
    for tree in 0..m.ntree {
        if d.tree_asleep[tree] < 0 {
            let still = may_fall_asleep(m, d, tree, m.opt.sleep_tolerance);
            d.tree_asleep[tree] = if still { (d.tree_asleep[tree] + 1).min(-1) } else { AWAKE };
        }
    }
    let mut slept = false;
    for island in 0..d.nisland {
        let ready = islands.trees_of(island).all(|tree| d.tree_asleep[tree] == -1);
        slept |= ready && put_island_to_sleep(m, d, islands.trees_of(island));
    }
    for tree in 0..m.ntree {
        let alone = d.nisland == 0 || !islands.has(tree);
        slept |= alone && d.tree_asleep[tree] == -1 && put_island_to_sleep(m, d, std::iter::once(tree));
    }
    slept
}

/// Stops the trees of an island and links each to the next, cyclically. Returns `true` if there are any.
fn put_island_to_sleep(m: &Model, d: &mut Fields, trees: impl Iterator<Item = usize> + Clone) -> bool {
    let next = trees.clone().cycle().skip(1);
    let mut some = false;
    for (tree, next) in trees.zip(next) {
        d.tree_asleep[tree] = next as i32;
        d.qvel[m.tree_dofs(tree)].fill(0.0);
        some = true;
    }
    some
}

/// Saves the results of sleeping trees before the stages overwrite them.
pub(crate) fn keep(m: &Model, d: &Fields, w: &mut SleepScratch) {
    if some(m, d) && on(m, d) {
        w.qfrc_smooth.copy_from_slice(&d.qfrc_smooth);
        w.qacc_smooth.copy_from_slice(&d.qacc_smooth);
        w.act_dot.copy_from_slice(&d.act_dot);
    }
}

/// Restores the saved results of sleeping trees before constraints are solved.
pub(crate) fn put_back(m: &Model, d: &mut Fields, w: &SleepScratch) {
    if !some(m, d) || !on(m, d) {
        return;
    }
    for tree in (0..m.ntree).filter(|&t| d.tree_awake[t] == 0) {
        let k = m.tree_dofs(tree);
        d.qfrc_smooth[k.clone()].copy_from_slice(&w.qfrc_smooth[k.clone()]);
        d.qacc_smooth[k.clone()].copy_from_slice(&w.qacc_smooth[k]);
    }
    for i in 0..m.nactuator {
        if asleep::actuator(m, d, i) {
            let states = element_range(m.actuator_actadr[i], m.actuator_actnum[i]);
            d.act_dot[states.clone()].copy_from_slice(&w.act_dot[states]);
        }
    }
}
