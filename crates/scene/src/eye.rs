//! The camera: the ray of a pixel, and the pixel of a point.

use labspec_core::Model;
use labspec_core::math::{Vec3, add_scaled, dot, normalize, rows, sub};

/// Where a scene is seen from, as the lab format says it: the direction from the target to the camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Degrees, counter-clockwise seen from above, from the axis x.
    pub azimuth: f64,
    /// Degrees above the horizontal.
    pub elevation: f64,
    /// m; 1.9 extents of the model if it is not given.
    pub distance: Option<f64>,
    /// m, world frame; the centre of the model if it is not given.
    pub target: Option<Vec3>,
}

impl Default for Camera {
    fn default() -> Camera {
        Camera { azimuth: -55.0, elevation: 25.0, distance: None, target: None }
    }
}

/// Extents.
const DISTANCE: f64 = 1.9;
/// The vertical field of view of the free camera (`vis.global.fovy` of a model that does not set it), degrees.
const FOVY: f64 = 45.0;

/// A camera in the world.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Eye {
    pub(crate) position: Vec3,
    right: Vec3,
    up: Vec3,
    pub(crate) forward: Vec3,
    /// Half the height of the picture at distance 1.
    half_height: f64,
    /// Width and height of the picture, pixels.
    size: [f64; 2],
}

/// A half line: `from` + t `direction` for t ≥ 0.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ray {
    pub(crate) from: Vec3,
    /// A unit vector.
    pub(crate) direction: Vec3,
}

impl Ray {
    pub(crate) fn point(&self, t: f64) -> Vec3 {
        add_scaled(self.from, self.direction, t)
    }
}

impl Eye {
    pub(crate) fn new(camera: &Camera, m: &Model, size: [usize; 2]) -> Eye {
        let [azimuth, elevation] = [camera.azimuth, camera.elevation].map(f64::to_radians);
        let ((sa, ca), (se, ce)) = (libm::sincos(azimuth), libm::sincos(elevation));
        let forward = [-ce * ca, -ce * sa, -se];
        let distance = camera.distance.unwrap_or(DISTANCE * m.stat.extent);
        Eye {
            position: add_scaled(camera.target.unwrap_or(m.stat.center), forward, -distance),
            right: [-sa, ca, 0.0],
            up: [-se * ca, -se * sa, ce],
            forward,
            half_height: libm::tan(FOVY.to_radians() / 2.0),
            size: size.map(|n| n as f64),
        }
    }

    /// The ray through a point of the picture, in pixels from its upper left corner.
    pub(crate) fn ray(&self, x: f64, y: f64) -> Ray {
        let [width, height] = self.size;
        let scale = 2.0 * self.half_height / height;
        let sideways = add_scaled(self.forward, self.right, (x - width / 2.0) * scale);
        Ray {
            from: self.position,
            direction: normalize(add_scaled(sideways, self.up, (height / 2.0 - y) * scale)).0,
        }
    }

    /// The height of a pixel at a depth, m.
    pub(crate) fn pixel_at(&self, depth: f64) -> f64 {
        2.0 * self.half_height * depth / self.size[1]
    }

    /// How far a point on a plane moves from a pixel to the next one, to the right and upwards, m.
    pub(crate) fn pixel_derivatives(&self, ray: &Ray, normal: Vec3, point: Vec3) -> [Vec3; 2] {
        let pixel = self.pixel_at(self.depth(point));
        let along = dot(ray.direction, normal);
        let moved = |axis: Vec3| {
            let step = add_scaled(axis, ray.direction, -dot(axis, normal) / along);
            [step[0] * pixel, step[1] * pixel, step[2] * pixel]
        };
        [moved(self.right), moved(self.up)]
    }

    /// The distance of a point from the plane through the eye that faces forward, m.
    pub(crate) fn depth(&self, point: Vec3) -> f64 {
        dot(sub(point, self.position), self.forward)
    }

    /// The pixels that a ball can cover: the first and the end of its columns, then of its rows. All of them if the eye is near or inside.
    pub(crate) fn covered(&self, center: Vec3, radius: f64) -> [usize; 4] {
        let [width, height] = self.size;
        let all = [0, width as usize, 0, height as usize];
        let away = sub(center, self.position);
        let depth = dot(away, self.forward);
        if depth + radius <= 0.0 {
            return [0; 4];
        }
        let near = depth - radius;
        if near <= 0.05 * radius.max(1e-9) || !radius.is_finite() {
            return all;
        }
        // Seen from the eye, the ball is inside a square at its nearest depth or at its farthest one, whichever is larger.
        let scale = height / (2.0 * self.half_height);
        let range = |axis: Vec3, middle: f64, most: f64, sign: f64| {
            let offset = sign * dot(away, axis);
            let bounds = [offset - radius, offset + radius].map(|o| [o / near, o / (depth + radius)]);
            let low = bounds[0][0].min(bounds[0][1]) * scale + middle;
            let high = bounds[1][0].max(bounds[1][1]) * scale + middle;
            [(low.floor() - 1.0).clamp(0.0, most) as usize, (high.ceil() + 1.0).clamp(0.0, most) as usize]
        };
        let [left, right] = range(self.right, width / 2.0, width, 1.0);
        let [top, bottom] = range(self.up, height / 2.0, height, -1.0);
        [left, right, top, bottom]
    }
}

/// The position and the orientation of row `id` of two fields of the data.
pub(crate) fn pose(positions: &[f64], orientations: &[f64], id: usize) -> Option<(Vec3, [f64; 9])> {
    Some((*rows::<3>(positions).get(id)?, *rows::<9>(orientations).get(id)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn model() -> Model {
        Model::from_xml("<mujoco><worldbody><geom size='.1'/></worldbody></mujoco>").unwrap()
    }

    #[test]
    fn the_middle_of_the_picture_shows_the_target() {
        let camera = Camera { target: Some([1.0, 2.0, 3.0]), distance: Some(2.0), ..Camera::default() };
        let eye = Eye::new(&camera, &model(), [200, 100]);
        let ray = eye.ray(100.0, 50.0);
        let seen = ray.point(2.0);
        assert!((0..3).all(|i| (seen[i] - [1.0, 2.0, 3.0][i]).abs() < 1e-12), "{seen:?}");
        // From the front right, above: x − is to the left of y.
        assert!(
            eye.position[0] > 1.0 && eye.position[1] < 2.0 && eye.position[2] > 3.0,
            "{:?}",
            eye.position
        );
    }

    #[test]
    fn every_ray_that_meets_a_ball_is_within_the_pixels_it_covers() {
        let camera = Camera { target: Some([0.0; 3]), distance: Some(3.0), ..Camera::default() };
        let eye = Eye::new(&camera, &model(), [90, 60]);
        for (center, radius) in [
            ([0.0, 0.0, 0.0], 0.3),
            ([0.5, -1.0, 0.2], 0.4),
            ([1.6, -2.2, 1.2], 0.2),
            ([-4.0, 3.0, 0.0], 1.0),
        ] {
            let [left, right, top, bottom] = eye.covered(center, radius);
            for y in 0..60 {
                for x in 0..90 {
                    let ray = eye.ray(x as f64 + 0.5, y as f64 + 0.5);
                    let away = sub(center, ray.from);
                    let along = dot(away, ray.direction);
                    let meets = along > 0.0 && dot(away, away) - along * along <= radius * radius;
                    let inside = (left..right).contains(&x) && (top..bottom).contains(&y);
                    assert!(!meets || inside, "{center:?} {radius}: {x} {y}");
                }
            }
        }
    }
}
