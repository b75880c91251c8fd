//! Penetration depth of convex bodies by an expanding polytope.
//!
//! van den Bergen, *Collision Detection in Interactive 3D Environments* (2003), section 4.3.8: a polytope inside the
//! Minkowski difference holds the origin; its nearest face gives a lower bound of the depth, the support point
//! beyond that face an upper bound, and the polytope grows by that point until the two agree.

use super::gjk::{Gjk, Limits, Vertex, support};
use super::simplex::{affine, det, origin_on_plane};
use super::support::Body;
use crate::math::*;

/// Polytopes with fewer iterations than this still have room for so many.
const MIN_ROOM: usize = 170;

/// A squared distance that is none.
const TINY: f64 = MINVAL * MINVAL;

/// A face of the polytope.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Face {
    verts: [u32; 3],
    /// Neighbours across the edges 01, 12, 20.
    adjacent: [u32; 3],
    /// The origin projected on its plane.
    foot: Vec3,
    /// |foot|²
    dist2: f64,
    /// Where it is in the list of candidates.
    state: State,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum State {
    Candidate(u32),
    /// Part of the surface, too far to be the nearest.
    Far,
    /// Inside the grown polytope.
    Gone,
}

/// Room of the algorithm, kept between calls so that they do not allocate.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Scratch {
    verts: Vec<Vertex>,
    faces: Vec<Face>,
    /// Faces that may be the nearest.
    candidates: Vec<u32>,
    /// The border of what the new vertex sees: hidden faces and their edge on it.
    horizon: Vec<(u32, u8)>,
    /// Edges still to be crossed while the border is found.
    pending: Vec<(u32, u8)>,
    /// Work done with it.
    pub(crate) cost: u64,
}

/// The nearest face: its corners, its distance and the points of both bodies there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Deepest {
    pub(super) support: [Vertex; 3],
    pub(super) depth: f64,
    pub(super) witness: [Vec3; 2],
}

/// Why there is no depth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Shallow {
    /// The origin is on the border of the simplex: the bodies touch.
    Border,
    /// The polytope degenerated.
    Lost,
}

/// The depth of two bodies whose difference holds the origin in or near the simplex that GJK ended with.
pub(super) fn epa(
    found: &Gjk,
    a: &mut Body,
    b: &mut Body,
    limits: Limits,
    p: &mut Scratch,
) -> Result<Deepest, Shallow> {
    p.clear();
    let s = &found.simplex;
    match found.size {
        2 => p.start_segment(s[0], s[1], a, b),
        3 => p.start_triangle([s[0], s[1], s[2]], a, b),
        _ => p.start_tetrahedron(*s, a, b),
    }
    .ok_or(Shallow::Border)?;
    let face = p.expand(a, b, limits).ok_or(Shallow::Lost)?;
    let f = p.faces[face as usize];
    let corners = f.verts.map(|v| p.verts[v as usize]);
    let [u, v, w] = corners.map(|c| c.point);
    let coef = affine(u, v, w, f.foot);
    let on = |of: fn(&Vertex) -> Vec3| super::simplex::combine(&coef, corners.iter().map(of));
    Ok(Deepest { support: corners, depth: f.dist2.sqrt(), witness: [on(|c| c.on_a), on(|c| c.on_b)] })
}

impl Scratch {
    fn clear(&mut self) {
        self.verts.clear();
        self.faces.clear();
        self.candidates.clear();
    }

    fn add_vertex(&mut self, v: Vertex) -> u32 {
        self.verts.push(v);
        self.verts.len() as u32 - 1
    }

    /// The support point in a direction of length `n`.
    fn add_support(&mut self, a: &mut Body, b: &mut Body, dir: Vec3, n: f64) -> u32 {
        let unit = if n > MINVAL { dir.map(|x| x / n) } else { [1.0, 0.0, 0.0] };
        self.add_vertex(support(a, b, unit))
    }

    fn point(&self, v: u32) -> Vec3 {
        self.verts[v as usize].point
    }

    /// Adds a face; its squared distance from the origin, zero when it is no triangle.
    fn add_face(&mut self, verts: [u32; 3], adjacent: [u32; 3]) -> f64 {
        let [a, b, c] = verts.map(|v| self.point(v));
        let foot = origin_on_plane(c, b, a);
        let v = foot.unwrap_or_default();
        self.faces.push(Face { verts, adjacent, foot: v, dist2: dot(v, v), state: State::Far });
        if foot.is_some() { dot(v, v) } else { 0.0 }
    }

    fn make_candidate(&mut self, face: u32) {
        self.faces[face as usize].state = State::Candidate(self.candidates.len() as u32);
        self.candidates.push(face);
    }

    fn remove(&mut self, face: u32) {
        if let State::Candidate(at) = self.faces[face as usize].state {
            self.candidates.swap_remove(at as usize);
            if let Some(&moved) = self.candidates.get(at as usize) {
                self.faces[moved as usize].state = State::Candidate(at);
            }
        }
        self.faces[face as usize].state = State::Gone;
    }

    /// All faces so far may be the nearest.
    fn start(&mut self) {
        for f in 0..self.faces.len() as u32 {
            self.make_candidate(f);
        }
    }

    /// Two triangle pyramids with a common base, around the segment.
    fn start_segment(&mut self, v1: Vertex, v2: Vertex, a: &mut Body, b: &mut Body) -> Option<()> {
        let along = sub(v2.point, v1.point);
        let mut least = 0;
        for i in 1..3 {
            if along[i].abs() < along[least].abs() {
                least = i;
            }
        }
        let mut axis = [0.0; 3];
        axis[least] = 1.0;
        // Three directions around the segment, a third of a turn apart.
        let first = cross(axis, along);
        let turn = third_of_a_turn(along);
        let second = mat_mul_vec(&turn, first);
        let third = mat_mul_vec(&turn, second);
        let (i1, i2) = (self.add_vertex(v1), self.add_vertex(v2));
        let [i3, i4, i5] = [first, second, third].map(|dir| self.add_support(a, b, dir, norm(dir)));
        let faces = [
            ([i1, i3, i4], [1, 3, 2]),
            ([i1, i5, i3], [2, 4, 0]),
            ([i1, i4, i5], [0, 5, 1]),
            ([i2, i4, i3], [5, 0, 4]),
            ([i2, i3, i5], [3, 1, 5]),
            ([i2, i5, i4], [4, 2, 3]),
        ];
        for (verts, adjacent) in faces {
            if self.add_face(verts, adjacent) < TINY {
                return self.start_over(verts, a, b);
            }
        }
        let [p1, p2, p3, p4, p5] = [i1, i2, i3, i4, i5].map(|i| self.point(i));
        if !passes(p1, p2, [p3, p4, p5]) {
            return None;
        }
        self.start();
        Some(())
    }

    /// A face that holds the origin becomes the base of two pyramids.
    fn start_over(&mut self, verts: [u32; 3], a: &mut Body, b: &mut Body) -> Option<()> {
        let corners = verts.map(|v| self.verts[v as usize]);
        self.clear();
        self.start_triangle(corners, a, b)
    }

    /// Two triangle pyramids with a common base.
    fn start_triangle(&mut self, corners: [Vertex; 3], a: &mut Body, b: &mut Body) -> Option<()> {
        let [p1, p2, p3] = corners.map(|c| c.point);
        let normal = cross(sub(p2, p1), sub(p3, p1));
        let length = norm(normal);
        if length < MINVAL {
            return None;
        }
        let [i1, i2, i3] = corners.map(|c| self.add_vertex(c));
        let i5 = self.add_support(a, b, scale(normal, -1.0), length);
        let i4 = self.add_support(a, b, normal, length);
        let (p4, p5) = (self.point(i4), self.point(i5));
        if on_triangle([p1, p2, p3], p4) || on_triangle([p1, p2, p3], p5) {
            return None;
        }
        let faces = [
            ([i4, i1, i2], [1, 3, 2]),
            ([i4, i3, i1], [2, 4, 0]),
            ([i4, i2, i3], [0, 5, 1]),
            ([i5, i2, i1], [5, 0, 4]),
            ([i5, i1, i3], [3, 1, 5]),
            ([i5, i3, i2], [4, 2, 3]),
        ];
        for (verts, adjacent) in faces {
            if self.add_face(verts, adjacent) < TINY {
                return None;
            }
        }
        self.start();
        Some(())
    }

    fn start_tetrahedron(&mut self, corners: [Vertex; 4], a: &mut Body, b: &mut Body) -> Option<()> {
        let [i1, i2, i3, i4] = corners.map(|c| self.add_vertex(c));
        let faces = [
            ([i1, i2, i3], [1, 3, 2]),
            ([i1, i4, i2], [2, 3, 0]),
            ([i1, i3, i4], [0, 3, 1]),
            ([i4, i3, i2], [2, 0, 1]),
        ];
        for (verts, adjacent) in faces {
            if self.add_face(verts, adjacent) < TINY {
                return self.start_over(verts, a, b);
            }
        }
        if !in_tetrahedron(corners.map(|c| c.point)) {
            return None;
        }
        self.start();
        Some(())
    }

    /// Grows until the nearest face is on the surface, and returns it.
    fn expand(&mut self, a: &mut Body, b: &mut Body, limits: Limits) -> Option<u32> {
        let discrete = a.discrete() && b.discrete();
        let tolerance = if discrete { MINVAL } else { limits.tolerance };
        let room = 6 * limits.iterations.max(MIN_ROOM);
        let (mut upper, mut upper2) = (f64::MAX, f64::MAX);
        let mut nearest = None;
        for _ in 0..limits.iterations {
            let before = nearest;
            self.cost += 200 + self.candidates.len() as u64;
            let mut lower2 = f64::MAX;
            for &f in &self.candidates {
                if self.faces[f as usize].dist2 < lower2 {
                    (nearest, lower2) = (Some(f), self.faces[f as usize].dist2);
                }
            }
            let Some(face) = nearest.filter(|_| lower2 <= upper2) else { return before };
            if lower2 <= 0.0 {
                break;
            }
            let lower = lower2.sqrt();
            let foot = self.faces[face as usize].foot;
            let new = self.add_support(a, b, foot, lower);
            let w = self.verts[new as usize];
            let ahead = dot(foot, w.point) / lower;
            if ahead < upper {
                (upper, upper2) = (ahead, ahead * ahead);
            }
            if upper - lower < tolerance {
                break;
            }
            if discrete && self.verts[..new as usize].iter().any(|v| v.corners == w.corners) {
                break;
            }
            self.find_horizon(face, w.point);
            let edges = self.horizon.len();
            if edges < 3 {
                return None;
            }
            if edges > room.saturating_sub(self.faces.len()) {
                break;
            }
            let first = self.faces.len() as u32;
            let last = first + edges as u32 - 1;
            for i in 0..edges {
                let (hidden, edge) = self.horizon[i];
                let (e, this) = (edge as usize, first + i as u32);
                let h = &mut self.faces[hidden as usize];
                let (from, to) = (h.verts[e], h.verts[(e + 1) % 3]);
                h.adjacent[e] = this;
                let before = if i == 0 { last } else { this - 1 };
                let after = if this == last { first } else { this + 1 };
                let dist2 = self.add_face([new, to, from], [before, hidden, after]);
                if dist2 == 0.0 {
                    return None;
                }
                if dist2 >= lower2 && dist2 <= upper2 {
                    self.make_candidate(this);
                }
            }
            if self.candidates.is_empty() {
                break;
            }
        }
        nearest
    }

    /// Removes all faces that `w` sees, starting from one that it does, and lists the border around them.
    fn find_horizon(&mut self, start: u32, w: Vec3) {
        self.horizon.clear();
        self.pending.clear();
        self.cross_edges(start, [2, 1, 0]);
        self.remove(start);
        while let Some((face, edge)) = self.pending.pop() {
            let f = self.faces[face as usize];
            if f.state == State::Gone {
                continue;
            }
            if dot(f.foot, w) - f.dist2 > MINVAL {
                self.remove(face);
                self.cross_edges(face, [(edge + 2) % 3, (edge + 1) % 3]);
            } else {
                self.horizon.push((face, edge));
            }
        }
    }

    /// The neighbours across some edges of a face, to be looked at last edge first.
    fn cross_edges<const N: usize>(&mut self, face: u32, edges: [u8; N]) {
        let f = self.faces[face as usize];
        for e in edges {
            let e = e as usize;
            let other = f.adjacent[e];
            let shared = f.verts[(e + 1) % 3];
            let edge = self.faces[other as usize].verts.iter().position(|&v| v == shared).unwrap_or(2);
            self.pending.push((other, edge as u8));
        }
    }
}

/// Rotation by 120° about an axis of any length.
fn third_of_a_turn(axis: Vec3) -> Mat3 {
    let n = norm(axis);
    let [x, y, z] = axis.map(|u| u / n);
    let (s, c) = (0.75f64.sqrt(), -0.5);
    let d = 1.0 - c;
    [
        c + x * x * d,
        x * y * d - z * s,
        x * z * d + y * s,
        y * x * d + z * s,
        c + y * y * d,
        y * z * d - x * s,
        x * z * d - y * s,
        y * z * d + x * s,
        c + z * z * d,
    ]
}

/// Whether the line from p to q passes a triangle.
fn passes(p: Vec3, q: Vec3, triangle: [Vec3; 3]) -> bool {
    let along = sub(q, p);
    let [a, b, c] = triangle.map(|v| sub(v, p));
    let volumes = [det(a, b, along), det(b, c, along), det(c, a, along)];
    volumes.iter().all(|&v| v >= 0.0) || volumes.iter().all(|&v| v <= 0.0)
}

/// Whether a point is on a triangle.
fn on_triangle([a, b, c]: [Vec3; 3], p: Vec3) -> bool {
    let coef = affine(a, b, c, p);
    if coef.iter().any(|&x| x < 0.0) {
        return false;
    }
    norm(sub(super::simplex::combine(&coef, [a, b, c].into_iter()), p)) < MINVAL
}

/// Whether a tetrahedron holds the origin in its inside.
fn in_tetrahedron([a, b, c, d]: [Vec3; 4]) -> bool {
    let same_side = |p0: Vec3, p1: Vec3, p2: Vec3, p3: Vec3| {
        let normal = cross(sub(p1, p0), sub(p2, p0));
        let (other, origin) = (dot(normal, sub(p3, p0)), -dot(normal, p0));
        (other > 0.0 && origin > 0.0) || (other < 0.0 && origin < 0.0)
    };
    same_side(a, b, c, d) && same_side(b, c, d, a) && same_side(c, d, a, b) && same_side(d, a, b, c)
}
