//! Rays against triangles of meshes and height fields.

use super::ray::{Crossing, Hit, PARALLEL, Ray, crossings, nearer};
use super::{HeightField, Mesh};
use crate::math::*;

/// Work units of a ray against a triangle.
const TRIANGLE: u64 = 10;

/// A ray with two axes normal to it. Triangles are projected along the ray onto these axes.
struct RayFrame<'a> {
    ray: &'a Ray,
    across: [Vec3; 2],
}

impl RayFrame<'_> {
    fn new(ray: &Ray) -> RayFrame<'_> {
        let v = ray.along;
        let [x, y, z] = v.map(f64::abs);
        // The start vector has no component along the largest component of the ray, so it is never parallel to the
        // ray.
        let start = if x >= y && x >= z {
            [0.0, 1.0, 1.0]
        } else if y >= z {
            [1.0, 0.0, 1.0]
        } else {
            [1.0, 1.0, 0.0]
        };
        let up = unit_vector(add_scaled(start, v, -dot(v, start) / dot(v, v))).0;
        let side = unit_vector(cross(up, v)).0;
        RayFrame { ray, across: [side, up] }
    }

    /// Distance at which the ray crosses a triangle, negative behind its start, and the normal (a - c) × (b - c).
    fn triangle(&self, [a, b, c]: [Vec3; 3]) -> Option<(f64, Vec3)> {
        let flat = |p: Vec3| self.across.map(|axis| dot(axis, sub(p, self.ray.from)));
        let (pa, pb, pc) = (flat(a), flat(b), flat(c));
        // All corners are on one side of the ray.
        for i in 0..2 {
            let three = [pa[i], pb[i], pc[i]];
            if three.iter().all(|&x| x > 0.0) || three.iter().all(|&x| x < 0.0) {
                return None;
            }
        }
        // The crossing point is c + s (a - c) + t (b - c).
        let (u, w) = (sub(pa, pc), sub(pb, pc));
        let det = u[0] * w[1] - w[0] * u[1];
        // The ray is parallel to the plane of the triangle.
        if det.abs() <= PARALLEL * (dot2(u, u) * dot2(w, w)).sqrt() {
            return None;
        }
        let s = (-w[1] * pc[0] + w[0] * pc[1]) / det;
        let t = (u[1] * pc[0] - u[0] * pc[1]) / det;
        if s < 0.0 || t < 0.0 || s + t > 1.0 {
            return None;
        }
        let normal = cross(sub(a, c), sub(b, c));
        let speed = dot(self.ray.along, normal);
        if speed.abs() <= PARALLEL * norm(self.ray.along) * norm(normal) {
            return None;
        }
        Some((-dot(sub(self.ray.from, c), normal) / speed, normal))
    }
}

fn dot2(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// The nearest triangle of a mesh. `size` contains the half sizes of a bounding box centred at the origin.
pub(super) fn mesh(mesh: &Mesh, size: Vec3, ray: &Ray, work: &mut u64) -> Option<Hit> {
    crossings(size, ray).filter(|[_, leaves]| leaves.distance >= 0.0)?;
    let sight = RayFrame::new(ray);
    *work += TRIANGLE * mesh.face.len() as u64;
    let mut best = None;
    for face in mesh.face {
        let corners = face.map(|v| mesh.vertex(v as usize));
        if let Some((x, normal)) = sight.triangle(corners) {
            nearer(&mut best, x, || unit_vector(normal).0);
        }
    }
    best
}

/// A ray against a height field: the box below it, the triangles of its surface, and the side walls between them.
pub(super) fn field(field: &HeightField, ray: &Ray, work: &mut u64) -> Option<Hit> {
    let [sx, sy, top, base] = field.size;
    let shifted = |z: f64| Ray { from: sub(ray.from, [0.0, 0.0, z]), ..*ray };
    let mut best = None;
    for c in crossings([sx, sy, 0.5 * base], &shifted(-0.5 * base)).into_iter().flatten() {
        nearer(&mut best, c.distance, || c.normal());
    }
    let top = crossings([sx, sy, 0.5 * top], &shifted(0.5 * top));
    let Some(walls) = top.filter(|[_, leaves]| leaves.distance >= 0.0) else { return best };
    // The part of the ray in the bounding box of the surface; it begins at the start of the ray if that is inside.
    let ends = walls.map(|c| ray.at(c.distance.max(0.0)));
    let sight = RayFrame::new(ray);
    let (cols, rows) = (cells(ends, sx, 0, field.ncol), cells(ends, sy, 1, field.nrow));
    *work += 2 * TRIANGLE * (rows.len() as u64 * cols.len() as u64);
    for r in rows {
        for c in cols.clone() {
            let (low, high) = (field.point(r, c), field.point(r + 1, c + 1));
            for triangle in [[low, high, field.point(r, c + 1)], [low, high, field.point(r + 1, c)]] {
                if let Some((x, normal)) = sight.triangle(triangle) {
                    let up = if normal[2] < 0.0 { -1.0 } else { 1.0 };
                    nearer(&mut best, x, || scale(unit_vector(normal).0, up));
                }
            }
        }
    }
    for c in walls.into_iter().filter(|c| c.axis < 2 && c.distance >= 0.0) {
        if best.is_none_or(|b| c.distance < b.distance) && below_rim(field, ray.at(c.distance), &c) {
            best = Some(Hit { distance: c.distance, normal: c.normal() });
        }
    }
    best
}

/// The grid cells along axis `i` that a segment crosses, and one more on each side.
fn cells(ends: [Vec3; 2], half: f64, i: usize, samples: usize) -> std::ops::Range<usize> {
    let step = 2.0 * half / (samples as f64 - 1.0);
    let [a, b] = ends.map(|p| (p[i] + half) / step);
    // Casts saturate, so a ray from far away stays within the grid.
    let first = (a.min(b).floor() - 1.0).max(0.0) as usize;
    let last = ((a.max(b).ceil() + 1.0).max(0.0) as usize).min(samples.saturating_sub(1));
    first..last
}

/// Whether a point of a side wall is below the edge of the surface.
fn below_rim(field: &HeightField, on: Vec3, wall: &Crossing) -> bool {
    let along = 1 - wall.axis;
    let samples = if along == 1 { field.nrow } else { field.ncol };
    let y = (on[along] + field.size[along]) / field.step()[along];
    let cell = clamp(y.floor(), 0.0, (samples as f64 - 2.0).max(0.0));
    let height = |k: usize| {
        let (row, col) = match (wall.axis, wall.side < 0.0) {
            (0, true) => (k, 0),
            (0, false) => (k, field.ncol - 1),
            (_, true) => (0, k),
            (_, false) => (field.nrow - 1, k),
        };
        field.data[row * field.ncol + col]
    };
    let k = cell as usize;
    on[2] / field.size[2] < height(k) * (cell + 1.0 - y) + height(k + 1) * (y - cell)
}
