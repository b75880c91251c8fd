//! Contacts of two convex shapes from the general algorithm, and additional contacts if they lie flat on each other.

use super::ContactPoint;
use super::PairSettings;
use super::polygon;
use crate::geometry::Shape;
use crate::geometry::convex::{Convex, ConvexScratch, nearest};
use crate::kinds::geom;
use crate::math::*;

/// Minimum distance of a new contact from the others, as a fraction of the smaller bounding radius.
const DISTINCT: f64 = 1e-3;
/// Angle by which the shapes are rotated to find further contact points, rad.
const PERTURBATION_ANGLE: f64 = 1e-3;

/// Appends the nearest or deepest contact, and further ones if the shapes lie flat on each other.
#[cfg_attr(not(feature = "small"), inline(never))]
pub(super) fn convex(
    a: &Shape,
    b: &Shape,
    margin: f64,
    settings: &PairSettings,
    scratch: &mut ConvexScratch,
    out: &mut Vec<ContactPoint>,
) {
    let flat = |s: &Shape| matches!(s.kind, geom::CYLINDER | geom::BOX | geom::MESH);
    if settings.several && margin <= 0.0 && flat(a) && flat(b) {
        polygon::contacts(a, b, settings, scratch, out);
        return;
    }
    let Some(first) = deepest(a, b, margin, settings, scratch) else { return };
    out.push(first);
    let smooth = |s: &Shape| matches!(s.kind, geom::ELLIPSOID | geom::SPHERE);
    if settings.several && !smooth(a) && !smooth(b) {
        perturb_rotations(a, b, margin, settings, scratch, first, out);
    }
}

/// The contact at the nearest or deepest point of two shapes within `margin`.
fn deepest(
    a: &Shape,
    b: &Shape,
    margin: f64,
    settings: &PairSettings,
    scratch: &mut ConvexScratch,
) -> Option<ContactPoint> {
    let (mut u, mut v) = (Convex::new(a), Convex::new(b));
    nearest(&mut u, &mut v, margin, settings.effort, scratch)
        .filter(|n| n.dist < margin)
        .map(|n| ContactPoint::at_midpoint(&n))
}

/// Rotates both shapes in opposite directions about the first contact, by a small angle in both senses about each
/// tangent. Appends the contacts that this finds at other positions, with the distance of the first contact.
fn perturb_rotations(
    a: &Shape,
    b: &Shape,
    margin: f64,
    settings: &PairSettings,
    scratch: &mut ConvexScratch,
    first: ContactPoint,
    out: &mut Vec<ContactPoint>,
) {
    let start = out.len() - 1;
    let min_distance = DISTINCT * a.bounding_radius().min(b.bounding_radius());
    let frame = frame(first.normal);
    for axis in [[frame[3], frame[4], frame[5]], [frame[6], frame[7], frame[8]]] {
        for angle in [-PERTURBATION_ANGLE, PERTURBATION_ANGLE] {
            let turn = quat_to_mat(quat_axis_angle(axis, angle));
            let back = std::array::from_fn(|i| turn[3 * (i % 3) + i / 3]);
            let (a, b) = (turned(a, first.pos, &turn), turned(b, first.pos, &back));
            let Some(found) = deepest(&a, &b, margin, settings, scratch) else { continue };
            if out[start..].iter().all(|t| norm(sub(t.pos, found.pos)) > min_distance) {
                out.push(ContactPoint { dist: first.dist, ..found });
            }
        }
    }
}

/// Rotates a shape about a point.
fn turned<'a>(s: &Shape<'a>, about: Vec3, turn: &Mat3) -> Shape<'a> {
    let arm = sub(about, s.pos);
    let shift = sub(mat_mul_vec(turn, arm), arm);
    let columns = [0, 1, 2].map(|i| mat_mul_vec(turn, s.axis(i)));
    Shape { pos: sub(s.pos, shift), mat: std::array::from_fn(|i| columns[i % 3][i / 3]), ..*s }
}
