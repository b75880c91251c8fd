//! Islands: kinematic trees that constraints tie together. Each is a problem of its own.
//!
//! Connected components by union-find with path halving (Tarjan and van Leeuwen 1984).

use super::jacobian::Jacobian;
use crate::{Data, Model, disable};

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

/// Groups the blocks of the Jacobian; `nisland`. Islands are numbered by their first tree.
pub(super) fn find(m: &Model, d: &mut Data) {
    let (w, jac) = (&mut d.work.islands, &d.work.jac);
    let together = m.opt.disabled(disable::ISLAND);
    let tree_of = |c: u32| m.dof_treeid[c as usize] as usize;
    w.island.resize(m.ntree, NONE);
    w.island.fill(if together { 0 } else { NONE });

    let mut n = 1;
    if !together {
        let mut tied = false;
        for b in &jac.blocks {
            let cols = jac.columns(b);
            let (Some(&first), Some(&last)) = (cols.first(), cols.last()) else { continue };
            let (first, last) = (tree_of(first), tree_of(last));
            w.island[first] = TOUCHED;
            w.island[last] = TOUCHED;
            tied |= first != last;
        }
        if tied {
            tie(m, w, jac);
        }
        // A root is the smallest tree of its island, so it is numbered before the others ask.
        n = 0;
        for t in 0..m.ntree {
            if w.island[t] == TOUCHED {
                let r = if tied { root(&mut w.link, t) } else { t };
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
    w.trees.clear(d.nisland, m.ntree);
    for t in 0..m.ntree {
        if w.island[t] != NONE {
            w.trees.push(w.island[t] as usize, t);
        }
    }
    w.blocks.clear(d.nisland, jac.blocks.len());
    for (i, b) in jac.blocks.iter().enumerate() {
        if let Some(&c) = jac.columns(b).first() {
            w.blocks.push(w.island[tree_of(c)] as usize, i);
        }
    }
}

/// Joins the trees of each block.
fn tie(m: &Model, w: &mut Islands, jac: &Jacobian) {
    w.link.clear();
    w.link.extend(0..m.ntree as u32);
    for b in &jac.blocks {
        let mut previous = None;
        for &c in jac.columns(b) {
            let t = m.dof_treeid[c as usize] as usize;
            w.island[t] = TOUCHED;
            if let Some(p) = previous.replace(t) {
                let (a, b) = (root(&mut w.link, p), root(&mut w.link, t));
                w.link[a.max(b)] = a.min(b) as u32;
            }
        }
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
