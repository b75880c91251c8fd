//! Islands: kinematic trees that constraints tie together. Each is a problem of its own.
//!
//! Connected components by union-find with path halving (Tarjan and van Leeuwen 1984).

use crate::{Data, Model, disable};

/// Which constraints and trees belong together. Lists are grouped by island, ascending within.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Islands {
    /// Trees, island after island; then those that no constraint touches.
    pub(super) trees: Vec<u32>,
    /// First entry of each island in `trees`, and the end of the last.
    pub(super) tree_start: Vec<u32>,
    /// Blocks of the Jacobian, island after island.
    pub(super) blocks: Vec<u32>,
    /// First entry of each island in `blocks`, and the end of the last.
    pub(super) block_start: Vec<u32>,
    /// Per tree: parent in the forest of the union-find.
    link: Vec<u32>,
    /// Per tree: its island, or [`NONE`].
    island: Vec<u32>,
}

/// No constraint touches the tree.
const NONE: u32 = u32::MAX;
/// A constraint touches the tree; its island has no number yet.
const TOUCHED: u32 = u32::MAX - 1;

fn root(link: &mut [u32], mut i: usize) -> usize {
    while link[i] as usize != i {
        link[i] = link[link[i] as usize];
        i = link[i] as usize;
    }
    i
}

/// Groups the blocks of the Jacobian; `nisland`. Islands are numbered by their first tree.
pub(super) fn find(m: &Model, d: &mut Data) {
    let (w, jac) = (&mut d.work.islands, &d.work.jac);
    w.link.clear();
    w.link.extend(0..m.ntree as u32);
    w.island.clear();
    let together = m.opt.disabled(disable::ISLAND);
    w.island.resize(m.ntree, if together { 0 } else { NONE });
    let tree_of = |c: u32| m.dof_treeid[c as usize] as usize;

    let mut n = 1;
    if !together {
        for b in &jac.blocks {
            let cols = jac.columns(b);
            let (Some(&first), Some(&last)) = (cols.first(), cols.last()) else { continue };
            let t = tree_of(first);
            w.island[t] = TOUCHED;
            if t != tree_of(last) {
                for &c in cols {
                    let (a, b) = (root(&mut w.link, t), root(&mut w.link, tree_of(c)));
                    w.link[a.max(b)] = a.min(b) as u32;
                    w.island[tree_of(c)] = TOUCHED;
                }
            }
        }
        // A root is the smallest tree of its island, so it is numbered before the others ask.
        n = 0;
        for t in 0..m.ntree {
            if w.island[t] == TOUCHED {
                let r = root(&mut w.link, t);
                if r == t {
                    w.island[t] = n;
                    n += 1;
                } else {
                    w.island[t] = w.island[r];
                }
            }
        }
    }
    d.nisland = n as usize;
    let n = n as usize;
    let island = &w.island;
    let of_tree = |t: usize| (island[t] as usize).min(n);
    let of_block = |b: usize| jac.columns(&jac.blocks[b]).first().map_or(n, |&c| of_tree(tree_of(c)));
    group(&mut w.trees, &mut w.tree_start, n, m.ntree, of_tree);
    group(&mut w.blocks, &mut w.block_start, n, jac.blocks.len(), of_block);
}

/// Sorts 0..count by group, keeping their order; `start[g]` is the first of group g, `start[groups]` the end
/// of the last group. Items of group `groups` follow.
fn group(items: &mut Vec<u32>, start: &mut Vec<u32>, groups: usize, count: usize, of: impl Fn(usize) -> usize) {
    start.clear();
    start.resize(groups + 2, 0);
    for i in 0..count {
        start[of(i) + 1] += 1;
    }
    for g in 0..=groups {
        start[g + 1] += start[g];
    }
    items.resize(count, 0);
    for i in 0..count {
        let at = &mut start[of(i)];
        items[*at as usize] = i as u32;
        *at += 1;
    }
    // Each start has moved to its group's end: shift back.
    for g in (1..=groups + 1).rev() {
        start[g] = start[g - 1];
    }
    start[0] = 0;
    start.truncate(groups + 1);
}

#[cfg(test)]
mod tests {
    use super::group;

    #[test]
    fn groups_keep_order_and_leave_the_rest_behind() {
        let of = [2, 0, 1, 0, 3, 2, 1];
        let (mut items, mut start) = (Vec::new(), Vec::new());
        group(&mut items, &mut start, 3, of.len(), |i| of[i]);
        assert_eq!(items, [1, 3, 2, 6, 0, 5, 4]);
        assert_eq!(start, [0, 2, 4, 6]);
        group(&mut items, &mut start, 0, 0, |_| 0);
        assert_eq!((items.len(), start), (0, vec![0]));
    }
}
