//! Frame sensors: position, orientation, velocity and acceleration of a body, geom, site or camera, and the forces at
//! a site.

use super::put;
use crate::dynamics::object::{self, ObjectFrame};
use crate::math::*;
use crate::model::{Fields, Model};
use crate::query;

/// The frame of the sensed object.
fn sensed_frame(m: &Model, d: &Fields, s: usize) -> Option<ObjectFrame> {
    object::frame(m, d, m.sensor_objtype[s], usize::try_from(m.sensor_objid[s]).ok()?)
}

/// The reference frame of the sensor; `None` for the world.
fn reference(m: &Model, d: &Fields, s: usize) -> Option<ObjectFrame> {
    object::frame(m, d, m.sensor_reftype[s], usize::try_from(m.sensor_refid[s]).ok()?)
}

pub(super) fn position(m: &Model, d: &mut Fields, s: usize, out: &mut [f64]) {
    let Some(f) = sensed_frame(m, d, s) else { return };
    put(out, reference(m, d, s).map_or(f.pos, |r| mat_t_mul_vec(&r.mat, sub(f.pos, r.pos))));
}

pub(super) fn orientation(m: &Model, d: &mut Fields, s: usize, out: &mut [f64]) {
    let orientation = |objtype: i32, id: i32| object::orientation(m, d, objtype, usize::try_from(id).ok()?);
    let Some(q) = orientation(m.sensor_objtype[s], m.sensor_objid[s]) else { return };
    let r = orientation(m.sensor_reftype[s], m.sensor_refid[s]);
    put(out, r.map_or(q, |r| quat_mul(quat_conj(r), q)));
}

/// Axis I of the sensed frame.
pub(super) fn axis<const I: usize>(m: &Model, d: &mut Fields, s: usize, out: &mut [f64]) {
    let Some(f) = sensed_frame(m, d, s) else { return };
    let axis = column(&f.mat, I);
    put(out, reference(m, d, s).map_or(axis, |r| mat_t_mul_vec(&r.mat, axis)));
}

/// Velocity in world axes, or relative to the reference frame, which may move and rotate.
fn velocity(m: &Model, d: &Fields, s: usize) -> Option<Spatial> {
    let f = sensed_frame(m, d, s)?;
    let v = object::velocity(m, d, &f, false);
    let Some(r) = reference(m, d, s) else { return Some(v) };
    let of_r = object::velocity(m, d, &r, false);
    let mut seen = sub(v, of_r);
    let carried = cross(angular(&of_r), sub(f.pos, r.pos));
    for i in 0..3 {
        seen[3 + i] -= carried[i];
    }
    Some(object::rotated_spatial(&r.mat, &seen))
}

pub(super) fn linear_velocity(m: &Model, d: &mut Fields, s: usize, out: &mut [f64]) {
    put(out, velocity(m, d, s).map_or([0.0; 3], |v| linear(&v)));
}

pub(super) fn angular_velocity(m: &Model, d: &mut Fields, s: usize, out: &mut [f64]) {
    put(out, velocity(m, d, s).map_or([0.0; 3], |v| angular(&v)));
}

pub(super) fn velocimeter(m: &Model, d: &mut Fields, s: usize, out: &mut [f64]) {
    put(out, sensed_frame(m, d, s).map_or([0.0; 3], |f| linear(&object::velocity(m, d, &f, true))));
}

pub(super) fn gyro(m: &Model, d: &mut Fields, s: usize, out: &mut [f64]) {
    put(out, sensed_frame(m, d, s).map_or([0.0; 3], |f| angular(&object::velocity(m, d, &f, true))));
}

pub(super) fn accelerometer(m: &Model, d: &mut Fields, s: usize, out: &mut [f64]) {
    put(out, sensed_frame(m, d, s).map_or([0.0; 3], |f| linear(&object::acceleration(m, d, &f, true))));
}

pub(super) fn linear_acceleration(m: &Model, d: &mut Fields, s: usize, out: &mut [f64]) {
    put(out, sensed_frame(m, d, s).map_or([0.0; 3], |f| linear(&object::acceleration(m, d, &f, false))));
}

pub(super) fn angular_acceleration(m: &Model, d: &mut Fields, s: usize, out: &mut [f64]) {
    put(out, sensed_frame(m, d, s).map_or([0.0; 3], |f| angular(&object::acceleration(m, d, &f, false))));
}

/// The torque about the site and the force that the parent exerts on the body of the site, in the axes of the site.
fn interaction(m: &Model, d: &Fields, s: usize) -> Spatial {
    let Some(f) = sensed_frame(m, d, s) else { return [0.0; 6] };
    let c = rows::<6>(&d.cfrc_int)[f.body];
    let com = rows::<3>(&d.subtree_com)[m.body_rootid[f.body] as usize];
    let t = sub(angular(&c), cross(sub(f.pos, com), linear(&c)));
    object::rotated_spatial(&f.mat, &[t[0], t[1], t[2], c[3], c[4], c[5]])
}

pub(super) fn force(m: &Model, d: &mut Fields, s: usize, out: &mut [f64]) {
    put(out, linear(&interaction(m, d, s)));
}

pub(super) fn torque(m: &Model, d: &mut Fields, s: usize, out: &mut [f64]) {
    put(out, angular(&interaction(m, d, s)));
}

pub(super) fn magnetometer(m: &Model, d: &mut Fields, s: usize, out: &mut [f64]) {
    put(out, sensed_frame(m, d, s).map_or([0.0; 3], |f| mat_t_mul_vec(&f.mat, m.opt.magnetic)));
}

/// 1 if the origin of the frame is inside the site, otherwise 0.
pub(super) fn inside_site(m: &Model, d: &mut Fields, s: usize, out: &mut [f64]) {
    let (Some(f), Ok(site)) = (sensed_frame(m, d, s), usize::try_from(m.sensor_refid[s])) else { return };
    put(out, [f64::from(u8::from(query::inside_site(m, d, site, f.pos)))]);
}
