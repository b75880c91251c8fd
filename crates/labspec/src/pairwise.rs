//! Pairwise covering designs: a few runs that contain every pair of settings.
//!
//! Rows are added greedily. Each begins with the first pair of levels that no row contains yet. Every other factor then
//! takes the level that adds the most new pairs (the idea of D. M. Cohen and others 1997, "The AETG system", without
//! randomness: the same factors give the same rows).

/// Rows of levels, one for each factor, so that some row contains each pair of levels of two factors. `levels` is the
/// number of levels of each factor. Stops after `most` rows; the second result is the number of pairs that no row contains.
pub(crate) fn pairwise(levels: &[usize], most: usize) -> (Vec<Vec<usize>>, usize) {
    let mut missing = Missing::new(levels);
    let mut rows = Vec::new();
    while rows.len() < most
        && let Some([first, second]) = missing.first()
    {
        let mut row: Vec<Option<usize>> = vec![None; levels.len()];
        for (factor, level) in [first, second] {
            row[factor] = Some(level);
        }
        for factor in 0..levels.len() {
            if row[factor].is_none() {
                row[factor] = Some(missing.best(factor, &row));
            }
        }
        let row: Vec<usize> = row.into_iter().map(Option::unwrap_or_default).collect();
        missing.remove_covered(&row);
        rows.push(row);
    }
    (rows, missing.count)
}

/// Every combination of levels; the last factor changes fastest.
pub(crate) fn all(levels: &[usize]) -> Vec<Vec<usize>> {
    let mut rows = vec![Vec::new()];
    for &n in levels {
        let longer = |row: &Vec<usize>| (0..n).map(|level| [row.as_slice(), &[level]].concat()).collect();
        rows = rows.iter().flat_map::<Vec<Vec<usize>>, _>(longer).collect();
    }
    rows
}

/// The pairs that no row contains yet.
struct Missing {
    levels: Vec<usize>,
    /// The index of the first level of each factor among all levels.
    start: Vec<usize>,
    total: usize,
    open: Vec<bool>,
    /// All pairs before this index are covered.
    from: usize,
    count: usize,
}

impl Missing {
    fn new(levels: &[usize]) -> Missing {
        let mut start = Vec::new();
        let mut total = 0;
        for n in levels {
            start.push(total);
            total += n;
        }
        let mut all = Missing {
            levels: levels.to_vec(),
            start,
            total,
            open: vec![false; total * total],
            from: 0,
            count: 0,
        };
        for i in 0..levels.len() {
            for j in i + 1..levels.len() {
                for a in 0..levels[i] {
                    for b in 0..levels[j] {
                        let index = all.place((i, a), (j, b));
                        all.open[index] = true;
                        all.count += 1;
                    }
                }
            }
        }
        all
    }

    /// The index of a pair: the earlier factor first.
    fn place(&self, (i, a): (usize, usize), (j, b): (usize, usize)) -> usize {
        let [mut row, mut column] = [self.start[i] + a, self.start[j] + b];
        if i > j {
            std::mem::swap(&mut row, &mut column);
        }
        row * self.total + column
    }

    /// The factor and the level at an index.
    fn level(&self, index: usize) -> (usize, usize) {
        let factor = self.start.partition_point(|s| *s <= index) - 1;
        // A factor without levels has the same start index as the next one.
        let factor = (0..=factor).rev().find(|f| self.levels[*f] > 0).unwrap_or(factor);
        (factor, index - self.start[factor])
    }

    fn first(&mut self) -> Option<[(usize, usize); 2]> {
        self.from += self.open.get(self.from..)?.iter().position(|open| *open)?;
        Some([self.level(self.from / self.total), self.level(self.from % self.total)])
    }

    /// The level of a factor that adds the most new pairs with the levels of the row; the lowest of several.
    fn best(&self, factor: usize, row: &[Option<usize>]) -> usize {
        let gain = |level: usize| {
            let others = row.iter().enumerate().filter_map(|(j, b)| Some((j, (*b)?)));
            others.filter(|other| self.open[self.place((factor, level), *other)]).count()
        };
        // `max_by_key` returns the last of equal elements, which is the first in reverse order.
        (0..self.levels[factor]).rev().max_by_key(|level| gain(*level)).unwrap_or(0)
    }

    fn remove_covered(&mut self, row: &[usize]) {
        for (i, a) in row.iter().enumerate() {
            for (j, b) in row.iter().enumerate().skip(i + 1) {
                let index = self.place((i, *a), (j, *b));
                self.count -= usize::from(std::mem::take(&mut self.open[index]));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    /// Pairs of factor and level in one row.
    fn covered_pairs(rows: &[Vec<usize>]) -> BTreeSet<[(usize, usize); 2]> {
        let row_pairs = |row: &Vec<usize>| {
            let row = row.clone();
            (0..row.len()).flat_map(move |i| {
                let row = row.clone();
                (i + 1..row.len()).map(move |j| [(i, row[i]), (j, row[j])])
            })
        };
        rows.iter().flat_map(row_pairs).collect()
    }

    #[test]
    fn every_pair_of_levels_occurs_in_some_row() {
        for levels in [
            &[2, 2, 2, 2, 2, 2, 2, 2, 2, 2][..],
            &[2, 3, 4, 5],
            &[5, 4, 3, 2, 2, 2],
            &[3; 13],
            &[7, 1, 2],
            &[2, 2],
        ] {
            let (rows, missing) = pairwise(levels, usize::MAX);
            let all: usize =
                levels.iter().sum::<usize>().pow(2) - levels.iter().map(|n| n * n).sum::<usize>();
            assert_eq!((missing, covered_pairs(&rows).len()), (0, all / 2), "{levels:?}");
            assert!(rows.iter().all(|row| row.iter().zip(levels).all(|(level, n)| level < n)));
            assert_eq!(rows, pairwise(levels, usize::MAX).0, "the same again");
            // Fewer rows are impossible, and the greedy design has not many more.
            let mut sorted = levels.to_vec();
            sorted.sort_unstable();
            let least = sorted[sorted.len() - 1] * sorted[sorted.len() - 2];
            assert!(rows.len() >= least && rows.len() <= 2 * least + 12, "{levels:?}: {} rows", rows.len());
        }
    }

    #[test]
    fn pairs_beyond_the_limit_are_counted() {
        let (rows, missing) = pairwise(&[4, 4, 4], 5);
        assert_eq!((rows.len(), missing), (5, 48 - covered_pairs(&rows).len()));
        assert_eq!(pairwise(&[9], 100), (Vec::new(), 0));
        assert_eq!(pairwise(&[2, 0, 3], 100).0.len(), 6);
    }

    #[test]
    fn all_combinations_are_all() {
        assert_eq!(all(&[2, 3]), [[0, 0], [0, 1], [0, 2], [1, 0], [1, 1], [1, 2]]);
        assert_eq!(all(&[]), [[0; 0]]);
    }
}
