//! Line-of-sight sensors: rangefinders of a site or for every pixel of a camera, and the position of a site in the
//! image of a camera.
//!
//! A pinhole camera looks along -z with y up. Pixels are counted from the upper left corner (MuJoCo's documentation,
//! element "camera").

use super::data_layout;
use super::data_layout::RAY_DATA;
use super::put;
use crate::dynamics::object::{self, ObjectFrame};
use crate::kinds::projection;
use crate::math::*;
use crate::model::{Fields, Model, Obj};
use crate::query::{self, RayFilter};

/// A ray: its start (m) and its unit direction, world frame.
struct SensorRay {
    from: Vec3,
    along: Vec3,
}

pub(super) fn rangefinder(m: &Model, d: &mut Fields, s: usize, out: &mut [f64]) {
    let Ok(id) = usize::try_from(m.sensor_objid[s]) else { return };
    let Some(f) = object::frame(m, d, m.sensor_objtype[s], id) else { return };
    let mask = m.sensor_intprm[3 * s];
    if m.sensor_objtype[s] != Obj::Camera as i32 {
        let ray = SensorRay { from: f.pos, along: column(&f.mat, 2) };
        return cast(m, d, &ray, &f, false, mask, out);
    }
    let camera = CameraOptics::from_model(m, id);
    let [width, _] = camera.resolution;
    let size = data_layout::size(&RAY_DATA, mask).max(1);
    for (pixel, out) in out.chunks_exact_mut(size).enumerate() {
        if d.meter.over() {
            return;
        }
        let (row, col) = (pixel / width.max(1), pixel % width.max(1));
        cast(m, d, &camera.ray(&f, row, col), &f, true, mask, out);
    }
}

/// Writes the data of a ray from the frame `f`. If it hits nothing, distance and depth are -1; direction, point and
/// normal are zero. The body of the sensor itself is not hit. The depth of a camera is measured along its axis, that
/// of a site along the ray.
fn cast(
    m: &Model,
    d: &mut Fields,
    ray: &SensorRay,
    f: &ObjectFrame,
    in_image: bool,
    mask: i32,
    out: &mut [f64],
) {
    let filter = RayFilter { exclude_body: Some(f.body), ..RayFilter::default() };
    let none = [0.0; 3];
    let mut work = 0;
    let hit = query::counted_ray(m, d, ray.from, ray.along, &filter, &mut work);
    d.meter.add(work);
    let (dist, dir, point, normal, depth) = match hit {
        Some(hit) => {
            let point = add_scaled(ray.from, ray.along, hit.distance);
            let ahead = -dot(sub(point, f.pos), column(&f.mat, 2));
            (hit.distance, ray.along, point, hit.normal, if in_image { ahead } else { hit.distance })
        }
        None => (-1.0, none, none, none, -1.0),
    };
    data_layout::write(mask, &[&[dist], &dir, &ray.from, &point, &normal, &[depth]], out);
}

/// The optics of a camera, in pixels.
struct CameraOptics {
    resolution: [usize; 2],
    /// Focal lengths.
    focal: [f64; 2],
    /// The point of the image on the optical axis.
    principal: [f64; 2],
    /// Offset of the centre of the image from the optical axis, to the right and down.
    shift: [f64; 2],
    /// Side length of the square field of view of an orthographic camera, m.
    extent: Option<f64>,
}

impl CameraOptics {
    fn from_model(m: &Model, id: usize) -> CameraOptics {
        let size = rows::<2>(&m.cam_sensorsize)[id];
        let [fx, fy, px, py] = rows::<4>(&m.cam_intrinsic)[id];
        // An image with a negative size has no pixels.
        let resolution = [m.cam_resolution[2 * id], m.cam_resolution[2 * id + 1]].map(|n| n.max(0) as usize);
        let [width, height] = resolution.map(|n| n as f64);
        // Converts lengths on the image sensor to pixels, in single precision, with which MuJoCo stores camera
        // intrinsics.
        let pixels =
            |length: f64, axis: usize| f64::from(length as f32 / size[axis] as f32 * resolution[axis] as f32);
        let (focal, principal, shift) = if size[0] != 0.0 && size[1] != 0.0 {
            let principal = [pixels(px, 0), pixels(py, 1)];
            ([pixels(fx, 0), pixels(fy, 1)], principal, principal)
        } else {
            let f = 0.5 / libm::tan(m.cam_fovy[id] * std::f64::consts::PI / 360.0) * height;
            ([f, f], [width / 2.0, height / 2.0], [0.0; 2])
        };
        CameraOptics {
            resolution,
            focal,
            principal,
            shift,
            extent: (m.cam_projection[id] == projection::ORTHOGRAPHIC).then_some(m.cam_fovy[id]),
        }
    }

    /// The ray through the centre of a pixel, for a camera with the frame `f`.
    fn ray(&self, f: &ObjectFrame, row: usize, col: usize) -> SensorRay {
        let (u, v) = (col as f64 + 0.5, row as f64 + 0.5);
        if let Some(extent) = self.extent {
            let [width, height] = self.resolution.map(|n| n as f64);
            let from = [(u / width - 0.5) * extent, (0.5 - v / height) * extent, 0.0];
            let along = scale(column(&f.mat, 2), -1.0);
            return SensorRay { from: add(f.pos, mat_mul_vec(&f.mat, from)), along };
        }
        let local = [(u - self.principal[0]) / self.focal[0], -(v - self.principal[1]) / self.focal[1], -1.0];
        SensorRay { from: f.pos, along: normalize(mat_mul_vec(&f.mat, local)).0 }
    }
}

/// Pixel coordinates of a site: its direction times the focal lengths, relative to the point where the optical axis
/// meets the image.
///
/// The image that MuJoCo 3.14.0 draws is shifted to the right and down by the principal point (`frustum_center` and
/// `frustum_top` of `mjvGLCamera`). MuJoCo's sensor ignores this shift; ours includes it.
pub(super) fn camera_projection(m: &Model, d: &mut Fields, s: usize, out: &mut [f64]) {
    let (Ok(site), Ok(id)) = (usize::try_from(m.sensor_objid[s]), usize::try_from(m.sensor_refid[s])) else {
        return;
    };
    let Some(f) = object::frame(m, d, Obj::Camera as i32, id) else { return };
    let camera = CameraOptics::from_model(m, id);
    let [x, y, z] = mat_t_mul_vec(&f.mat, sub(rows::<3>(&d.site_xpos)[site], f.pos));
    // A point in the plane of the camera has no image: its pixel is placed far outside.
    let depth = if z.abs() < MINVAL { MINVAL.copysign(z) } else { z };
    let [width, height] = camera.resolution.map(|n| n as f64);
    let [fx, fy] = camera.focal;
    let [right, down] = camera.shift;
    put(out, [width / 2.0 - right - fx * x / depth, height / 2.0 - down + fy * y / depth]);
}
