//! Where a ray meets a solid. Every shape but the plane is closed, and seen from outside only.

use crate::eye::Ray;
use crate::mesh::Triangles;
use labspec_core::math::{Vec3, add_scaled, dot, mat_mul_vec, mat_t_mul_vec, normalize, sub};
use std::sync::Arc;

/// A shape of size 1, which the scale of a solid stretches; triangles are in m.
#[derive(Clone, Debug)]
pub(crate) enum Shape {
    /// The square from −1 to 1 in the plane z = 0.
    Plane,
    /// The cube from −1 to 1.
    Box,
    /// The ball of radius 1.
    Ball,
    /// A ball of radius 1 that is moved along z from one end to the other, each this far from the middle, m.
    Capsule(f64),
    /// Radius 1, from z = −1 to 1.
    Cylinder,
    /// Its base at z = 0 has radius 1, its tip is at z = 1.
    Cone,
    /// A mesh or a height field.
    Mesh(Arc<Triangles>),
}

/// A shape in the world.
#[derive(Clone, Debug)]
pub(crate) struct Placed {
    pub(crate) shape: Shape,
    /// m, world frame.
    pub(crate) position: Vec3,
    pub(crate) rotation: [f64; 9],
    /// m along the axes of the shape.
    pub(crate) scale: Vec3,
}

/// Where a ray meets a shape.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hit {
    /// The distance along the ray, m.
    pub(crate) distance: f64,
    /// The point in the frame of the shape, m, and in the shape of size 1.
    pub(crate) local: Vec3,
    pub(crate) unit: Vec3,
    /// The outward normal in the world, of length 1.
    pub(crate) normal: Vec3,
    /// Texture coordinates of a mesh.
    pub(crate) uv: [f64; 2],
}

/// Where a ray meets a shape in the frame of the shape of size 1: the distance, the normal there, texture coordinates.
type UnitHit = (f64, Vec3, [f64; 2]);

impl Placed {
    /// Where a ray first meets the shape between two distances, m.
    pub(crate) fn hit(&self, ray: &Ray, from: f64, to: f64) -> Option<Hit> {
        let start = mat_t_mul_vec(&self.rotation, sub(ray.from, self.position));
        let direction = mat_t_mul_vec(&self.rotation, ray.direction);
        // A capsule is stretched by its radius only, which its half length is measured in.
        let scale = self.scale;
        let divided = |v: Vec3| [v[0] / scale[0], v[1] / scale[1], v[2] / scale[2]];
        let (o, d) = (divided(start), divided(direction));
        let within = |t: f64| t > from && t < to;
        let (distance, normal, uv) = match &self.shape {
            Shape::Plane => hit_plane(o, d),
            Shape::Box => cube(o, d),
            Shape::Ball => ball(o, d, [0.0; 3]),
            Shape::Capsule(half) => capsule(o, d, half / scale[2]),
            Shape::Cylinder => cylinder(o, d),
            Shape::Cone => cone(o, d),
            Shape::Mesh(triangles) => triangles.hit(o, d, from, to),
        }
        .filter(|(t, ..)| within(*t))?;
        let local = add_scaled(start, direction, distance);
        let mut unit = add_scaled(o, d, distance);
        if let Shape::Capsule(half) = self.shape {
            let end = half / scale[2];
            unit[2] -= if unit[2] > 0.0 { end } else { -end };
        }
        let normal = normalize(mat_mul_vec(&self.rotation, divided(normal))).0;
        Some(Hit { distance, local, unit, normal, uv })
    }

    /// A ball around the shape: its middle in the world and its radius, m.
    pub(crate) fn bound(&self) -> (Vec3, f64) {
        let [x, y, z] = self.scale;
        let radius = match &self.shape {
            Shape::Plane => libm::hypot(x, y),
            Shape::Box => libm::hypot(libm::hypot(x, y), z),
            Shape::Ball => x.max(y).max(z),
            Shape::Capsule(half) => x + half,
            Shape::Cylinder | Shape::Cone => libm::hypot(x.max(y), z),
            Shape::Mesh(triangles) => {
                let (middle, radius) = triangles.bound();
                return (add_scaled(self.position, mat_mul_vec(&self.rotation, middle), 1.0), radius);
            }
        };
        (self.position, radius)
    }
}

fn hit_plane(o: Vec3, d: Vec3) -> Option<UnitHit> {
    let t = -o[2] / d[2];
    let [x, y, _] = add_scaled(o, d, t);
    (x.abs() <= 1.0 && y.abs() <= 1.0).then_some((t, [0.0, 0.0, 1.0], [0.0; 2]))
}

fn cube(o: Vec3, d: Vec3) -> Option<UnitHit> {
    let (mut enter, mut leave, mut axis) = (f64::NEG_INFINITY, f64::INFINITY, 0);
    for i in 0..3 {
        if d[i] == 0.0 {
            if o[i].abs() > 1.0 {
                return None;
            }
            continue;
        }
        let t = (-d[i].signum() - o[i]) / d[i];
        if t > enter {
            (enter, axis) = (t, i);
        }
        leave = leave.min((d[i].signum() - o[i]) / d[i]);
    }
    let mut normal = [0.0; 3];
    normal[axis] = -d[axis].signum();
    (enter <= leave).then_some((enter, normal, [0.0; 2]))
}

/// The smaller root of a t² + 2 b t + c = 0.
fn first_root(a: f64, b: f64, c: f64) -> Option<f64> {
    let discriminant = b * b - a * c;
    (discriminant >= 0.0 && a > 0.0).then(|| (-b - discriminant.sqrt()) / a)
}

fn ball(o: Vec3, d: Vec3, center: Vec3) -> Option<UnitHit> {
    let from = sub(o, center);
    let t = first_root(dot(d, d), dot(from, d), dot(from, from) - 1.0)?;
    Some((t, add_scaled(from, d, t), [0.0; 2]))
}

/// Where a ray enters x² + y² = 1.
fn hit_tube(o: Vec3, d: Vec3) -> Option<f64> {
    first_root(d[0] * d[0] + d[1] * d[1], o[0] * d[0] + o[1] * d[1], o[0] * o[0] + o[1] * o[1] - 1.0)
}

fn capsule(o: Vec3, d: Vec3, half: f64) -> Option<UnitHit> {
    let side = hit_tube(o, d).map(|t| (t, add_scaled(o, d, t))).filter(|(_, p)| p[2].abs() <= half);
    if let Some((t, p)) = side {
        return Some((t, [p[0], p[1], 0.0], [0.0; 2]));
    }
    let end = |sign: f64| ball(o, d, [0.0, 0.0, sign * half]).filter(|(_, n, _)| n[2] * sign >= 0.0);
    nearer(end(1.0), end(-1.0))
}

fn nearer(a: Option<UnitHit>, b: Option<UnitHit>) -> Option<UnitHit> {
    match (a, b) {
        (Some(a), Some(b)) => Some(if a.0 <= b.0 { a } else { b }),
        (a, b) => a.or(b),
    }
}

fn cylinder(o: Vec3, d: Vec3) -> Option<UnitHit> {
    let side = hit_tube(o, d).map(|t| (t, add_scaled(o, d, t))).filter(|(_, p)| p[2].abs() <= 1.0);
    if let Some((t, p)) = side {
        return Some((t, [p[0], p[1], 0.0], [0.0; 2]));
    }
    hit_cap(o, d, -d[2].signum(), -d[2].signum())
}

/// The disc of radius 1 at a height, whose normal points up or down.
fn hit_cap(o: Vec3, d: Vec3, height: f64, normal: f64) -> Option<UnitHit> {
    let t = (height - o[2]) / d[2];
    let [x, y, _] = add_scaled(o, d, t);
    (normal * d[2] < 0.0 && x * x + y * y <= 1.0).then_some((t, [0.0, 0.0, normal], [0.0; 2]))
}

fn cone(o: Vec3, d: Vec3) -> Option<UnitHit> {
    // x² + y² = (1 − z)².
    let rest = 1.0 - o[2];
    let a = d[0] * d[0] + d[1] * d[1] - d[2] * d[2];
    let b = o[0] * d[0] + o[1] * d[1] + rest * d[2];
    let c = o[0] * o[0] + o[1] * o[1] - rest * rest;
    let root = (b * b - a * c).max(0.0).sqrt();
    let side = |t: f64| {
        let [x, y, z] = add_scaled(o, d, t);
        let normal = [x, y, 1.0 - z];
        let seen = (0.0..=1.0).contains(&z) && dot(normal, d) < 0.0;
        (b * b >= a * c && seen).then_some((t, normal, [0.0; 2]))
    };
    nearer(nearer(side((-b - root) / a), side((-b + root) / a)), hit_cap(o, d, 0.0, -1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    const UPRIGHT: [f64; 9] = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];

    /// A ray from x = −5 along x at a height.
    fn along_x(y: f64, z: f64) -> Ray {
        Ray { from: [-5.0, y, z], direction: [1.0, 0.0, 0.0] }
    }

    fn first_hit(shape: Shape, scale: Vec3, ray: &Ray) -> Option<(f64, Vec3)> {
        let placed = Placed { shape, position: [0.0; 3], rotation: UPRIGHT, scale };
        placed.hit(ray, 1e-9, 100.0).map(|hit| (hit.distance, hit.normal))
    }

    #[test]
    fn distances_and_normals_are_those_of_geometry() {
        let left = [-1.0, 0.0, 0.0];
        assert_eq!(first_hit(Shape::Box, [2.0, 1.0, 1.0], &along_x(0.5, 0.5)), Some((3.0, left)));
        assert_eq!(first_hit(Shape::Ball, [1.0; 3], &along_x(0.0, 0.0)), Some((4.0, left)));
        assert_eq!(first_hit(Shape::Ball, [2.0, 1.0, 1.0], &along_x(0.0, 0.0)), Some((3.0, left)));
        assert_eq!(first_hit(Shape::Cylinder, [0.5, 0.5, 2.0], &along_x(0.0, 1.9)), Some((4.5, left)));
        assert_eq!(first_hit(Shape::Cylinder, [0.5, 0.5, 2.0], &along_x(0.0, 2.1)), None);
        assert_eq!(first_hit(Shape::Capsule(1.0), [0.5; 3], &along_x(0.0, 0.9)), Some((4.5, left)));
        let (t, n) = first_hit(Shape::Capsule(1.0), [0.5; 3], &along_x(0.0, 1.3)).unwrap();
        assert!((t - 4.6).abs() < 1e-12 && (n[2] - 0.6).abs() < 1e-12, "{t} {n:?}");
        let (t, n) = first_hit(Shape::Cone, [1.0, 1.0, 2.0], &along_x(0.0, 1.0)).unwrap();
        assert!((t - 4.5).abs() < 1e-12 && n[0] < 0.0 && n[2] > 0.0, "{t} {n:?}");
        assert_eq!(first_hit(Shape::Cone, [1.0, 1.0, 2.0], &along_x(0.0, 2.1)), None);
    }

    #[test]
    fn the_inside_of_a_shape_is_not_seen() {
        for shape in [Shape::Box, Shape::Ball, Shape::Cylinder, Shape::Capsule(0.5)] {
            let inside = Ray { from: [0.0; 3], direction: [0.6, 0.0, 0.8] };
            assert!(first_hit(shape, [1.0; 3], &inside).is_none());
        }
    }

    #[test]
    fn every_hit_is_within_the_bound() {
        let shapes =
            [Shape::Box, Shape::Ball, Shape::Cylinder, Shape::Cone, Shape::Capsule(0.7), Shape::Plane];
        for shape in shapes {
            let placed =
                Placed { shape, position: [0.3, 0.1, -0.2], rotation: UPRIGHT, scale: [0.5, 0.5, 0.9] };
            let placed = match placed.shape {
                Shape::Capsule(_) => Placed { scale: [0.5; 3], ..placed },
                _ => placed,
            };
            let (center, radius) = placed.bound();
            let mut hits = 0;
            for i in 0..2000 {
                let a = f64::from(i) * 0.7;
                let aim = [a.sin() * 1.5, (a * 1.3).cos() * 1.5, (a * 0.37).sin() * 1.5];
                let from = [-4.0, 1.0, 2.0];
                let ray = Ray { from, direction: normalize(sub(aim, from)).0 };
                let Some(hit) = placed.hit(&ray, 0.0, f64::INFINITY) else { continue };
                hits += 1;
                let away = sub(ray.point(hit.distance), center);
                assert!(dot(away, away).sqrt() <= radius + 1e-9, "{placed:?}");
                let faces = matches!(placed.shape, Shape::Plane) || dot(hit.normal, ray.direction) <= 1e-9;
                assert!(faces, "{placed:?} {hit:?}");
            }
            assert!(hits > 50, "{hits} {placed:?}");
        }
    }
}
