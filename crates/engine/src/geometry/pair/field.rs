//! A height field against a convex shape. Each triangle of the grid below the shape is the top of a prism that
//! extends down to the base.

use std::ops::{ControlFlow, RangeInclusive};

use super::{ContactPoint, MAX_CONTACTS, PairSettings};
use crate::geometry::convex::{Convex, ConvexScratch, Nearest, nearest};
use crate::geometry::{HeightField, Shape};
use crate::math::*;

/// Work units of a prism that is visited, and of a sample of the grid that is read.
const PRISM_COST: u64 = 30;
const SAMPLED: u64 = 4;

/// Contacts with the prisms below a shape, in the order of the grid.
///
/// With a margin, the surface of the height field is raised by the margin, and the shape is thickened by half of the
/// margin. Distances are those between the modified shapes (measured on MuJoCo 3.14.0).
#[cfg_attr(not(feature = "small"), inline(never))]
pub(super) fn field(
    ground: &Shape,
    b: &Shape,
    margin: f64,
    settings: &PairSettings,
    scratch: &mut ConvexScratch,
    out: &mut Vec<ContactPoint>,
) {
    let local = in_field_frame(ground, b);
    let mut body = Convex::new(&local);
    let bounds = bounds(&mut body);
    if !is_near(&ground.field(), &bounds, margin) {
        return;
    }
    let half = 0.5 * margin;
    let start = out.len();
    each_prism(&ground.field(), &bounds, [0.0, margin], scratch, |corners, scratch| {
        let found = nearest(&mut Convex::prism(corners), &mut body, half, settings.effort, scratch);
        if let Some(found) = found.filter(|n| n.dist < half) {
            let [on_a, on_b] = found.witness;
            let middle = add_scaled(scale(add(on_a, on_b), 0.5), found.normal, -0.5 * half);
            let normal = mat_mul_vec(&ground.mat, found.normal);
            out.push(ContactPoint {
                dist: found.dist - half,
                pos: ground.world(middle),
                normal,
                tangent: [0.0; 3],
            });
        }
        if out.len() - start < MAX_CONTACTS { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    });
}

/// The signed distance of a height field and a shape up to `most`: that of the nearest or deepest prism. Points and
/// normal are in the world frame.
pub(crate) fn field_distance(
    ground: &Shape,
    b: &Shape,
    most: f64,
    settings: &PairSettings,
    scratch: &mut ConvexScratch,
) -> Option<Nearest> {
    let local = in_field_frame(ground, b);
    let mut body = Convex::new(&local);
    let bounds = bounds(&mut body);
    if !is_near(&ground.field(), &bounds, most) {
        return None;
    }
    let mut best: Option<Nearest> = None;
    each_prism(&ground.field(), &bounds, [most, 0.0], scratch, |corners, scratch| {
        let cutoff = best.map_or(most, |n| n.dist.min(most));
        if gap(&corners, &bounds) > cutoff.max(0.0) {
            return ControlFlow::Continue(());
        }
        let found = nearest(&mut Convex::prism(corners), &mut body, cutoff, settings.effort, scratch);
        if let Some(found) = found.filter(|n| best.is_none_or(|b| n.dist < b.dist)) {
            best = Some(found);
        }
        ControlFlow::Continue(())
    });
    best.map(|n| Nearest {
        normal: mat_mul_vec(&ground.mat, n.normal),
        witness: n.witness.map(|p| ground.world(p)),
        ..n
    })
}

/// Transforms a shape to the frame of a height field.
fn in_field_frame<'a>(ground: &Shape, b: &Shape<'a>) -> Shape<'a> {
    let columns = [0, 1, 2].map(|i| mat_t_mul_vec(&ground.mat, b.axis(i)));
    Shape { pos: ground.local(b.pos), mat: std::array::from_fn(|i| columns[i % 3][i / 3]), ..*b }
}

/// Lower and upper bound of the body along each axis, m.
fn bounds(body: &mut Convex) -> [[f64; 2]; 3] {
    let round = body.radius();
    [0, 1, 2].map(|i| {
        [-1.0, 1.0].map(|side| {
            let mut dir = [0.0; 3];
            dir[i] = side;
            body.support(dir)[i] + side * round
        })
    })
}

/// Whether a body within these bounds can be within a distance `reach` of the field.
fn is_near(field: &HeightField, [[x0, x1], [y0, y1], [z0, z1]]: &[[f64; 2]; 3], reach: f64) -> bool {
    let [sx, sy, top, base] = field.size;
    let beyond = |low: f64, high: f64, lower: f64, upper: f64| low - reach > upper || high + reach < -lower;
    !(beyond(*x0, *x1, sx, sx) || beyond(*y0, *y1, sy, sy) || beyond(*z0, *z1, base, top))
}

/// A lower bound of the distance between a prism and a body within these bounds.
fn gap(corners: &[Vec3; 6], bounds: &[[f64; 2]; 3]) -> f64 {
    norm(std::array::from_fn(|i| {
        let reach =
            |least: f64, extreme: fn(f64, f64) -> f64| corners.iter().map(|p| p[i]).fold(least, extreme);
        let (low, high) = (reach(f64::INFINITY, f64::min), reach(f64::NEG_INFINITY, f64::max));
        let [from, to] = bounds[i];
        (from - high).max(low - to).max(0.0)
    }))
}

/// Calls `visit` with the corners, the bottom first, of each prism below the bounds, which are extended by `around`
/// in x and y. Prisms whose top, raised by `raise`, is more than `around` below the bounds are skipped. Samples and
/// prisms count as work; the visit ends when the work limit is exceeded.
fn each_prism(
    field: &HeightField,
    [x, y, [z0, _]]: &[[f64; 2]; 3],
    [around, raise]: [f64; 2],
    scratch: &mut ConvexScratch,
    mut visit: impl FnMut([Vec3; 6], &mut ConvexScratch) -> ControlFlow<()>,
) {
    let [sx, sy, _, base] = field.size;
    let cells = |[low, high]: &[f64; 2], half: f64, n: usize| -> RangeInclusive<usize> {
        let last = n as f64 - 1.0;
        let place = |coordinate: f64| (coordinate + half) / (2.0 * half) * last;
        // Casts saturate, so any float becomes a valid index.
        let (low, high) = (place(low - around).floor().max(0.0), place(high + around).ceil().max(0.0));
        low as usize..=(high as usize).min(n.saturating_sub(1))
    };
    let (cols, rows) = (cells(x, sx, field.ncol), cells(y, sy, field.nrow));
    for r in *rows.start()..*rows.end() {
        // The last three samples of a zigzag between two rows form a triangle.
        let mut corners = [[0.0; 3]; 3];
        let mut seen = 0;
        for c in cols.clone() {
            scratch.cost += 2 * SAMPLED;
            if scratch.most.is_some_and(|most| scratch.cost > most) {
                return;
            }
            for row in [r + 1, r] {
                let mut sample = field.point(row, c);
                sample[2] += raise;
                corners = [corners[1], corners[2], sample];
                seen += 1;
                if seen < 3 || corners.iter().all(|p| p[2] < *z0 - around) {
                    continue;
                }
                let [p, q, s] = corners;
                let [u, v, w] = corners.map(|p| [p[0], p[1], -base]);
                scratch.cost += PRISM_COST;
                if visit([u, v, w, p, q, s], scratch).is_break() {
                    return;
                }
            }
        }
    }
}
