//! Transmissions between frames: a wrench at a site, the pose of one site relative to another, a slider-crank.

use super::MomentRows;
use crate::dynamics::jacobian::dof_motion;
use crate::dynamics::walk::{Side, moving, moving_either};
use crate::math::*;
use crate::model::{Fields, Model};

fn site_body(m: &Model, s: usize) -> usize {
    m.site_bodyid[s] as usize
}

/// The rotation vector from a reference site to a site, in the frame of the reference site.
///
/// MuJoCo 3.14.0 composes the orientation of a site in the order site, body. This is the orientation of the site in the world
/// only if one of the two is the identity. Its length is then inconsistent with the velocity that its moment gives
/// (`docs/measured/parity.md`).
fn relative_rotation(m: &Model, d: &Fields, sites: [usize; 2]) -> Vec3 {
    let [s, reference] =
        sites.map(|s| quat_mul(rows::<4>(&d.xquat)[site_body(m, s)], rows::<4>(&m.site_quat)[s]));
    quat_to_vel(quat_mul(quat_conj(reference), s))
}

/// The first and the last three numbers of a gear.
fn parts([a, b, c, d, e, f]: [f64; 6]) -> (Vec3, Vec3) {
    ([a, b, c], [d, e, f])
}

/// A force and torque along the axes of site `s`. The length is zero.
pub(super) fn site(m: &Model, d: &Fields, s: usize, gear: [f64; 6], out: &mut MomentRows) -> f64 {
    let mat = &rows::<9>(&d.site_xmat)[s];
    let (force, torque) = parts(gear);
    let (force, torque) = (mat_mul_vec(mat, force), mat_mul_vec(mat, torque));
    let point = rows::<3>(&d.site_xpos)[s];
    let start = out.cursor;
    for k in moving(m, site_body(m, s)) {
        let (turn, shift) = dof_motion(m, d, k, point);
        out.push(k, dot(shift, force) + dot(turn, torque));
    }
    out.reverse_from(start);
    0.0
}

/// Position and rotation of a site in the frame of a reference site, along a gear. A common motion of both sites does not change
/// the length.
pub(super) fn pose_in_reference_frame(
    m: &Model,
    d: &Fields,
    [s, reference]: [usize; 2],
    gear: [f64; 6],
    out: &mut MomentRows,
) -> f64 {
    let mat = &rows::<9>(&d.site_xmat)[reference];
    let points = [s, reference].map(|s| rows::<3>(&d.site_xpos)[s]);
    let (along, about) = parts(gear);
    let mut length = 0.0;
    if along != [0.0; 3] {
        length += dot(mat_t_mul_vec(mat, sub(points[0], points[1])), along);
    }
    if about != [0.0; 3] {
        length += dot(relative_rotation(m, d, [s, reference]), about);
    }
    let (force, torque) = (mat_mul_vec(mat, along), mat_mul_vec(mat, about));
    let bodies = [s, reference].map(|s| site_body(m, s));
    let start = out.cursor;
    for (k, side) in moving_either(m, bodies) {
        let (point, sign) = match side {
            Side::First => (points[0], 1.0),
            Side::Second => (points[1], -1.0),
            Side::Both => continue,
        };
        let (turn, shift) = dof_motion(m, d, k, point);
        out.push(k, sign * (dot(shift, force) + dot(turn, torque)));
    }
    out.reverse_from(start);
    length
}

/// Component `axis` of the rotation vector from a reference site to a site. Its moment is a torque about an axis of
/// the site.
pub(super) fn orientation(
    m: &Model,
    d: &Fields,
    [s, reference]: [usize; 2],
    axis: usize,
    out: &mut MomentRows,
) -> f64 {
    let direction = column(&rows::<9>(&d.site_xmat)[s], axis);
    let start = out.cursor;
    for (k, side) in moving_either(m, [s, reference].map(|s| site_body(m, s))) {
        let sign = match side {
            Side::First => 1.0,
            Side::Second => -1.0,
            Side::Both => continue,
        };
        out.push(k, sign * dot(dof_motion(m, d, k, [0.0; 3]).0, direction));
    }
    out.reverse_from(start);
    relative_rotation(m, d, [s, reference])[axis]
}

/// A rod of length r between a crank and a slider, which moves along the z axis a of its site. With the vector v from the
/// slider's site to the crank, the position of the slider is
///
/// > l = a·v - √((a·v)² + r² - v·v)
///
/// or a·v, the nearest possible position, if the rod is too short.
pub(super) fn crank(
    m: &Model,
    d: &Fields,
    [crank, slider]: [usize; 2],
    rod: f64,
    gear: f64,
    out: &mut MomentRows,
) -> f64 {
    let axis = column(&rows::<9>(&d.site_xmat)[slider], 2);
    let points = [crank, slider].map(|s| rows::<3>(&d.site_xpos)[s]);
    let v = sub(points[0], points[1]);
    let along = dot(v, axis);
    let square = along * along + rod * rod - dot(v, v);
    // Derivatives of the length with respect to v and to the axis.
    let (length, by_v, by_axis) = if square <= 0.0 {
        (along, axis, v)
    } else {
        let root = square.sqrt();
        let slope = 1.0 - along / root;
        (along - root, add_scaled(scale(axis, slope), v, 1.0 / root), scale(v, slope))
    };
    let start = out.cursor;
    for (k, side) in moving_either(m, [crank, slider].map(|s| site_body(m, s))) {
        let change = match side {
            Side::First => dot(by_v, dof_motion(m, d, k, points[0]).1),
            Side::Second => {
                let (turn, shift) = dof_motion(m, d, k, points[1]);
                dot(by_axis, cross(turn, axis)) - dot(by_v, shift)
            }
            // A degree of freedom that moves both does not move the slider relative to its site.
            Side::Both => continue,
        };
        out.push(k, change * gear);
    }
    out.reverse_from(start);
    length * gear
}
