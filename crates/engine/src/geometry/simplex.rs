//! The point of a simplex nearest to the origin, updated as support points are added: Wolfe, *Finding the nearest
//! point in a polytope*, Mathematical Programming 11 (1976).
//!
//! A corral is a simplex whose point nearest to the origin is in its interior. Adding a vertex enlarges it. Then the
//! weights move in a straight line to those of the nearest point of the affine hull. If a weight would become
//! negative on the way, its vertex is removed and the procedure repeats. Every added vertex reduces the distance.

use super::difference::Vertex;
use crate::math::*;

/// A simplex is degenerate if its determinant is below this fraction of the product of its edge lengths.
const FLAT: f64 = 1e-14;

/// Up to four vertices and the weights of the point nearest to the origin.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corral {
    vertex: [Vertex; 4],
    weight: [f64; 4],
    len: usize,
}

impl Corral {
    pub(super) fn new(first: Vertex) -> Corral {
        Corral { vertex: [first; 4], weight: [1.0, 0.0, 0.0, 0.0], len: 1 }
    }

    pub(super) fn vertices(&self) -> &[Vertex] {
        &self.vertex[..self.len]
    }

    /// The weighted mean of a property of the vertices.
    pub(super) fn mean(&self, point: impl Fn(&Vertex) -> Vec3) -> Vec3 {
        let terms = self.vertices().iter().zip(self.weight);
        terms.fold([0.0; 3], |sum, (v, w)| add_scaled(sum, point(v), w))
    }

    /// The point nearest to the origin.
    pub(super) fn point(&self) -> Vec3 {
        self.mean(|v| v.point)
    }

    /// Whether the simplex is a tetrahedron, which then contains the origin.
    pub(super) fn holds_origin(&self) -> bool {
        self.len == 4
    }

    /// Adds a vertex. It must lie on the origin's side of the plane through the nearest point x and normal to x. Returns
    /// `false` and changes nothing if, due to rounding, the distance does not decrease.
    pub(super) fn admit(&mut self, new: Vertex) -> bool {
        let before = *self;
        let Some(slot) = self.vertex.get_mut(self.len) else { return false };
        *slot = new;
        self.weight[self.len] = 0.0;
        self.len += 1;
        while self.len > 0 {
            let Some(goal) = self.nearest_of_affine_hull() else { break };
            let Some((leaves, step)) = self.first_to_leave(&goal) else {
                self.weight = goal;
                if self.holds_origin() || norm(self.point()) < norm(before.point()) {
                    return true;
                }
                break;
            };
            for (w, g) in self.weight.iter_mut().zip(goal) {
                *w += step * (g - *w);
            }
            self.len -= 1;
            self.vertex[leaves] = self.vertex[self.len];
            self.weight[leaves] = self.weight[self.len];
        }
        *self = before;
        false
    }

    /// The vertex whose weight is the first to reach zero on the way to the weights `goal`, and the fraction of the
    /// way at which it does.
    fn first_to_leave(&self, goal: &[f64; 4]) -> Option<(usize, f64)> {
        let mut first = None;
        let mut shortest = f64::INFINITY;
        for i in (0..self.len).filter(|&i| goal[i] <= 0.0) {
            let w = self.weight[i];
            let step = if w > 0.0 { w / (w - goal[i]) } else { 0.0 };
            if step < shortest {
                (first, shortest) = (Some((i, step)), step);
            }
        }
        first
    }

    /// Weights of the point nearest to the origin on the line, plane or space through the vertices. Returns `None` if
    /// the vertices are affinely dependent.
    fn nearest_of_affine_hull(&self) -> Option<[f64; 4]> {
        let [p, q, r, s] = self.vertex.map(|v| v.point);
        match self.len {
            1 => Some([1.0, 0.0, 0.0, 0.0]),
            2 => {
                let along = sub(q, p);
                let length2 = dot(along, along);
                let t = -dot(p, along) / length2;
                (length2 > 0.0).then_some([1.0 - t, t, 0.0, 0.0])
            }
            3 => barycentric([p, q, r], [0.0; 3]).map(|[a, b, c]| [a, b, c, 0.0]),
            _ => {
                let [u, v, w] = [sub(q, p), sub(r, p), sub(s, p)];
                let volume = dot(u, cross(v, w));
                let size2 = dot(u, u) * dot(v, v) * dot(w, w);
                // Cramer's rule for b u + c v + d w = -p.
                let [b, c, d] =
                    [dot(p, cross(w, v)), dot(p, cross(u, w)), dot(p, cross(v, u))].map(|x| x / volume);
                (volume * volume > FLAT * FLAT * size2).then_some([1.0 - b - c - d, b, c, d])
            }
        }
    }
}

/// Weights of the projection of a point onto the plane of a triangle. Returns `None` if the triangle is degenerate.
pub(super) fn barycentric([a, b, c]: [Vec3; 3], point: Vec3) -> Option<Vec3> {
    let (u, v) = (sub(b, a), sub(c, a));
    let normal = cross(u, v);
    let area2 = dot(normal, normal);
    let from = sub(point, a);
    let (s, t) = (dot(cross(from, v), normal) / area2, dot(cross(u, from), normal) / area2);
    (area2 > FLAT * FLAT * dot(u, u) * dot(v, v)).then_some([1.0 - s - t, s, t])
}
