//! Boxes, meshes and cylinders in contact along faces or edges: contacts at the corners of the shared area.
//!
//! The direction of least overlap determines the feature of each shape in contact: a face, an edge, or a corner with
//! its adjacent faces and edges. Of two faces that face each other, the second is clipped by the side planes of the
//! first (Sutherland, Hodgman, *Reentrant polygon clipping*, Communications of the ACM 17, 1974). An edge that lies
//! on a face is clipped by the side planes of that face. Corners of the clipped polygon below the clipping face are
//! contacts, each with its own depth. The choice of the clipping face, the angles and the number of contacts are
//! those of MuJoCo 3.14.0 (measured).

use super::{ContactPoint, PairSettings};
use crate::geometry::clip::{ROUNDING, clip};
use crate::geometry::convex::{Convex, ConvexScratch, nearest};
use crate::geometry::list::List;
use crate::geometry::{HullFaces, Shape};
use crate::kinds::geom;
use crate::math::*;

/// Cosine of the largest angle between the normals of two faces that face each other, one normal reversed (measured
/// on MuJoCo 3.14.0).
pub(super) const FACING: f64 = 0.996;
/// Sine of the largest angle between an edge and a face on which it lies.
const EDGE_ON_FACE: f64 = 0.089_352_67;
/// Largest angle, rad, between the contact direction and the normal of a face, or the plane normal to an edge, for
/// which the contact is with that face or edge. Directions between round bodies are accurate to about the square root
/// of the tolerance.
const MAX_CONTACT_ANGLE: f64 = 2e-3;
/// Maximum number of contacts of a polygon.
const MAX_FACE_CONTACTS: usize = 4;
/// Maximum number of corners of a face. Further corners of a mesh face are ignored.
const MAX_CORNERS: usize = 150;
/// Number of corners of the polygon that approximates the end of a cylinder.
const RIM_CORNERS: usize = 16;
/// Maximum number of faces and of edges considered at a corner.
const MAX_ADJACENT: usize = 32;

pub(super) type Corners = List<Vec3, MAX_CORNERS>;

/// A face of a shape: its index and its outward unit normal, world frame.
#[derive(Clone, Copy, Debug, Default)]
struct PolygonFace {
    index: usize,
    normal: Vec3,
}

/// The two ends of an edge, world frame.
type Edge = [Vec3; 2];

/// The part of a shape in contact with the other shape.
struct Feature {
    /// Kind of the feature: 3 for a face, 2 for an edge, 1 for a corner.
    dim: usize,
    /// The face itself, the faces adjacent to the edge, or the faces adjacent to the corner.
    faces: List<PolygonFace, MAX_ADJACENT>,
    /// The edge itself, or the edges at the corner.
    edges: List<Edge, MAX_ADJACENT>,
}

/// A face, and a polygon or an edge that lies on it.
struct ContactPatch {
    /// The corners of the face, clockwise as seen from outside, and its normal.
    face: Corners,
    normal: Vec3,
    lying: Corners,
    /// Contact normal, from the first shape to the second.
    direction: Vec3,
    /// Whether the face belongs to the first shape.
    on_first: bool,
}

/// Appends the contacts of two shapes, without margin.
pub(super) fn contacts(
    a: &Shape,
    b: &Shape,
    settings: &PairSettings,
    scratch: &mut ConvexScratch,
    out: &mut Vec<ContactPoint>,
) {
    let found = nearest(&mut Convex::new(a), &mut Convex::new(b), 0.0, settings.effort, scratch);
    let Some(deep) = found.filter(|n| n.dist < 0.0) else { return };
    let start = out.len();
    if let Some(patch) = patch(a, b, deep.normal) {
        patch.contacts(out);
    }
    if out.len() == start {
        out.push(ContactPoint::at_midpoint(&deep));
    }
}

/// The area shared by two shapes that overlap along a direction; `None` if it is a single point.
fn patch(a: &Shape, b: &Shape, direction: Vec3) -> Option<ContactPatch> {
    let (of_a, of_b) = (Feature::facing(a, direction), Feature::facing(b, scale(direction, -1.0)));
    if let Some((fa, fb)) = facing(a, b, direction, &of_a, &of_b) {
        return Some(ContactPatch {
            face: corners(a, fa.index),
            normal: fa.normal,
            lying: corners(b, fb.index),
            direction: scale(fb.normal, -1.0),
            on_first: true,
        });
    }
    if of_a.dim < 3 && of_a.dim <= of_b.dim {
        let (edge, face) = edge_on_face(&of_a, b, &of_b)?;
        let direction = scale(face.normal, -1.0);
        return Some(ContactPatch {
            face: corners(b, face.index),
            normal: face.normal,
            lying: edge,
            direction,
            on_first: false,
        });
    }
    let (edge, face) = edge_on_face(&of_b, a, &of_a)?;
    Some(ContactPatch {
        face: corners(a, face.index),
        normal: face.normal,
        lying: edge,
        direction: face.normal,
        on_first: true,
    })
}

/// The two faces that face each other. Of several pairs, the one with the smallest penetration depth along its normal
/// is chosen; of equal depths, the one nearest to the direction.
fn facing(
    a: &Shape,
    b: &Shape,
    direction: Vec3,
    of_a: &Feature,
    of_b: &Feature,
) -> Option<(PolygonFace, PolygonFace)> {
    let pairs = of_a.faces.all().iter().flat_map(|fa| of_b.faces.all().iter().map(move |fb| (fa, fb)));
    let mut pairs = pairs.filter(|(fa, fb)| dot(fa.normal, fb.normal) < -FACING);
    let (&fa, &fb) = pairs.next()?;
    let (mut of_a, mut of_b) = (Convex::new(a), Convex::new(b));
    // The contact normal is opposite to the normal of the second face.
    let mut rank = |fa: PolygonFace, fb: PolygonFace| {
        let (ahead, back) = (scale(fb.normal, -1.0), fb.normal);
        let depth = dot(ahead, sub(of_a.support(ahead), of_b.support(back)));
        [depth, dot(sub(fb.normal, fa.normal), direction)]
    };
    let mut best = ((fa, fb), None);
    for (&fa, &fb) in pairs {
        let least = best.1.unwrap_or_else(|| rank(best.0.0, best.0.1));
        let next = rank(fa, fb);
        best = if next < least { ((fa, fb), Some(next)) } else { (best.0, Some(least)) };
    }
    Some(best.0)
}

/// The edge of one feature that is most nearly parallel to a face of the other, and this face. The ends of cylinders
/// have contacts with faces only.
fn edge_on_face(feature: &Feature, on: &Shape, other: &Feature) -> Option<(Corners, PolygonFace)> {
    if on.kind == geom::CYLINDER || feature.dim == 3 {
        return None;
    }
    let mut flattest = (EDGE_ON_FACE, None);
    for face in other.faces.all() {
        for edge in feature.edges.all() {
            let slope = dot(unit_vector(sub(edge[1], edge[0])).0, face.normal).abs();
            if slope < flattest.0 {
                flattest = (slope, Some((edge, face)));
            }
        }
    }
    let (edge, face) = flattest.1?;
    let mut ends = Corners::new();
    edge.iter().for_each(|&p| ends.push(p));
    Some((ends, *face))
}

impl Feature {
    /// The feature of a shape that is farthest in a direction.
    fn facing(s: &Shape, direction: Vec3) -> Feature {
        let mut at_corner = Feature { dim: 1, faces: List::new(), edges: List::new() };
        let mut body = Convex::new(s);
        let corner = body.support(direction);
        match s.kind {
            geom::CYLINDER => {
                at_corner.dim = cylinder(s, direction, &mut at_corner);
                return at_corner;
            }
            geom::BOX => box_corner(s, corner, &mut at_corner),
            _ => {
                if let (Some(hull_faces), Ok(vertex)) = (s.mesh().hull_faces, usize::try_from(body.corner()))
                {
                    mesh_corner(s, hull_faces, vertex, corner, &mut at_corner);
                }
            }
        }
        at_corner.narrowed(direction)
    }

    /// Reduces a corner to the adjacent face, or else the adjacent edge, that is normal to the direction, if there is
    /// one.
    fn narrowed(self, direction: Vec3) -> Feature {
        let along = |f: &&PolygonFace| dot(f.normal, direction);
        let steepest = self.faces.all().iter().max_by(|f, g| along(f).total_cmp(&along(g)));
        if let Some(&face) = steepest.filter(|f| norm(cross(f.normal, direction)) < MAX_CONTACT_ANGLE) {
            let mut faces = List::new();
            faces.push(face);
            return Feature { dim: 3, faces, edges: List::new() };
        }
        let unit = |e: &Edge| unit_vector(sub(e[1], e[0])).0;
        let slope = |e: &&Edge| dot(unit(e), direction).abs();
        let flattest = self.edges.all().iter().min_by(|e, f| slope(e).total_cmp(&slope(f)));
        let Some(&edge) = flattest.filter(|e| slope(e) < MAX_CONTACT_ANGLE) else { return self };
        let (mut faces, mut edges) = (List::new(), List::new());
        edges.push(edge);
        // The faces adjacent to an edge are those with a normal perpendicular to it.
        for &f in self.faces.all().iter().filter(|f| dot(f.normal, unit(&edge)).abs() < ROUNDING.sqrt()) {
            faces.push(f);
        }
        Feature { dim: 2, faces, edges }
    }
}

/// Finds the end of a cylinder, or the line on its side, that faces a direction. Returns the kind of the feature
/// (`dim`).
fn cylinder(s: &Shape, direction: Vec3, out: &mut Feature) -> usize {
    let axis = s.axis(2);
    let slope = dot(axis, direction);
    let upper = slope >= 0.0;
    if slope.abs() > FACING {
        let normal = scale(axis, if upper { 1.0 } else { -1.0 });
        out.faces.push(PolygonFace { index: usize::from(!upper), normal });
        return 3;
    }
    if slope.abs() < EDGE_ON_FACE {
        let across = scale(normalize(add_scaled(direction, axis, -slope)).0, s.size[0]);
        let side = if upper { s.size[1] } else { -s.size[1] };
        out.edges.push([side, -side].map(|h| add(add_scaled(s.pos, axis, h), across)));
        return 2;
    }
    1
}

/// Collects the faces and edges of a box that meet at a corner.
fn box_corner(s: &Shape, corner: Vec3, out: &mut Feature) {
    let local = s.local(corner);
    for axis in 0..3 {
        let upper = local[axis] > 0.0;
        let normal = scale(s.axis(axis), if upper { 1.0 } else { -1.0 });
        out.faces.push(PolygonFace { index: 2 * axis + usize::from(!upper), normal });
        out.edges.push([corner, add_scaled(corner, normal, -2.0 * s.size[axis])]);
    }
}

/// Collects the hull faces and edges of a mesh that meet at a vertex.
fn mesh_corner(s: &Shape, hull_faces: &HullFaces, vertex: usize, corner: Vec3, out: &mut Feature) {
    for (index, position) in hull_faces.around(vertex) {
        let list = hull_faces.vertices(index);
        let other = list[(position + 1) % list.len()] as usize;
        out.faces.push(PolygonFace { index, normal: mat_mul_vec(&s.mat, hull_faces.normal(index)) });
        out.edges.push([corner, s.world(s.mesh().vertex(other))]);
    }
}

/// The corners of a face, clockwise as seen from outside.
fn corners(s: &Shape, face: usize) -> Corners {
    let mut out = Corners::new();
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
            for k in 0..RIM_CORNERS {
                let (sin, cos) =
                    libm::sincos(-side * k as f64 * (2.0 * std::f64::consts::PI / RIM_CORNERS as f64));
                out.push(s.world([s.size[0] * cos, s.size[0] * sin, side * s.size[1]]));
            }
        }
        _ => {
            let vertices = s.mesh().hull_faces.map_or(&[][..], |hull_faces| hull_faces.vertices(face));
            for &v in vertices.iter().rev() {
                out.push(s.world(s.mesh().vertex(v as usize)));
            }
        }
    }
    out
}

impl ContactPatch {
    /// Appends a contact at every corner below the face; of more than four corners, at those that span the largest
    /// area.
    fn contacts(mut self, out: &mut Vec<ContactPoint>) {
        let face = self.face.all();
        let Some(&origin) = face.first().filter(|_| face.len() > 2) else { return };
        let mut size = 0.0_f64;
        for (k, &p) in face.iter().enumerate() {
            let edge = sub(face[(k + 1) % face.len()], p);
            size = size.max(norm(edge));
            let inwards = unit_vector(cross(edge, self.normal)).0;
            clip(&mut self.lying, |q| dot(inwards, sub(q, p)), size);
        }
        let depth = |p: Vec3| dot(self.normal, sub(p, origin));
        let mut below = Corners::new();
        for &p in self.lying.all() {
            if depth(p) < 0.0 && below.all().iter().all(|&q| norm(sub(q, p)) > ROUNDING * size) {
                below.push(p);
            }
        }
        let touch = |p: Vec3| {
            let dist = depth(p);
            // The corner is on the second shape if the face belongs to the first shape, and on the first shape
            // otherwise.
            let half = if self.on_first { -0.5 * dist } else { 0.5 * dist };
            ContactPoint {
                dist,
                pos: add_scaled(p, self.direction, half),
                normal: self.direction,
                tangent: [0.0; 3],
            }
        };
        match below.all() {
            few if few.len() <= MAX_FACE_CONTACTS => out.extend(few.iter().map(|&p| touch(p))),
            many => out.extend(largest_quadrilateral(many).map(touch)),
        }
    }
}

/// The four corners of a convex polygon that span the largest area. For each diagonal, the farthest corner on either
/// side is found; it advances as the diagonal turns.
pub(super) fn largest_quadrilateral(polygon: &[Vec3]) -> [Vec3; MAX_FACE_CONTACTS] {
    let n = polygon.len();
    let corner_at = |k: usize| polygon[k % n];
    // Twice the area, as the cross product of the diagonals.
    let area = |[i, j, k, l]: [usize; MAX_FACE_CONTACTS]| {
        norm(cross(sub(corner_at(k), corner_at(i)), sub(corner_at(l), corner_at(j))))
    };
    let mut best = [0, 1, 2, 3];
    let mut largest = area(best);
    for i in 0..n {
        let (mut j, mut l) = (i + 1, i + 3);
        for k in i + 2..i + n - 1 {
            l = l.max(k + 1);
            let mut here = area([i, j, k, l]);
            loop {
                let (next_j, next_l) = (area([i, j + 1, k, l]), area([i, j, k, l + 1]));
                if j + 1 < k && next_j > here {
                    (j, here) = (j + 1, next_j);
                } else if l + 1 < i + n && next_l > here {
                    (l, here) = (l + 1, next_l);
                } else {
                    break;
                }
            }
            // Of equally large areas the first is kept.
            if here > largest * (1.0 + ROUNDING) {
                (best, largest) = ([i, j, k, l], here);
            }
        }
    }
    best.map(corner_at)
}
