//! Clipping of convex polygons by planes: Sutherland and Hodgman, *Reentrant polygon clipping*, Communications of the ACM 17
//! (1974).

use super::list::List;
use crate::math::*;

/// Rounding error of a coordinate, relative to the size of the shapes. A corner undergoes two rotations, a
/// translation and some cuts, each with a rounding error of 1.1e-16.
pub(super) const ROUNDING: f64 = 1e-14;

/// Keeps the part of a convex polygon where a linear function `height` is not negative. A corner within the rounding
/// error of `size` counts as on the plane: it is kept, and no edge is cut next to it.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(super) fn clip<const N: usize>(polygon: &mut List<Vec3, N>, height: impl Fn(Vec3) -> f64, size: f64) {
    let slack = ROUNDING * size;
    if polygon.all().iter().any(|&p| height(p) < -slack) {
        *polygon = cut(polygon, height, slack);
    }
}

/// The corners with non-negative height, and the points where edges cross the plane.
fn cut<const N: usize>(polygon: &List<Vec3, N>, height: impl Fn(Vec3) -> f64, slack: f64) -> List<Vec3, N> {
    let mut out = List::new();
    let corners = polygon.all();
    let Some(&first) = corners.first() else { return out };
    let nexts = corners.iter().skip(1).chain([&first]);
    for (&p, &next) in corners.iter().zip(nexts) {
        let (here, there) = (height(p), height(next));
        if here >= -slack {
            out.push(p);
        }
        if here.min(there) < -slack && here.max(there) > slack {
            out.push(add_scaled(p, sub(next, p), here / (here - there)));
        }
    }
    out
}
