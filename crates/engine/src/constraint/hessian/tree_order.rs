//! An order of the trees of a large island for which the rows of the Hessian are short: breadth first from an end of
//! the island (Cuthill and McKee 1969), numbered in reverse (George 1971).

use crate::constraint::island::Islands;
use crate::constraint::jacobian::ConstraintJacobian;
use crate::math::sort::sort;
use crate::model::Model;

/// Scratch for ordering trees.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct TreeOrder {
    /// Pairs of trees that a block connects, in both directions, ascending, and the start of those of each tree.
    pairs: Vec<[u32; 2]>,
    begin: Vec<u32>,
    /// Trees in order, and whether each tree is in the list.
    pub(super) list: Vec<u32>,
    seen: Vec<bool>,
}

impl TreeOrder {
    /// Orders the trees of an island breadth first, starting at a tree far from the others, and reverses the order.
    pub(super) fn sort(&mut self, m: &Model, jac: &ConstraintJacobian, islands: &Islands, island: usize) {
        self.tie(m, jac, islands, island);
        let trees = || islands.trees_of(island);
        let degree = |begin: &[u32], t: usize| begin[t + 1] - begin[t];
        let Some(start) = trees().min_by_key(|&t| degree(&self.begin, t)) else { return };
        self.walk(start);
        // Two more searches from the last tree reached find an end of the island.
        for _ in 0..2 {
            let Some(&end) = self.list.last() else { break };
            self.walk(end as usize);
        }
        // Trees that no block connects belong to one island only if islands are disabled.
        for t in trees() {
            if !self.seen[t] {
                self.reach(t);
            }
        }
        self.list.reverse();
    }

    /// Lists the pairs of trees that blocks connect.
    fn tie(&mut self, m: &Model, jac: &ConstraintJacobian, islands: &Islands, island: usize) {
        self.pairs.clear();
        for i in islands.blocks.members(island) {
            let trees = jac.trees(m, &jac.blocks[i]);
            for a in trees.clone() {
                self.pairs.extend(trees.clone().filter(|&b| b != a).map(|b| [a as u32, b as u32]));
            }
        }
        sort(&mut self.pairs);
        self.pairs.dedup();
        self.begin.clear();
        self.begin.resize(m.ntree + 1, 0);
        for [a, _] in &self.pairs {
            self.begin[*a as usize + 1] += 1;
        }
        for t in 0..m.ntree {
            self.begin[t + 1] += self.begin[t];
        }
    }

    fn walk(&mut self, start: usize) {
        self.list.clear();
        self.seen.clear();
        self.seen.resize(self.begin.len(), false);
        self.reach(start);
    }

    /// Appends a tree and all trees reachable from it, in breadth-first order.
    fn reach(&mut self, start: usize) {
        let mut next = self.list.len();
        self.list.push(start as u32);
        self.seen[start] = true;
        while let Some(&t) = self.list.get(next) {
            next += 1;
            for [_, b] in &self.pairs[self.begin[t as usize] as usize..self.begin[t as usize + 1] as usize] {
                if !std::mem::replace(&mut self.seen[*b as usize], true) {
                    self.list.push(*b);
                }
            }
        }
    }
}
