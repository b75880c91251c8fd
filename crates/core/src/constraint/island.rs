//! Islands: kinematic trees that constraints tie together. Each is a problem of its own.
//!
//! Connected components by union-find with path halving (Tarjan and van Leeuwen 1984).

use super::jacobian::Jacobian;
use crate::{Model, disable};

/// Which constraints and trees belong together.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Islands {
    /// Trees of each island, ascending.
    pub(super) trees: Lists,
    /// Blocks of the Jacobian of each island, ascending.
    pub(super) blocks: Lists,
    /// Per tree: parent in the forest of the union-find.
    link: Vec<u32>,
    /// Per tree: its island, or [`NONE`].
    island: Vec<u32>,
    /// What the lists were made from: the end of each block's columns, all columns, and whether islands are
    /// switched off.
    ends: Vec<u32>,
    columns: Vec<u32>,
    together: bool,
    /// Number of islands.
    count: usize,
}

/// Several lists of small numbers, each number in at most one of them.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Lists {
    /// Per list: first and last item.
    ends: Vec<[u32; 2]>,
    /// Per item: the next of its list.
    next: Vec<u32>,
}

impl Lists {
    fn clear(&mut self, lists: usize, items: usize) {
        self.ends.resize(lists.max(self.ends.len()), [NONE; 2]);
        self.ends[..lists].fill([NONE; 2]);
        self.next.resize(items.max(self.next.len()), NONE);
    }

    #[inline(always)]
    fn push(&mut self, list: usize, item: usize) {
        let [first, last] = &mut self.ends[list];
        if *first == NONE {
            *first = item as u32;
        } else {
            self.next[*last as usize] = item as u32;
        }
        *last = item as u32;
        self.next[item] = NONE;
    }

    /// The items of a list, in the order in which they came.
    #[inline(always)]
    pub(super) fn of(&self, list: usize) -> impl Iterator<Item = usize> + Clone + use<'_> {
        let mut at = self.ends[list][0];
        std::iter::from_fn(move || {
            let item = at;
            (item != NONE).then(|| {
                at = self.next[item as usize];
                item as usize
            })
        })
    }
}

/// No island, no item.
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

impl Islands {
    /// The trees of an island, ascending.
    pub(crate) fn trees_of(&self, island: usize) -> impl Iterator<Item = usize> + Clone + use<'_> {
        self.trees.of(island)
    }

    /// Whether some constraint touches a tree.
    pub(crate) fn has(&self, tree: usize) -> bool {
        self.island.get(tree).is_some_and(|&island| island != NONE)
    }

    /// Groups the blocks of the Jacobian; returns the number of islands, which are numbered by their first
    /// tree. Nothing is done while the blocks have the columns that they had at the last step.
    pub(super) fn find(&mut self, m: &Model, jac: &Jacobian) -> usize {
        let together = m.opt.disabled(disable::ISLAND);
        if self.together == together && jac.same_columns(&self.ends, &self.columns) {
            return self.count;
        }
        jac.copy_columns(&mut self.ends, &mut self.columns);
        self.together = together;
        let tree_of = |c: u32| m.dof_treeid[c as usize] as usize;
        self.island.resize(m.ntree, NONE);
        self.island.fill(if together { 0 } else { NONE });
        self.count = if together { 1 } else { self.number(m, jac) };

        self.trees.clear(self.count, m.ntree);
        for t in 0..m.ntree {
            if self.island[t] != NONE {
                self.trees.push(self.island[t] as usize, t);
            }
        }
        self.blocks.clear(self.count, jac.blocks.len());
        for (i, b) in jac.blocks.iter().enumerate() {
            if let Some(&c) = jac.columns(b).first() {
                self.blocks.push(self.island[tree_of(c)] as usize, i);
            }
        }
        self.count
    }

    /// Gives each touched tree the number of its island; returns how many there are.
    fn number(&mut self, m: &Model, jac: &Jacobian) -> usize {
        self.link.clear();
        self.link.extend(0..m.ntree as u32);
        for b in &jac.blocks {
            let mut previous = None;
            for &c in jac.columns(b) {
                let t = m.dof_treeid[c as usize] as usize;
                self.island[t] = TOUCHED;
                if let Some(p) = previous.replace(t) {
                    let (a, b) = (root(&mut self.link, p), root(&mut self.link, t));
                    self.link[a.max(b)] = a.min(b) as u32;
                }
            }
        }
        // A root is the smallest tree of its island, so it is numbered before the others ask.
        let mut n = 0;
        for t in 0..m.ntree {
            if self.island[t] == TOUCHED {
                let r = root(&mut self.link, t);
                if r == t {
                    self.island[t] = n;
                    n += 1;
                } else {
                    self.island[t] = self.island[r];
                }
            }
        }
        n as usize
    }
}

#[cfg(test)]
mod tests {
    use super::Lists;

    #[test]
    fn lists_keep_order_and_can_be_reused() {
        let mut lists = Lists::default();
        for of in [vec![2, 0, 1, 0, 3, 2, 1], vec![0, 0, 1]] {
            lists.clear(4, of.len());
            for (item, &list) in of.iter().enumerate() {
                lists.push(list, item);
            }
            for list in 0..4 {
                let expected: Vec<usize> = (0..of.len()).filter(|&i| of[i] == list).collect();
                assert_eq!(lists.of(list).collect::<Vec<_>>(), expected);
            }
        }
    }
}
