//! Broad phase of large scenes: sort and sweep.
//!
//! Baraff, *Dynamic Simulation of Non-Penetrating Rigid Bodies* (1992): the shadows of two geoms on an axis must overlap.
//! The axis is the one along which the geoms are spread widest; what remains is tested by bounding spheres.

use super::filter::{self, Pair};
use super::params;
use crate::math::*;
use crate::{Data, Model};

/// A geom's bounding sphere, wide enough for its margin, and its shadow on the axis.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Shadow {
    low: f64,
    high: f64,
    centre: Vec3,
    radius: f64,
    geom: u32,
}

impl Shadow {
    #[inline(always)]
    fn near(&self, other: &Shadow) -> bool {
        let between = sub(self.centre, other.centre);
        let reach = self.radius + other.radius;
        dot(between, between) <= reach * reach
    }
}

/// What the broad phase keeps from step to step.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Sweep {
    /// Bounded geoms, sorted by the lower end as of the last step.
    shadows: Vec<Shadow>,
    /// Planes, which are everywhere.
    planes: Vec<u32>,
    /// Geoms whose shadow has begun and not ended.
    active: Vec<Shadow>,
    /// Pairs whose bounds overlap, in the order in which they are tested.
    pub(super) near: Vec<Pair>,
    explicit: Vec<Pair>,
}

impl Sweep {
    pub(super) fn new(m: &Model, may_change: bool) -> Sweep {
        // A geom that can touch nothing does not take part.
        let bits = |g: usize| may_change || m.geom_contype[g] != 0 || m.geom_conaffinity[g] != 0;
        let of = |bounded: bool| {
            let size = move |g: &usize| (m.geom_rbound[*g] > 0.0) == bounded;
            (0..m.ngeom).filter(size).filter(move |&g| bits(g)).map(|g| g as u32)
        };
        let n = of(true).count();
        Sweep {
            shadows: of(true).map(|geom| Shadow { geom, ..Shadow::default() }).collect(),
            planes: of(false).collect(),
            active: Vec::with_capacity(n),
            near: Vec::with_capacity(8 * n),
            explicit: filter::explicit_pairs(m).collect(),
        }
    }

    /// Finds the pairs whose bounds overlap now.
    pub(super) fn run(&mut self, m: &Model, d: &Data) {
        let centres = rows::<3>(&d.geom_xpos);
        let axis = widest(&self.shadows, centres);
        for s in &mut self.shadows {
            let g = s.geom as usize;
            s.centre = centres[g];
            s.radius = m.geom_rbound[g] + params::half_reach(m, g);
            (s.low, s.high) = (s.centre[axis] - s.radius, s.centre[axis] + s.radius);
        }
        self.shadows.sort_unstable_by(|a, b| a.low.total_cmp(&b.low));
        self.near.clear();
        self.near.extend_from_slice(&self.explicit);
        self.active.clear();
        for &s in &self.shadows {
            self.active.retain(|other| other.high >= s.low);
            let beside = self.active.iter().filter(|other| other.near(&s)).map(|other| other.geom as usize);
            self.near.extend(beside.filter_map(|g| may_touch(m, g, s.geom as usize)));
            self.active.push(s);
            let below = self.planes.iter().map(|&plane| plane as usize);
            let reach =
                |plane: usize| s.radius - m.geom_rbound[s.geom as usize] + params::half_reach(m, plane);
            let below = below.filter(|&plane| !far_apart(m, d, plane, s.geom as usize, reach(plane)));
            self.near.extend(below.filter_map(|plane| may_touch(m, plane, s.geom as usize)));
        }
        self.near.sort_unstable_by_key(|p| p.order(m));
    }
}

fn may_touch(m: &Model, a: usize, b: usize) -> Option<Pair> {
    filter::dynamic_pair(m, a.min(b), a.max(b), false)
}

/// The axis along which centres vary most.
fn widest(shadows: &[Shadow], centres: &[Vec3]) -> usize {
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

/// Whether the bounding spheres of two geoms, or a sphere and a plane, are farther apart than `reach`.
#[inline]
pub(super) fn far_apart(m: &Model, d: &Data, a: usize, b: usize, reach: f64) -> bool {
    let (pos, mat) = (rows::<3>(&d.geom_xpos), rows::<9>(&d.geom_xmat));
    let (ra, rb) = (m.geom_rbound[a], m.geom_rbound[b]);
    let between = sub(pos[b], pos[a]);
    if ra > 0.0 && rb > 0.0 {
        let limit = ra + rb + reach;
        return dot(between, between) > limit * limit;
    }
    let above = |plane: usize, height: f64| dot(between, column(&mat[plane], 2)) * height;
    if m.geom_type[a] == crate::geom::PLANE && rb > 0.0 {
        return above(a, 1.0) > reach + rb;
    }
    m.geom_type[b] == crate::geom::PLANE && ra > 0.0 && above(b, -1.0) > reach + ra
}
