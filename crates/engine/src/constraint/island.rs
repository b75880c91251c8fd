//! Islands: sets of kinematic trees connected by constraints. Each is a separate problem.
//!
//! They are the connected components, found by union-find with path halving (Tarjan and van Leeuwen 1984).

use super::jacobian::ConstraintJacobian;
use crate::kinds::disable;
use crate::model::Model;
use std::ops::Range;

/// The constraints and trees of each island.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Islands {
    /// Trees of each island, ascending.
    pub(super) trees: Lists,
    /// Blocks of the Jacobian of each island, ascending.
    pub(super) blocks: Lists,
    /// Degrees of freedom of all islands; those of consecutive trees form one range.
    runs: Vec<Range<usize>>,
    /// The end of the ranges of each island in `runs`.
    run_ends: Vec<usize>,
    /// For each tree, its parent in the union-find forest.
    link: Vec<u32>,
    /// For each tree, its island, or [`NONE`].
    island: Vec<u32>,
    /// The inputs of the lists: the end of the columns of each block, all columns, and whether islands are disabled.
    ends: Vec<u32>,
    columns: Vec<u32>,
    together: bool,
    /// Number of islands, and the count of searches. Data derived from islands stay valid while this count does not
    /// change.
    count: usize,
    pub(super) found: u64,
}

/// Several lists of small integers in one array.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Lists {
    /// The items of all lists in order, and the start of each list.
    items: Vec<u32>,
    begin: Vec<usize>,
}

impl Lists {
    /// Fills the lists with items, each given with the index of its list. The order of items is preserved.
    fn fill(&mut self, lists: usize, items: impl Iterator<Item = (u32, usize)> + Clone) {
        self.begin.clear();
        self.begin.resize(lists + 2, 0);
        for (list, _) in items.clone() {
            self.begin[list as usize + 2] += 1;
        }
        for list in 0..lists {
            self.begin[list + 2] += self.begin[list + 1];
        }
        self.items.resize(self.begin[lists + 1], 0);
        for (list, item) in items {
            let end = &mut self.begin[list as usize + 1];
            self.items[*end] = item as u32;
            *end += 1;
        }
    }

    /// The number of items of a list.
    pub(super) fn len(&self, list: usize) -> usize {
        self.begin[list + 1] - self.begin[list]
    }

    /// The items of a list.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(super) fn members(&self, list: usize) -> impl Iterator<Item = usize> + Clone + use<'_> {
        self.items[self.begin[list]..self.begin[list + 1]].iter().map(|&item| item as usize)
    }
}

/// Marks a tree without an island.
const NONE: u32 = u32::MAX;
/// Marks a tree that a constraint moves and whose island has no number yet.
const UNNUMBERED: u32 = u32::MAX - 1;

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
        self.trees.members(island)
    }

    /// Whether any constraint moves a tree.
    pub(crate) fn has(&self, tree: usize) -> bool {
        self.island.get(tree).is_some_and(|&island| island != NONE)
    }

    /// Groups the blocks of the Jacobian and returns the number of islands, which are numbered by their first tree.
    /// If the columns of the blocks are those of the last step, nothing is computed.
    pub(super) fn find(&mut self, m: &Model, jac: &ConstraintJacobian) -> usize {
        let together = m.opt.disabled(disable::ISLAND);
        if self.together == together && jac.same_columns(&self.ends, &self.columns) {
            return self.count;
        }
        jac.copy_columns(&mut self.ends, &mut self.columns);
        self.together = together;
        self.found += 1;
        let tree_of = |c: u32| m.dof_treeid[c as usize] as usize;
        self.island.resize(m.ntree, NONE);
        self.island.fill(if together { 0 } else { NONE });
        self.count = if together { 1 } else { self.number(m, jac) };

        let island = &self.island;
        self.trees
            .fill(self.count, (0..m.ntree).map(|t| (island[t], t)).filter(|(island, _)| *island != NONE));
        let blocks = jac.blocks.iter().enumerate();
        let blocks = blocks.filter_map(|(i, b)| Some((island[tree_of(*jac.columns(b).first()?)], i)));
        self.blocks.fill(self.count, blocks);
        self.find_runs(m);
        self.count
    }

    fn find_runs(&mut self, m: &Model) {
        self.runs.clear();
        self.run_ends.clear();
        for island in 0..self.count {
            let first = self.runs.len();
            for t in self.trees.members(island) {
                let dofs = m.tree_dofs(t);
                match self.runs.get_mut(first..).and_then(|runs| runs.last_mut()) {
                    Some(run) if run.end == dofs.start => run.end = dofs.end,
                    _ => self.runs.push(dofs),
                }
            }
            self.run_ends.push(self.runs.len());
        }
    }

    /// The degrees of freedom of an island as ascending ranges.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(super) fn dofs(&self, island: usize) -> impl Iterator<Item = Range<usize>> + Clone + use<'_> {
        let first = if island == 0 { 0 } else { self.run_ends[island - 1] };
        self.runs[first..self.run_ends[island]].iter().cloned()
    }

    /// The degrees of freedom of an island if they form a single range.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(super) fn one_run(&self, island: usize) -> Option<Range<usize>> {
        let mut runs = self.dofs(island);
        runs.next().filter(|_| runs.next().is_none())
    }

    /// Assigns the number of its island to each tree that a constraint moves. Returns the number of islands.
    fn number(&mut self, m: &Model, jac: &ConstraintJacobian) -> usize {
        self.link.clear();
        self.link.extend(0..m.ntree as u32);
        for b in &jac.blocks {
            let mut previous = None;
            for &c in jac.columns(b) {
                let t = m.dof_treeid[c as usize] as usize;
                self.island[t] = UNNUMBERED;
                if let Some(p) = previous.replace(t) {
                    let (a, b) = (root(&mut self.link, p), root(&mut self.link, t));
                    self.link[a.max(b)] = a.min(b) as u32;
                }
            }
        }
        // A root is the smallest tree of its island, so it gets a number before the other trees read it.
        let mut n = 0;
        for t in 0..m.ntree {
            if self.island[t] == UNNUMBERED {
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
        for owners in [vec![2u32, 0, 1, 0, 3, 2, 1], vec![0, 0, 1]] {
            lists.fill(4, owners.iter().enumerate().map(|(item, &list)| (list, item)));
            for list in 0..4 {
                let expected: Vec<usize> =
                    (0..owners.len()).filter(|&i| owners[i] as usize == list).collect();
                assert_eq!(lists.members(list).collect::<Vec<_>>(), expected);
            }
        }
    }
}
