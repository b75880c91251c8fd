//! Boxes, meshes and cylinders that meet in faces or along edges: contacts at the corners of the polygon they share.
//!
//! The support points of the deepest place say which faces and edges of each shape take part. Of two faces that look
//! at each other, the second is clipped by the sides of the first; an edge that lies on a face is clipped by the sides of
//! that face. Each corner's distance is its depth below the face that clips.

use super::{Settings, Touch};
use crate::geom;
use crate::geometry::Shape;
use crate::geometry::convex::{Convex, Deep, Room, deepest};
use crate::math::*;

/// Cosine of the angle of two faces up to which they look at each other (measured on MuJoCo 3.14.0).
const FACING: f64 = 0.996;
/// Sine of the angle of an edge and a face up to which it lies on it.
const ALONG: f64 = 0.089_352_67;
/// Most contacts of a polygon.
const MOST: usize = 4;
/// Most corners of a face; of a mesh with larger ones the rest is left out.
const CORNERS: usize = 150;
/// Corners of the polygon that stands for the end of a cylinder.
const RIM: usize = 16;

/// A small list without allocation.
pub(super) struct List<T, const N: usize> {
    items: [T; N],
    len: usize,
}

impl<T: Copy + Default, const N: usize> List<T, N> {
    pub(super) fn new() -> Self {
        List { items: [T::default(); N], len: 0 }
    }

    pub(super) fn push(&mut self, item: T) {
        if let Some(place) = self.items.get_mut(self.len) {
            *place = item;
            self.len += 1;
        }
    }

    pub(super) fn all(&self) -> &[T] {
        &self.items[..self.len]
    }
}

/// A face of a shape: which one, and its normal, world.
#[derive(Clone, Copy, Debug, Default)]
struct Face {
    index: usize,
    normal: Vec3,
}

type Faces = List<Face, 32>;
pub(super) type Corners = List<Vec3, CORNERS>;
/// Edges as their two ends.
type Edges = List<[Vec3; 2], 32>;

/// Contacts of two shapes without margin.
pub(super) fn contacts(a: &Shape, b: &Shape, settings: &Settings, room: &mut Room, out: &mut Vec<Touch>) {
    let Some(deep) = deepest(&mut Convex::new(a, 0.0), &mut Convex::new(b, 0.0), settings.effort, room)
    else {
        return;
    };
    let start = out.len();
    if let Some(shared) = shared(a, b, &deep) {
        shared.contacts(out);
    }
    if out.len() == start {
        out.push(super::convex::between(deep.dist, deep.witness[0], deep.witness[1]));
    }
}

/// What two shapes share: a polygon or edge of one, clipped by a face of the other.
struct Shared {
    /// The face that clips, and its normal.
    face: Corners,
    normal: Vec3,
    /// What is clipped.
    clipped: Corners,
    /// From the first shape to the second.
    direction: Vec3,
    /// Whether the face belongs to the first shape.
    first: bool,
}

fn shared(a: &Shape, b: &Shape, deep: &Deep) -> Option<Shared> {
    let outwards = normalize(sub(deep.witness[0], deep.witness[1])).0;
    let (support_a, support_b) =
        (Support::new(a, deep, 0, outwards), Support::new(b, deep, 1, scale(outwards, -1.0)));
    let (faces_a, faces_b) = (support_a.faces(), support_b.faces());
    for fa in faces_a.all() {
        for fb in faces_b.all() {
            if dot(fa.normal, fb.normal) < -FACING {
                return Some(Shared {
                    face: support_a.corners(fa.index),
                    normal: fa.normal,
                    clipped: support_b.corners(fb.index),
                    direction: scale(fb.normal, -1.0),
                    first: true,
                });
            }
        }
    }
    // The end of a cylinder takes faces only.
    let on_face = |edges: &Edges, of: &Support, faces: &Faces| {
        for face in faces.all().iter().filter(|_| of.shape.kind != geom::CYLINDER) {
            for edge in edges.all() {
                if dot(normalize(sub(edge[1], edge[0])).0, face.normal).abs() < ALONG {
                    let mut clipped = Corners::new();
                    edge.iter().for_each(|&p| clipped.push(p));
                    return Some((*face, clipped));
                }
            }
        }
        None
    };
    if support_a.dim < 3 && support_a.dim <= support_b.dim {
        let (face, clipped) = on_face(&support_a.edges(), &support_b, &faces_b)?;
        let (face, normal) = (support_b.corners(face.index), face.normal);
        return Some(Shared { face, normal, clipped, direction: scale(normal, -1.0), first: false });
    }
    if support_b.dim < 3 {
        let (face, clipped) = on_face(&support_b.edges(), &support_a, &faces_a)?;
        let (face, normal) = (support_a.corners(face.index), face.normal);
        return Some(Shared { face, normal, clipped, direction: normal, first: true });
    }
    None
}

impl Shared {
    /// A contact at every corner that is below the face; of more than four, those that span the largest area.
    fn contacts(mut self, out: &mut Vec<Touch>) {
        if self.face.len < 3 {
            return;
        }
        let face = self.face.all();
        for k in 0..face.len() {
            let (p, q) = (face[k], face[(k + 1) % face.len()]);
            let inwards = cross(sub(q, p), self.normal);
            self.clipped = clip(&self.clipped, p, inwards);
        }
        let (normal, origin) = (self.normal, face[0]);
        let depth = |p: Vec3| dot(normal, sub(p, origin));
        let mut below = Corners::new();
        for &p in self.clipped.all() {
            let seen = |q: &Vec3| sub(*q, p).iter().all(|d| d.abs() < MINVAL);
            if depth(p) < 0.0 && !below.all().iter().any(seen) {
                below.push(p);
            }
        }
        let touch = |p: Vec3| {
            let dist = depth(p);
            // The corner is on the second shape, or on the first.
            let half = if self.first { -0.5 * dist } else { 0.5 * dist };
            Touch {
                dist,
                pos: add_scaled(p, self.direction, half),
                normal: self.direction,
                tangent: [0.0; 3],
            }
        };
        if below.len > MOST {
            out.extend(widest(below.all()).map(touch));
        } else {
            out.extend(below.all().iter().map(|&p| touch(p)));
        }
    }
}

/// The part of a polygon on the inner side of a plane.
fn clip(polygon: &Corners, on: Vec3, inwards: Vec3) -> Corners {
    let mut out = Corners::new();
    let n = polygon.len;
    let height = |p: Vec3| dot(inwards, sub(p, on));
    for (k, &p) in polygon.all().iter().enumerate() {
        let q = polygon.items[(k + 1) % n];
        let (hp, hq) = (height(p), height(q));
        let (p_in, q_in) = (hp > -MINVAL, hq > -MINVAL);
        if p_in != q_in && hp != hq {
            let t = hp / (hp - hq);
            if (0.0..=1.0).contains(&t) {
                out.push(add_scaled(p, sub(q, p), t));
            }
        }
        if q_in {
            out.push(q);
        }
    }
    out
}

/// Four corners of a convex polygon that span a large area: while the first goes once around, the others move on as
/// long as the area grows.
pub(super) fn widest(polygon: &[Vec3]) -> [Vec3; MOST] {
    let n = polygon.len();
    // Twice the area, by the diagonals.
    let area = |q: [usize; MOST]| {
        let [a, b, c, d] = q.map(|k| polygon[k]);
        norm(cross(sub(c, a), sub(d, b)))
    };
    let mut at = [0, 1, 2, 3];
    let (mut best, mut largest) = (at, area(at));
    for first in 0..n {
        at[0] = first;
        let mut grow = |k: usize| {
            let mut moved = at;
            moved[k] = (at[k] + 1) % n;
            let grows = area(moved) > largest;
            if grows {
                (at, best, largest) = (moved, moved, area(moved));
            }
            grows
        };
        while grow(3) {
            while grow(2) {}
            while grow(1) {}
        }
        // The next first corner pushes the others on.
        for k in 1..MOST {
            if at[k] != at[k - 1] {
                break;
            }
            at[k] = (at[k] + 1) % n;
        }
    }
    best.map(|k| polygon[k])
}

/// The feature of a shape that is farthest in a direction.
struct Support<'a> {
    shape: &'a Shape<'a>,
    outwards: Vec3,
    /// Its corners: one, two or three of them are different.
    corners: [usize; 3],
    points: [Vec3; 3],
    dim: usize,
}

impl<'a> Support<'a> {
    fn new(shape: &'a Shape<'a>, deep: &Deep, of: usize, outwards: Vec3) -> Support<'a> {
        let mut corners = deep.support.map(|v| v.corners[of].max(0) as usize);
        let mut points = deep.support.map(|v| if of == 0 { v.on_a } else { v.on_b });
        if shape.kind == geom::CYLINDER {
            let slope = dot(shape.axis(2), outwards).abs();
            let dim = if slope > FACING {
                3
            } else if slope < ALONG {
                2
            } else {
                1
            };
            return Support { shape, outwards, corners, points, dim };
        }
        let [x, y, z] = corners;
        let dim = if x != y {
            if z == x || z == y { 2 } else { 3 }
        } else if x != z {
            // The two that differ come first.
            (corners, points) = ([x, z, z], [points[0], points[2], points[2]]);
            2
        } else {
            1
        };
        Support { shape, outwards, corners, points, dim }
    }

    /// The faces that the feature belongs to.
    fn faces(&self) -> Faces {
        let mut out = Faces::new();
        let s = self.shape;
        match s.kind {
            geom::BOX => self.box_faces(&mut out),
            geom::CYLINDER => {
                let up = dot(s.axis(2), self.outwards) >= 0.0;
                let normal = scale(s.axis(2), if up { 1.0 } else { -1.0 });
                if self.dim == 3 {
                    out.push(Face { index: usize::from(!up), normal });
                }
            }
            _ => {
                let Some(sides) = s.mesh.sides else { return out };
                for index in 0..sides.len() {
                    let has = |v: &usize| sides.vertices(index).contains(&(*v as u32));
                    if self.corners.iter().all(has) {
                        out.push(Face { index, normal: mat_mul_vec(&s.mat, sides.normal(index)) });
                    }
                }
            }
        }
        out
    }

    /// The faces of a box with all corners of the feature; when these are no face, edge or corner, the face that looks
    /// outwards.
    fn box_faces(&self, out: &mut Faces) {
        let s = self.shape;
        let face = |axis: usize, upper: bool| Face {
            index: 2 * axis + usize::from(!upper),
            normal: scale(s.axis(axis), if upper { 1.0 } else { -1.0 }),
        };
        for axis in 0..3 {
            let upper = self.corners.map(|c| c >> axis & 1 == 1);
            if upper == [upper[0]; 3] {
                out.push(face(axis, upper[0]));
            }
        }
        if out.len != 4 - self.dim {
            *out = Faces::new();
            let local = mat_t_mul_vec(&s.mat, self.outwards);
            if let Some(axis) = (0..3).find(|&i| local[i].abs() > FACING) {
                out.push(face(axis, local[axis] > 0.0));
            }
        }
    }

    /// The edges at the feature, each from a point of it.
    fn edges(&self) -> Edges {
        let mut out = Edges::new();
        let s = self.shape;
        match (s.kind, self.dim) {
            (geom::CYLINDER, 2) => {
                let [x, y, z] = s.local(self.points[0]);
                out.push([self.points[0], s.world([x, y, -z])]);
            }
            (geom::CYLINDER, _) => {}
            (_, 2) => out.push([self.points[0], self.points[1]]),
            (geom::BOX, _) => {
                for axis in 0..3 {
                    let mut other = s.size;
                    for (k, x) in other.iter_mut().enumerate() {
                        if (self.corners[0] >> k & 1 == 1) == (k == axis) {
                            *x = -*x;
                        }
                    }
                    out.push([self.points[0], s.world(other)]);
                }
            }
            _ => {
                let Some(sides) = s.mesh.sides else { return out };
                for side in 0..sides.len() {
                    let vertices = sides.vertices(side);
                    let Some(at) = vertices.iter().position(|&v| v as usize == self.corners[0]) else {
                        continue;
                    };
                    let other = vertices[(at + 1) % vertices.len()] as usize;
                    out.push([self.points[0], s.world(s.mesh.vert.get(other).copied().unwrap_or_default())]);
                }
            }
        }
        out
    }

    /// The corners of a face, clockwise as seen from outside.
    fn corners(&self, face: usize) -> Corners {
        let mut out = Corners::new();
        let s = self.shape;
        match s.kind {
            geom::BOX => {
                let (axis, side) = (face / 2, if face.is_multiple_of(2) { 1.0 } else { -1.0 });
                let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
                for (u, v) in [(1.0, 1.0), (1.0, -1.0), (-1.0, -1.0), (-1.0, 1.0)] {
                    let mut p = [0.0; 3];
                    (p[axis], p[j], p[k]) = (side * s.size[axis], u * side * s.size[j], v * s.size[k]);
                    out.push(s.world(p));
                }
            }
            geom::CYLINDER => {
                let side = if face == 0 { 1.0 } else { -1.0 };
                for k in 0..RIM {
                    let (sin, cos) =
                        libm::sincos(-side * k as f64 * (2.0 * std::f64::consts::PI / RIM as f64));
                    out.push(s.world([s.size[0] * cos, s.size[0] * sin, side * s.size[1]]));
                }
            }
            _ => {
                let vertices = s.mesh.sides.map_or(&[][..], |sides| sides.vertices(face));
                for &v in vertices.iter().rev() {
                    out.push(s.world(s.mesh.vert.get(v as usize).copied().unwrap_or_default()));
                }
            }
        }
        out
    }
}
