//! The Hessian of an island, M + Jᵀ C J, and its factorization H = L Lᵀ.
//!
//! Each row is kept from its first entry that is not zero up to the diagonal; L fills nothing outside of that (George and
//! Liu 1981, *Computer Solution of Large Sparse Positive Definite Systems*, ch. 4). Small islands keep whole rows. In large
//! ones, where most pairs of trees do not touch, trees are ordered so that rows are short: breadth first from an end of
//! the island, reversed (Cuthill and McKee 1969, George 1971).

use super::island::Islands;
use super::jacobian::Jacobian;
use super::solver::tree_dofs;
use crate::Model;
use crate::math::{MINVAL, dot_slice};

/// Degrees of freedom up to which whole rows are kept.
const SMALL: usize = 120;

/// The sum of the squares of the lengths of rows up to which an island is solved with its Hessian: that of a thousand
/// degrees of freedom, each tied to each. Beyond that a step would take minutes; conjugate gradients find the same
/// solution without it.
const MOST_WORK: usize = 330_000_000;

/// A symmetric matrix: the lower triangle, row by row.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Hessian {
    /// Position of each degree of freedom of the model in its island.
    pub(super) local: Vec<u32>,
    values: Vec<f64>,
    /// Per row: its first column, and where that lies in `values`.
    first: Vec<u32>,
    start: Vec<usize>,
    order: Order,
}

/// Scratch of the ordering of trees.
#[derive(Clone, Debug, Default, PartialEq)]
struct Order {
    /// Pairs of trees that some block ties together, both ways, ascending; and where those of each tree begin.
    pairs: Vec<[u32; 2]>,
    begin: Vec<u32>,
    /// Trees in their order, and whether each is there.
    list: Vec<u32>,
    seen: Vec<bool>,
}

impl Hessian {
    /// Number of rows.
    pub(super) fn len(&self) -> usize {
        self.first.len()
    }

    /// Numbers of the matrix that are kept.
    #[cfg(test)]
    pub(super) fn kept(&self) -> usize {
        self.values.len()
    }

    /// Numbers the degrees of freedom of an island, and lays out its rows. `false`, and no room is made, where to
    /// factorize them would take more than [`MOST_WORK`].
    pub(super) fn lay_out(&mut self, m: &Model, jac: &Jacobian, islands: &Islands, island: usize) -> bool {
        let trees = || islands.trees_of(island);
        let n: usize = trees().map(|t| tree_dofs(m, t).len()).sum();
        self.local.resize(m.nv, 0);
        if n <= SMALL {
            self.number(m, trees());
            self.first.clear();
            self.first.resize(n, 0);
        } else {
            let mut order = std::mem::take(&mut self.order);
            order.sort(m, jac, islands, island);
            self.number(m, order.list.iter().map(|&t| t as usize));
            self.order = order;
            self.shorten(m, jac, islands, island);
        }
        self.start.clear();
        let (mut end, mut work) = (0, 0);
        for (row, &first) in self.first.iter().enumerate() {
            let length = row + 1 - first as usize;
            self.start.push(end);
            end += length;
            work += length * length;
        }
        if work > MOST_WORK {
            return false;
        }
        self.values.resize(end, 0.0);
        true
    }

    fn number(&mut self, m: &Model, trees: impl Iterator<Item = usize>) {
        for (i, k) in trees.flat_map(|t| tree_dofs(m, t)).enumerate() {
            self.local[k] = i as u32;
        }
    }

    /// The first column of every row: that of its tree, or of a tree that some block ties to it.
    fn shorten(&mut self, m: &Model, jac: &Jacobian, islands: &Islands, island: usize) {
        self.first.clear();
        for t in islands.trees_of(island) {
            self.first.extend(tree_dofs(m, t).map(|_| u32::MAX));
        }
        for t in islands.trees_of(island) {
            let lowest = self.local[tree_dofs(m, t).start];
            for k in tree_dofs(m, t) {
                self.first[self.local[k] as usize] = lowest;
            }
        }
        for i in islands.blocks.of(island) {
            let columns = jac.columns(&jac.blocks[i]);
            let lowest = columns.iter().map(|&k| self.local[k as usize]).min().unwrap_or(0);
            for &k in columns {
                let first = &mut self.first[self.local[k as usize] as usize];
                *first = lowest.min(*first);
            }
        }
    }

    /// All numbers zero.
    pub(super) fn clear(&mut self) {
        self.values.fill(0.0);
    }

    /// The entry of two degrees of freedom of the model.
    #[inline(always)]
    pub(super) fn entry(&mut self, i: u32, j: u32) -> &mut f64 {
        let (i, j) = (self.local[i as usize], self.local[j as usize]);
        let (row, column) = (i.max(j) as usize, i.min(j));
        &mut self.values[self.start[row] + (column - self.first[row]) as usize]
    }

    /// H = L Lᵀ, in place.
    pub(super) fn factor(&mut self) {
        for i in 0..self.len() {
            let (above, row) = self.values.split_at_mut(self.start[i]);
            let first = self.first[i] as usize;
            let row = &mut row[..=i - first];
            for j in first..i {
                let from = first.max(self.first[j] as usize);
                let lj = &above[self.start[j] + from - self.first[j] as usize..];
                let (done, entry) = row.split_at_mut(j - first);
                let done = &done[from - first..];
                entry[0] = (entry[0] - dot_slice(done, &lj[..done.len()])) / lj[done.len()];
            }
            let (off, diag) = row.split_at_mut(i - first);
            diag[0] = (diag[0] - dot_slice(off, off)).max(MINVAL).sqrt();
        }
    }

    /// x ← H⁻¹ x, factorized.
    pub(super) fn solve(&self, x: &mut [f64]) {
        for i in 0..self.len() {
            let (off, diag, first) = self.row(i);
            x[i] = (x[i] - dot_slice(off, &x[first..i])) / diag;
        }
        for i in (0..self.len()).rev() {
            let (off, diag, first) = self.row(i);
            let xi = x[i] / diag;
            x[i] = xi;
            for (x, l) in x[first..i].iter_mut().zip(off) {
                *x -= l * xi;
            }
        }
    }

    /// A row: what is left of the diagonal, the diagonal, and the first column.
    fn row(&self, i: usize) -> (&[f64], f64, usize) {
        let first = self.first[i] as usize;
        let row = &self.values[self.start[i]..=self.start[i] + i - first];
        (&row[..i - first], row[i - first], first)
    }
}

impl Order {
    /// The trees of an island, breadth first from one that is far from the others, reversed.
    fn sort(&mut self, m: &Model, jac: &Jacobian, islands: &Islands, island: usize) {
        self.tie(m, jac, islands, island);
        let trees = || islands.trees_of(island);
        let degree = |begin: &[u32], t: usize| begin[t + 1] - begin[t];
        let Some(start) = trees().min_by_key(|&t| degree(&self.begin, t)) else { return };
        self.walk(start);
        // Twice from the last that was reached: there is an end of the island.
        for _ in 0..2 {
            let Some(&end) = self.list.last() else { break };
            self.walk(end as usize);
        }
        // What nothing ties together is one island only when islands are switched off.
        for t in trees() {
            if !self.seen[t] {
                self.reach(t);
            }
        }
        self.list.reverse();
    }

    /// Lists the pairs of trees that blocks tie together.
    fn tie(&mut self, m: &Model, jac: &Jacobian, islands: &Islands, island: usize) {
        self.pairs.clear();
        for i in islands.blocks.of(island) {
            let trees = jac.trees(m, &jac.blocks[i]);
            for a in trees.clone() {
                self.pairs.extend(trees.clone().filter(|&b| b != a).map(|b| [a as u32, b as u32]));
            }
        }
        self.pairs.sort_unstable();
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

    /// Appends a tree and all that can be reached from it, the nearest first.
    fn reach(&mut self, start: usize) {
        let mut at = self.list.len();
        self.list.push(start as u32);
        self.seen[start] = true;
        while let Some(&t) = self.list.get(at) {
            at += 1;
            for [_, b] in &self.pairs[self.begin[t as usize] as usize..self.begin[t as usize + 1] as usize] {
                if !std::mem::replace(&mut self.seen[*b as usize], true) {
                    self.list.push(*b);
                }
            }
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)] // a test that fails says why
mod tests {
    use crate::{Data, Model, mjcf, pipeline};
    use std::fmt::Write;

    /// Two hundred balls in one place, each of which touches each: no room is made for the Hessian, and the step is done.
    #[test]
    fn an_island_that_is_too_large_is_solved_without_its_hessian() {
        let ball = |i: usize| {
            let at = 1e-3 * i as f64;
            format!("<body pos='{at} {} 0'><freejoint/><geom size='0.3'/></body>", at * at)
        };
        let text: String = (0..200).map(ball).collect();
        let m = mjcf::compile(&format!("<mujoco><worldbody>{text}</worldbody></mujoco>")).unwrap();
        let mut d = Data::new(&m);
        pipeline::step(&m, &mut d);
        assert_eq!((d.ncon, d.nisland), (200 * 199 / 2, 1));
        assert_eq!(d.work.solver.as_ref().unwrap().hessian.kept(), 0);
        assert!(d.solver_niter > 0 && d.qacc.iter().all(|a| a.is_finite()));
    }

    /// Free boxes at these places, by name, on a floor.
    fn boxes(list: impl Iterator<Item = (usize, [f64; 3], [f64; 3])>) -> Model {
        let mut text = String::from("<mujoco><worldbody><geom type=\"plane\" size=\"9 9 1\"/>");
        for (i, [x, y, z], [a, b, c]) in list {
            let _ = write!(
                text,
                "<body name=\"b{i}\" pos=\"{x} {y} {z}\"><freejoint/><geom type=\"box\" size=\"{a} {b} {c}\"/></body>"
            );
        }
        mjcf::compile(&(text + "</worldbody></mujoco>")).unwrap()
    }

    fn kept(m: &Model) -> (usize, Data) {
        let mut d = Data::new(m);
        pipeline::forward(m, &mut d);
        let hessian = &d.work.solver.as_ref().unwrap().hessian;
        (hessian.kept(), d)
    }

    const SMALL_BOX: [f64; 3] = [0.1; 3];

    fn row(i: usize) -> (usize, [f64; 3], [f64; 3]) {
        (i, [0.1995 * i as f64, 0.0, 0.0995], SMALL_BOX)
    }

    #[test]
    fn a_row_of_boxes_takes_a_band() {
        let (kept, d) = kept(&boxes((0..100).map(row)));
        assert_eq!(d.nisland, 1);
        assert!(kept <= 600 * 12, "{kept} numbers of {}", 600 * 601 / 2);
    }

    #[test]
    fn a_plate_under_all_others_does_not_fill_the_matrix() {
        let plate = (0, [10.0, 0.0, 0.0495], [12.0, 1.0, 0.05]);
        let upon = (1..100).map(|i| (i, [0.25 * i as f64, 0.0, 0.1985], SMALL_BOX));
        let (kept, d) = kept(&boxes(std::iter::once(plate).chain(upon)));
        assert_eq!(d.nisland, 1);
        assert!(kept <= 600 * 14, "{kept} numbers of {}", 600 * 601 / 2);
    }

    #[test]
    fn boxes_apart_take_a_matrix_each() {
        let apart = |i: usize| (i, [0.5 * i as f64, 0.0, 0.0995], SMALL_BOX);
        let (kept, d) = kept(&boxes((0..300).map(apart)));
        assert_eq!((d.nisland, kept), (300, 21));
    }

    #[test]
    fn the_order_in_the_file_changes_rounding_alone() {
        // By steps of 37 through a hundred: neighbours stand far from each other in the file.
        let (near, far) = (boxes((0..100).map(row)), boxes((0..100).map(|i| row(i * 37 % 100))));
        let ((_, a), (kept, b)) = (kept(&near), kept(&far));
        assert!(kept <= 600 * 12, "{kept}");
        for i in 0..600 {
            let there = 6 * (i / 6 * 73 % 100) + i % 6;
            assert!((a.qacc[i] - b.qacc[there]).abs() < 1e-9, "{i}: {} and {}", a.qacc[i], b.qacc[there]);
        }
    }
}
