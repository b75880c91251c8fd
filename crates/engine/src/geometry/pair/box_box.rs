//! Contacts of two boxes.
//!
//! Two boxes are separate if and only if their projections onto one of 15 axes are disjoint: the face normals of both
//! boxes, and the common perpendiculars of an edge of each (Gottschalk, Lin, Manocha, *OBBTree*, SIGGRAPH 1996). The
//! largest gap along these axes determines the contacts. For separate boxes it is positive: their separation along this
//! axis. For overlapping boxes it is negative: minus the penetration depth, which is the length of the shortest
//! translation that separates them. If the axis is a face normal, the face of the other box that most directly faces
//! this face is clipped by the side planes of this face. Every corner of the clipped polygon is a contact, with its
//! depth below the face. If the axis is a perpendicular of two edges, the contact is the midpoint between the closest
//! points of these edges.

use super::ContactPoint;
use super::polygon::FACING;
use crate::geometry::Shape;
use crate::geometry::clip::{ROUNDING, clip};
use crate::geometry::list::List;
use crate::geometry::segments::{Segment, closest_points};
use crate::math::lanes::{Lane3, lane3, vec3};
use crate::math::*;

/// Relative placement of the second of two boxes, in the frame of the first.
#[derive(Clone, Copy)]
struct Placement {
    /// Half sizes of both boxes, m.
    size: [Vec3; 2],
    /// Entry [i][j] is axis i of the first · axis j of the second.
    rotation: [Vec3; 3],
    /// Vector from the centre of the first box to that of the second, m, in the frame of the first box and in that of
    /// the second.
    offset: [Vec3; 2],
    /// Gaps that differ by less than this are equal, m.
    rounding: f64,
}

/// A face of the first or of the second box: of the two faces normal to this axis, the one towards the other box.
#[derive(Clone, Copy, Debug)]
enum BoxFace {
    First(usize),
    Second(usize),
}

/// The common perpendicular of edge direction i of the first box and j of the second.
#[derive(Clone, Copy, Debug)]
struct EdgeAxis {
    edges: [usize; 2],
    /// Gap along the perpendicular minus its rounding error, m.
    gap: f64,
    /// Unit vector from the first box to the second, in the frame of the first.
    normal: Vec3,
}

/// If the perpendicular of two edges is almost parallel to a face normal, the face is preferred, unless the gap of
/// the edges is larger by more than this fraction of the gap of the face. A face contact has several points, an edge
/// contact has one. Boxes resting on each other are slightly tilted; without this preference some would be supported
/// at a single point. (Measured on MuJoCo 3.14.0, `golden/motions.py`: of 27,267 touching pairs in stacks and heaps,
/// three have different contacts with 0.05, and about 3 in 100 with 0.04 or 0.06.)
const FACE_PREFERRED: f64 = 0.05;

/// Appends the contacts of two boxes whose surfaces are within `margin`. Normals point from the first box to the
/// second; `pos` is halfway between the surfaces.
pub(super) fn box_box(first: &Shape, second: &Shape, margin: f64, out: &mut Vec<ContactPoint>) {
    let placement = Placement::new(first, second);
    let limit = margin + placement.rounding;
    let (gap, face) = placement.largest_face_gap();
    if gap > limit {
        return;
    }
    let edges = placement.larger_edge_gap(gap);
    if edges.is_some_and(|axis| axis.gap > limit) {
        return;
    }
    match (edges.filter(|axis| !placement.prefers_face(gap, face, axis)), face) {
        (Some(axis), _) => {
            out.extend(Some(placement.edge_contact(first, &axis)).filter(|contact| contact.dist <= limit));
        }
        (None, BoxFace::First(a)) => face_contacts(first, &placement, a, 1.0, margin, out),
        (None, BoxFace::Second(a)) => face_contacts(second, &placement.swapped(), a, -1.0, margin, out),
    }
}

/// The two axes that follow `i` in the cycle 0, 1, 2.
#[cfg_attr(not(feature = "small"), inline(always))]
fn others(i: usize) -> [usize; 2] {
    [(i + 1) % 3, (i + 2) % 3]
}

impl Placement {
    fn new(first: &Shape, second: &Shape) -> Placement {
        let between = sub(second.pos, first.pos);
        let columns = [0, 1, 2].map(|j| mat_t_mul_vec(&first.mat, second.axis(j)));
        let [a, b] = [first.size, second.size];
        Placement {
            size: [a, b],
            rotation: transposed(&columns),
            offset: [mat_t_mul_vec(&first.mat, between), mat_t_mul_vec(&second.mat, between)],
            rounding: ROUNDING * (a[0] + a[1] + a[2] + b[0] + b[1] + b[2]),
        }
    }

    /// The placement of the first box in the frame of the second.
    fn swapped(&self) -> Placement {
        let ([a, b], [p, q]) = (self.size, self.offset);
        Placement {
            size: [b, a],
            rotation: transposed(&self.rotation),
            offset: [scale(q, -1.0), scale(p, -1.0)],
            ..*self
        }
    }

    /// The largest gap along a face normal, and its face; the first one of equal gaps.
    fn largest_face_gap(&self) -> (f64, BoxFace) {
        let [along_first, along_second] = self.face_gaps();
        let (mut best, mut face) = (f64::NEG_INFINITY, BoxFace::First(0));
        for i in 0..3 {
            if along_first[i] > best + self.rounding {
                (best, face) = (along_first[i], BoxFace::First(i));
            }
        }
        for j in 0..3 {
            if along_second[j] > best + self.rounding {
                (best, face) = (along_second[j], BoxFace::Second(j));
            }
        }
        (best, face)
    }

    /// The axis with the largest gap along a common perpendicular of edges, if this gap is larger than `gap`.
    fn larger_edge_gap(&self, mut gap: f64) -> Option<EdgeAxis> {
        let [x, y, z] = [0, 1, 2].map(|i| self.edge_gaps(i));
        let largest = vec3(x.fast_max(y).fast_max(z));
        if !largest.iter().any(|&g| g > gap) {
            return None;
        }
        let mut best = None;
        for (i, gaps) in [x, y, z].map(vec3).iter().enumerate() {
            for (j, &larger) in gaps.iter().enumerate() {
                if larger > gap {
                    (gap, best) = (larger, Some([i, j]));
                }
            }
        }
        best.map(|[i, j]| {
            let mut direction = [0.0; 3];
            direction[i] = 1.0;
            let across = unit_vector(cross(direction, self.rotation.map(|row| row[j]))).0;
            let towards = 1f64.copysign(dot(across, self.offset[0]));
            EdgeAxis { edges: [i, j], gap, normal: scale(across, towards) }
        })
    }

    /// Whether the boxes get face contacts with this gap although the gap of two edges is larger.
    fn prefers_face(&self, gap: f64, face: BoxFace, axis: &EdgeAxis) -> bool {
        let cosine = match face {
            BoxFace::First(a) => axis.normal[a],
            BoxFace::Second(a) => dot(axis.normal, self.rotation.map(|row| row[a])),
        };
        cosine.abs() > FACING && axis.gap < gap + FACE_PREFERRED * gap.abs()
    }

    /// Gaps along the face normals: |offset_i| - a_i - Σ_j |R_ij| b_j for axis i of the first box, and the analogous
    /// gaps for the second.
    #[cfg_attr(not(feature = "small"), inline(always))]
    fn face_gaps(&self) -> [Vec3; 2] {
        let ([a, b], [p, q]) = (self.size, self.offset);
        let [x, y, z] = self.rotation.map(|row| lane3(row).abs());
        let along_second = lane3(q).abs() - lane3(b) - (x * a[0] + y * a[1] + z * a[2]);
        let [x, y, z] = transposed(&self.rotation).map(|column| lane3(column).abs());
        let along_first = lane3(p).abs() - lane3(a) - (x * b[0] + y * b[1] + z * b[2]);
        [along_first, along_second].map(vec3)
    }

    /// The gaps along n = e_i × b_j / |e_i × b_j| for edge direction i of the first box and all three of the second,
    /// minus their rounding errors: those of the products, magnified by the division by a small |e_i × b_j|. For
    /// parallel edges the gap is -∞.
    #[cfg_attr(not(feature = "small"), inline(always))]
    fn edge_gaps(&self, i: usize) -> Lane3 {
        let ([a, [b0, b1, b2]], [p, _]) = (self.size, self.offset);
        let [k, l] = others(i);
        let (along, row_k, row_l) =
            (self.rotation[i].map(f64::abs), lane3(self.rotation[k]), lane3(self.rotation[l]));
        // e_i × b_j has the components -R_lj along k and R_kj along l; b_m · (e_i × b_j) = ±e_i · b_n for m, n other than j.
        let between = (row_k * p[l] - row_l * p[k]).abs();
        let first = row_l.abs() * a[k] + row_k.abs() * a[l];
        let [r0, r1, r2] = along;
        let second = lane3([b1, b2, b0]) * lane3([r2, r0, r1]) + lane3([b2, b0, b1]) * lane3([r1, r2, r0]);
        let sine = (row_k * row_k + row_l * row_l).sqrt();
        (between - first - second - self.rounding) / sine
    }

    /// The contact of two edges: the midpoint between their closest points.
    fn edge_contact(
        &self,
        first: &Shape,
        &EdgeAxis { edges: [i, j], normal, .. }: &EdgeAxis,
    ) -> ContactPoint {
        let ([a, b], [p, _]) = (self.size, self.offset);
        let columns = transposed(&self.rotation);
        // The edge of each box that is farthest in the direction of the other box.
        let mut of_first = Segment { centre: [0.0; 3], half: [0.0; 3] };
        of_first.half[i] = a[i];
        for m in others(i) {
            of_first.centre[m] = a[m].copysign(normal[m]);
        }
        let mut of_second = Segment { centre: p, half: scale(columns[j], b[j]) };
        for m in others(j) {
            let back = b[m].copysign(-dot(normal, columns[m]));
            of_second.centre = add_scaled(of_second.centre, columns[m], back);
        }
        let [x, y] = closest_points(&of_first, &of_second);
        let (on_first, on_second) = (of_first.at(x), of_second.at(y));
        ContactPoint {
            dist: dot(sub(on_second, on_first), normal),
            pos: first.world(scale(add(on_first, on_second), 0.5)),
            normal: mat_mul_vec(&first.mat, normal),
            tangent: [0.0; 3],
        }
    }
}

#[cfg_attr(not(feature = "small"), inline(always))]
fn transposed(m: &[Vec3; 3]) -> [Vec3; 3] {
    std::array::from_fn(|j| m.map(|row| row[j]))
}

/// Appends the contacts of face `a` of the box `reference` with the face of the other box that most directly faces
/// it. `placement` is relative to the reference box. `outward` is 1 if the reference box is the first of the pair,
/// and -1 if it is the second.
fn face_contacts(
    reference: &Shape,
    placement: &Placement,
    a: usize,
    outward: f64,
    margin: f64,
    out: &mut Vec<ContactPoint>,
) {
    let ([size, _], [offset, _]) = (placement.size, placement.offset);
    let [x, y] = others(a);
    let up = 1f64.copysign(offset[a]);
    let rounding = ROUNDING.sqrt() * (size[x] + size[y]);
    let normal = scale(reference.axis(a), up * outward);
    let polygon = placement.clipped_face(a, up);
    for (k, &[px, py, height]) in polygon.all().iter().enumerate() {
        let is_same = |q: &Vec3| (q[0] - px).abs() <= rounding && (q[1] - py).abs() <= rounding;
        if height <= margin && !polygon.all().iter().take(k).any(is_same) {
            let mut pos = [0.0; 3];
            (pos[x], pos[y], pos[a]) = (px, py, up * (size[a] + 0.5 * height));
            out.push(ContactPoint { dist: height, pos: reference.world(pos), normal, tangent: [0.0; 3] });
        }
    }
}

impl Placement {
    /// The face of the second box that most directly faces the upper or lower face `a` of the first, clipped by the
    /// side planes of that face. Each corner consists of two coordinates along the face and the height above it.
    fn clipped_face(&self, a: usize, up: f64) -> List<Vec3, 8> {
        let ([size, other], [offset, _]) = (self.size, self.offset);
        let [x, y] = others(a);
        let over = |v: Vec3| [v[x], v[y], up * v[a]];
        let edges = transposed(&self.rotation).map(over);
        let steepness = edges.map(|e| e[2].abs());
        let steeper = |i: usize, j: usize| if steepness[j] > steepness[i] { j } else { i };
        let b = steeper(steeper(0, 1), 2);
        let [u, v] = others(b).map(|k| scale(edges[k], other[k]));
        let mut centre = add_scaled(over(offset), edges[b], -other[b].copysign(edges[b][2]));
        centre[2] -= size[a];
        let (plus, minus) = (add(centre, u), sub(centre, u));
        let mut polygon = List::new();
        for corner in [add(plus, v), add(minus, v), sub(minus, v), sub(plus, v)] {
            polygon.push(corner);
        }
        let largest = size[x].max(size[y]);
        for (k, half) in [(0, size[x]), (1, size[y])] {
            for side in [1.0, -1.0] {
                clip(&mut polygon, |p| half - side * p[k], largest);
            }
        }
        polygon
    }
}

#[cfg(test)]
mod tests;
