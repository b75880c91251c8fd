//! Broad phase for large scenes: sort and sweep within columns.
//!
//! Sort and sweep (Baraff, *Dynamic Simulation of Non-Penetrating Rigid Bodies*, 1992): only geoms whose projections
//! onto an axis overlap can touch. The axis is the one with the largest variance of the centres. In a heap most
//! projections overlap many others. The space is therefore divided into square columns along the axis, whose
//! width is twice the mean diameter of the geoms, and each column is swept separately (Ericson 2005, *Real-Time
//! Collision Detection*, section 7.1). The remaining pairs are tested by bounding spheres. For n geoms of similar size
//! the cost is that of sorting them.

use super::filter::{self, Pair};
use super::params;
use crate::math::sort::{sort, sort_by};
use crate::math::*;
use crate::model::{Fields, Model};

/// The bounding sphere of a geom, enlarged by its margin, its interval on the axis, and the columns that it
/// intersects.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct SweepEntry {
    low: f64,
    high: f64,
    centre: Vec3,
    radius: f64,
    geom: u32,
    /// First and last column along each of the other two axes.
    columns: [[i32; 2]; 2],
    /// Whether it is wider than a column.
    wide: bool,
}

impl SweepEntry {
    #[cfg_attr(not(feature = "small"), inline(always))]
    fn near(&self, other: &SweepEntry) -> bool {
        let between = sub(self.centre, other.centre);
        let reach = self.radius + other.radius;
        dot(between, between) <= reach * reach
    }

    /// The first column that two geoms share. They must share at least one.
    fn first_common(&self, other: &SweepEntry) -> [i32; 2] {
        let [a, b] = [self.columns, other.columns];
        [a[0][0].max(b[0][0]), a[1][0].max(b[1][0])]
    }

    /// The number of columns that it intersects.
    fn spans(&self) -> i64 {
        let number = |[first, last]: [i32; 2]| 1 + i64::from(last) - i64::from(first);
        self.columns.map(number).into_iter().fold(1, i64::saturating_mul)
    }
}

/// A geom in a column: the coordinates of the column, and the index of its interval in the sorted order.
type Entry = ([i32; 2], u32);

/// State of the broad phase that is kept between steps.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Sweep {
    /// Bounded geoms, sorted by the lower end of their interval in the last step.
    shadows: Vec<SweepEntry>,
    /// Planes, which are unbounded.
    planes: Vec<u32>,
    /// Geoms wider than a column, sorted by lower end.
    wide: Vec<u32>,
    /// The other geoms, sorted by column, then by lower end.
    entries: Vec<Entry>,
    /// Intervals that are open at the current point of the sweep of a column.
    active: Vec<u32>,
    /// Pairs with overlapping bounds, in the order in which they are tested.
    pub(super) near: Vec<Pair>,
    explicit: Vec<Pair>,
    /// Number of pairs of spheres tested in the last step, and how many of them were near.
    pub(super) tested: usize,
    queried: usize,
}

/// Maximum number of columns that a geom not wider than a column can intersect.
const MOST_COLUMNS: usize = 4;
/// Maximum number of pairs. A scene with more overlapping bounds exceeds the maximum number of contacts long before.
const MOST_NEAR: usize = 1 << 22;

impl Sweep {
    pub(super) fn new(m: &Model, may_change: bool) -> Sweep {
        // A geom without contact bits does not take part.
        let bits = |g: usize| may_change || m.geom_contype[g] != 0 || m.geom_conaffinity[g] != 0;
        let geoms_with = |bounded: bool| {
            let size = move |g: &usize| (m.geom_rbound[*g] > 0.0) == bounded;
            (0..m.ngeom).filter(size).filter(move |&g| bits(g)).map(|g| g as u32)
        };
        let n = geoms_with(true).count();
        Sweep {
            shadows: geoms_with(true).map(|geom| SweepEntry { geom, ..SweepEntry::default() }).collect(),
            planes: geoms_with(false).collect(),
            wide: Vec::with_capacity(n),
            entries: Vec::with_capacity(MOST_COLUMNS * n),
            active: Vec::with_capacity(n),
            near: Vec::with_capacity(8 * n),
            explicit: filter::explicit_pairs(m).collect(),
            tested: 0,
            queried: 0,
        }
    }

    /// Finds the pairs with overlapping bounds at the current positions. Returns the work units.
    pub(super) fn run(&mut self, m: &Model, d: &Fields) -> u64 {
        let width = self.place(m, rows::<3>(&d.geom_xpos));
        (self.tested, self.queried) = (0, 0);
        self.near.clear();
        self.near.extend_from_slice(&self.explicit);
        self.in_columns(m);
        self.sweep_wide(m);
        self.sweep_wide_against_narrow(m, width);
        for s in &self.shadows {
            let reach =
                |plane: usize| s.radius - m.geom_rbound[s.geom as usize] + params::half_reach(m, plane);
            let below = self.planes.iter().map(|&plane| plane as usize);
            let below = below.filter(|&plane| !out_of_reach(m, d, plane, s.geom as usize, reach(plane)));
            self.near.extend(below.filter_map(|plane| may_touch(m, plane, s.geom as usize)));
        }
        sort_by(&mut self.near, |p, q| p.order(m).cmp(&q.order(m)));
        let listed = m.npair + m.nexclude;
        let rest = self.shadows.len() * (100 + 10 * self.planes.len()) + 5 * self.tested;
        (rest + self.queried * (20 + listed) + 100 * self.near.len()) as u64
    }

    /// Computes and sorts the intervals and columns of all geoms. Returns the width of a column, m.
    fn place(&mut self, m: &Model, centres: &[Vec3]) -> f64 {
        let axis = axis_of_largest_variance(&self.shadows, centres);
        let mut sum = 0.0;
        for s in &mut self.shadows {
            let g = s.geom as usize;
            s.centre = centres[g];
            s.radius = m.geom_rbound[g] + params::half_reach(m, g);
            (s.low, s.high) = (s.centre[axis] - s.radius, s.centre[axis] + s.radius);
            sum += s.radius;
        }
        // Twice the mean diameter: few geoms are wider, and most geoms are in a single column.
        let width = 4.0 * sum / self.shadows.len().max(1) as f64;
        let others = [(axis + 1) % 3, (axis + 2) % 3];
        for s in &mut self.shadows {
            // Casts saturate: geoms beyond all columns share the last one.
            let column = |x: f64| (x / width).floor() as i32;
            let both = |k: usize| [s.centre[k] - s.radius, s.centre[k] + s.radius].map(column);
            s.columns = others.map(both);
            // A geom with a NaN bound counts as wide.
            s.wide = 2.0 * s.radius > width || s.radius.is_nan() || width.is_nan();
        }
        sort_by(&mut self.shadows, |a, b| a.low.total_cmp(&b.low).then(a.geom.cmp(&b.geom)));
        width
    }

    /// Sweeps each column.
    fn in_columns(&mut self, m: &Model) {
        self.entries.clear();
        self.wide.clear();
        for (k, s) in self.shadows.iter().enumerate() {
            if s.wide {
                self.wide.push(k as u32);
                continue;
            }
            let [along, across] = s.columns;
            for i in along[0]..=along[1] {
                self.entries.extend((across[0]..=across[1]).map(|j| ([i, j], k as u32)));
            }
        }
        sort(&mut self.entries);
        for column in self.entries.chunk_by(|a, b| a.0 == b.0) {
            self.active.clear();
            for &(place, k) in column {
                let s = &self.shadows[k as usize];
                self.active.retain(|&other| self.shadows[other as usize].high >= s.low);
                self.tested += self.active.len();
                for &other in &self.active {
                    let other = &self.shadows[other as usize];
                    // Geoms that share several columns are paired only in the first one.
                    if other.near(s) && s.first_common(other) == place {
                        self.queried += 1;
                        if self.near.len() < MOST_NEAR {
                            self.near.extend(may_touch(m, other.geom as usize, s.geom as usize));
                        }
                    }
                }
                self.active.push(k);
            }
        }
    }

    /// Sweeps the geoms that are wider than a column, without columns.
    fn sweep_wide(&mut self, m: &Model) {
        for (i, &k) in self.wide.iter().enumerate() {
            let s = &self.shadows[k as usize];
            let later = self.wide[i + 1..].iter().map(|&other| &self.shadows[other as usize]);
            for other in later.take_while(|other| other.low <= s.high) {
                self.tested += 1;
                if other.near(s) {
                    self.queried += 1;
                    if self.near.len() < MOST_NEAR {
                        self.near.extend(may_touch(m, other.geom as usize, s.geom as usize));
                    }
                }
            }
        }
    }

    /// Tests wide geoms against the narrow geoms in their columns.
    fn sweep_wide_against_narrow(&mut self, m: &Model, width: f64) {
        for &k in &self.wide {
            let s = &self.shadows[k as usize];
            if s.spans() > self.shadows.len() as i64 {
                // For this many columns, searching each column costs more than testing every geom.
                for other in self.shadows.iter().filter(|other| !other.wide) {
                    self.tested += 1;
                    if other.near(s) {
                        self.queried += 1;
                        if self.near.len() < MOST_NEAR {
                            self.near.extend(may_touch(m, other.geom as usize, s.geom as usize));
                        }
                    }
                }
                continue;
            }
            let [along, across] = s.columns;
            for place in (along[0]..=along[1]).flat_map(|i| (across[0]..=across[1]).map(move |j| [i, j])) {
                // A narrow geom that overlaps begins at most one column width earlier.
                let first = s.low - width;
                let before =
                    |e: &Entry| e.0 < place || e.0 == place && self.shadows[e.1 as usize].low < first;
                let beside = &self.entries[self.entries.partition_point(before)..];
                for &(_, other) in beside.iter().take_while(|e| e.0 == place) {
                    let other = &self.shadows[other as usize];
                    if other.low > s.high {
                        break;
                    }
                    self.tested += 1;
                    if other.near(s) && s.first_common(other) == place {
                        self.queried += 1;
                        if self.near.len() < MOST_NEAR {
                            self.near.extend(may_touch(m, other.geom as usize, s.geom as usize));
                        }
                    }
                }
            }
        }
    }
}

fn may_touch(m: &Model, a: usize, b: usize) -> Option<Pair> {
    filter::dynamic_pair(m, a.min(b), a.max(b), false)
}

/// The axis with the largest variance of the centres.
fn axis_of_largest_variance(shadows: &[SweepEntry], centres: &[Vec3]) -> usize {
    let n = shadows.len().max(1) as f64;
    let (mut sum, mut squares) = ([0.0; 3], [0.0; 3]);
    for s in shadows {
        let c = centres[s.geom as usize];
        for i in 0..3 {
            sum[i] += c[i];
            squares[i] += c[i] * c[i];
        }
    }
    let spread = |i: usize| squares[i] - sum[i] * sum[i] / n;
    (1..3).fold(0, |best, i| if spread(i) > spread(best) { i } else { best })
}

/// Whether the bounding spheres of two geoms, or a bounding sphere and a plane, are farther apart than `reach`.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(super) fn out_of_reach(m: &Model, d: &Fields, a: usize, b: usize, reach: f64) -> bool {
    let (pos, mat) = (rows::<3>(&d.geom_xpos), rows::<9>(&d.geom_xmat));
    let (ra, rb) = (m.geom_rbound[a], m.geom_rbound[b]);
    let between = sub(pos[b], pos[a]);
    if ra > 0.0 && rb > 0.0 {
        let limit = ra + rb + reach;
        return dot(between, between) > limit * limit;
    }
    let above = |plane: usize, height: f64| dot(between, column(&mat[plane], 2)) * height;
    if m.geom_type[a] == crate::kinds::geom::PLANE && rb > 0.0 {
        return above(a, 1.0) > reach + rb;
    }
    m.geom_type[b] == crate::kinds::geom::PLANE && ra > 0.0 && above(b, -1.0) > reach + ra
}
