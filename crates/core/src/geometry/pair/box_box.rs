//! Contacts of two boxes.
//!
//! The axis of the largest gap among the 15 separating axes (Gottschalk, Lin and Manocha, *OBBTree*, 1996)
//! tells how the boxes touch. A face normal: the incident face is clipped by the sides of the reference face
//! (Sutherland and Hodgman, *Reentrant polygon clipping*, 1974), and every corner near the reference face is
//! a contact. The cross product of two edges: the nearest points of the supporting edges are the one contact.
//!
//! Everything is measured in the frame of the first box, or of the box with the reference face.
//!
//! Which axis wins among almost equal ones, which edges are tried when several support, which corners count
//! as one and the order of the corners are recorded behaviour of MuJoCo 3.14.0: the constants below and the
//! walk of [`face_contacts`].

use super::Touch;
use crate::geometry::Shape;
use crate::math::lanes::lane3;
use crate::math::*;

/// Gap, relative to all half lengths, that rounding may open between boxes that touch.
const TOUCHING: f64 = 1e-13;
/// Squared sine below which two edges have no common perpendicular.
const PARALLEL: f64 = 1e-16;
/// Part of its gap by which an edge axis must be better than the best before it.
const EDGE_HANDICAP: f64 = 1e-6;
/// Cosine from which on an edge axis is almost the best face normal …
const ALMOST_FACE: f64 = 0.99;
/// … which is then taken unless the edge axis' gap is larger by this part of the face's.
const FACE_BONUS: f64 = 0.05;
/// Component of the normal below which the edges on both sides support.
const LEVEL: f64 = 1e-9;
/// Squared distance, relative to the reference face, within which corners are one.
const SAME_CORNER: f64 = 1e-14;

/// The turn of a box against another: entry [i][j] is axis i of the one · axis j of the other.
type Turn = [Vec3; 3];

/// Where the second box is, seen from the first.
struct Relative {
    turn: Turn,
    /// From centre to centre along the axes of the first.
    offset: Vec3,
    /// The same along the axes of the second.
    offset_second: Vec3,
}

/// A face normal of the first or of the second box.
#[derive(Clone, Copy, Debug)]
enum Face {
    First(usize),
    Second(usize),
}

/// The common perpendicular of edge `i` of the first box and edge `j` of the second.
#[derive(Clone, Copy, Debug)]
struct EdgeAxis {
    gap: f64,
    edges: [usize; 2],
    /// The unit axis, from the first box to the second, in the frame of the first.
    normal: Vec3,
    /// The same in the frame of the second.
    normal_second: Vec3,
}

/// The best of the separating axes: the face normal of the largest gap, and the edge axis of the largest gap
/// where that is larger.
#[derive(Clone, Copy, Debug)]
struct Separation {
    face_gap: f64,
    face: Face,
    edge: Option<EdgeAxis>,
}

/// Appends the contacts of two boxes whose surfaces are not farther than `margin` apart. Normals point from
/// the first to the second, `pos` is halfway between the surfaces.
pub(super) fn box_box(first: &Shape, second: &Shape, margin: f64, out: &mut Vec<Touch>) {
    let relative = relative(first, second);
    let slack = TOUCHING * (first.size.iter().sum::<f64>() + second.size.iter().sum::<f64>());
    let limit = margin + slack;
    let Some(separation) = separation(&relative, first.size, second.size, limit, slack) else { return };
    let Relative { turn, offset, offset_second } = relative;
    if let Some(axis) = preferred_edge(&separation, slack) {
        out.extend(edge_contact(first, second.size, &turn, offset, axis, limit));
        return;
    }
    match separation.face {
        Face::First(a) => face_contacts(first, second.size, &turn, offset, a, 1.0, margin, out),
        Face::Second(a) => {
            let turn = std::array::from_fn(|j| [turn[0][j], turn[1][j], turn[2][j]]);
            face_contacts(second, first.size, &turn, scale(offset_second, -1.0), a, -1.0, margin, out);
        }
    }
}

fn relative(first: &Shape, second: &Shape) -> Relative {
    let away = sub(second.pos, first.pos);
    let columns: [Vec3; 3] = std::array::from_fn(|j| mat_t_mul_vec(&first.mat, column(&second.mat, j)));
    Relative {
        turn: std::array::from_fn(|i| columns.map(|c| c[i])),
        offset: mat_t_mul_vec(&first.mat, away),
        offset_second: mat_t_mul_vec(&second.mat, away),
    }
}

/// The two axes that follow `i` in the cycle 0, 1, 2.
#[cfg_attr(not(feature = "small"), inline(always))]
fn others(i: usize) -> [usize; 2] {
    [(i + 1) % 3, (i + 2) % 3]
}

/// The best separating axes; nothing when a gap exceeds the limit or is no number.
#[inline]
fn separation(relative: &Relative, size1: Vec3, size2: Vec3, limit: f64, slack: f64) -> Option<Separation> {
    let Relative { turn, offset, offset_second } = relative;
    let spread = turn.map(|row| row.map(f64::abs));

    let (mut face_gap, mut face) = (f64::NEG_INFINITY, Face::First(0));
    let mut try_face = |gap: f64, axis| {
        if gap > face_gap {
            (face_gap, face) = (gap, axis);
        }
        gap <= limit
    };
    // Rounding decides between faces of aligned boxes: in this order of operations as recorded.
    for i in 0..3 {
        if !try_face(offset[i].abs() - size1[i] - dot(spread[i], size2), Face::First(i)) {
            return None;
        }
    }
    for j in 0..3 {
        let across = [spread[0][j], spread[1][j], spread[2][j]];
        if !try_face(offset_second[j].abs() - size2[j] - dot(across, size1), Face::Second(j)) {
            return None;
        }
    }

    let (mut best, mut edge) = (face_gap, None);
    let turns = turn.map(lane3);
    let [s0, s1, s2] = size2;
    let (after, before) = (lane3([s1, s2, s0]), lane3([s2, s0, s1]));
    for i in 0..3 {
        let [i1, i2] = others(i);
        // The gaps times the sines, along the cross products as they are, of all j: (e_i × b_j) · b_j1 = e_i · b_j2.
        let [x, y, z] = spread[i];
        let reach = turns[i2].abs() * size1[i1]
            + turns[i1].abs() * size1[i2]
            + after * lane3([z, x, y])
            + before * lane3([y, z, x]);
        let short = (turns[i1] * offset[i2] - turns[i2] * offset[i1]).abs() - reach + slack;
        // Most pairs are out without root and division: short / sine <= best < 0, or short < 0 <= best.
        let sine2 = turns[i1] * turns[i1] + turns[i2] * turns[i2];
        let (short, sine2) = (short.to_array(), sine2.to_array());
        for j in 0..3 {
            let bar = best.min(0.0);
            if short[j] <= 0.0 && short[j] * short[j] >= bar * bar * sine2[j] {
                continue;
            }
            // The products above carry the rounding of the turn, which a small sine would magnify: again,
            // along the unit axis.
            let Some(axis) = edge_axis(relative, size1, size2, [i, j]) else { continue };
            if axis.gap > limit {
                return None;
            }
            if axis.gap - EDGE_HANDICAP * axis.gap.abs() > best {
                (best, edge) = (axis.gap, Some(axis));
            }
        }
    }
    Some(Separation { face_gap, face, edge })
}

/// The separating axis of two edges, unless they are parallel.
#[inline]
fn edge_axis(relative: &Relative, size1: Vec3, size2: Vec3, [i, j]: [usize; 2]) -> Option<EdgeAxis> {
    let Relative { turn, offset, .. } = relative;
    let [i1, i2] = others(i);
    let (p, q) = (turn[i1][j], turn[i2][j]);
    let sine2 = p * p + q * q;
    if sine2 < PARALLEL {
        return None;
    }
    let along = if offset[i2] * p - offset[i1] * q < 0.0 { -1.0 } else { 1.0 } / sine2.sqrt();
    let (n1, n2) = (-q * along, p * along);
    let mut normal = [0.0; 3];
    (normal[i1], normal[i2]) = (n1, n2);
    let normal_second: Vec3 = std::array::from_fn(|k| n1 * turn[i1][k] + n2 * turn[i2][k]);
    let gap = n1 * offset[i1] + n2 * offset[i2]
        - (n1.abs() * size1[i1] + n2.abs() * size1[i2])
        - dot(normal_second.map(f64::abs), size2);
    Some(EdgeAxis { gap, edges: [i, j], normal, normal_second })
}

/// The edge axis if it is the best, and not almost the best face normal with almost its gap: many contacts
/// hold a body better than one. `slack` is what rounding may make of a gap.
fn preferred_edge(&Separation { face_gap, face, edge }: &Separation, slack: f64) -> Option<EdgeAxis> {
    edge.filter(|axis| {
        let cosine = match face {
            Face::First(a) => axis.normal[a],
            Face::Second(a) => axis.normal_second[a],
        };
        !(cosine.abs() > ALMOST_FACE && axis.gap < face_gap + FACE_BONUS * face_gap.abs() + slack)
    })
}

/// Midpoints of the edges parallel to axis `k` that support a box in direction `n`: the first one, or both.
fn supporting_edges(size: Vec3, n: Vec3, k: usize) -> ([Vec3; 2], usize) {
    let (mut middles, mut count) = ([[0.0; 3]; 2], 1);
    for m in others(k) {
        let side = if n[m] < 0.0 { -size[m] } else { size[m] };
        middles[0][m] = side;
        middles[1][m] = side;
        if count == 1 && n[m].abs() < LEVEL {
            middles[1][m] = -side;
            count = 2;
        }
    }
    (middles, count)
}

/// The nearest points of two segments: of x e_i, |x| <= `half1`, and of `d` + y b, |y| <= `half2`; b is a
/// unit vector, not parallel to e_i. x and y.
fn nearest_on_edges(i: usize, half1: f64, d: Vec3, b: Vec3, half2: f64) -> [f64; 2] {
    let [i1, i2] = others(i);
    let range = |half: f64| [-half, half];
    // Without ends the best y is where d + y b is nearest to the line along e_i. Stopping it at the ends, it
    // is the best for a free x; if the x that belongs to it lies beyond an end, the best x is that end (by
    // convexity), and y is the best for it.
    let y = -(d[i1] * b[i1] + d[i2] * b[i2]) / (b[i1] * b[i1] + b[i2] * b[i2]);
    let y = clip(y, range(half2));
    let x = clip(d[i] + y * b[i], range(half1));
    [x, clip(x * b[i] - dot(d, b), range(half2))]
}

/// The contact of an edge of the first box with one of the second.
fn edge_contact(
    first: &Shape,
    size2: Vec3,
    turn: &Turn,
    offset: Vec3,
    axis: EdgeAxis,
    limit: f64,
) -> Option<Touch> {
    let EdgeAxis { edges: [i, j], normal, normal_second, .. } = axis;
    let (middles1, count1) = supporting_edges(first.size, normal, i);
    let (middles2, count2) = supporting_edges(size2, scale(normal_second, -1.0), j);
    let along = [turn[0][j], turn[1][j], turn[2][j]];
    let (mut least, mut nearest) = (f64::INFINITY, [[0.0; 3]; 2]);
    for &m1 in middles1.iter().take(count1) {
        for &m2 in middles2.iter().take(count2) {
            let m2: Vec3 = std::array::from_fn(|k| offset[k] + dot(turn[k], m2));
            let [x, y] = nearest_on_edges(i, first.size[i], sub(m2, m1), along, size2[j]);
            let mut q1 = m1;
            q1[i] = x;
            let q2 = add_scaled(m2, along, y);
            let between = sub(q2, q1);
            let distance2 = dot(between, between);
            if distance2 < least {
                (least, nearest) = (distance2, [q1, q2]);
            }
        }
    }
    let [q1, q2] = nearest;
    let dist = dot(sub(q2, q1), normal);
    (least < f64::INFINITY && dist <= limit).then(|| Touch {
        dist,
        pos: first.world(scale(add(q1, q2), 0.5)),
        normal: mat_mul_vec(&first.mat, normal),
        tangent: [0.0; 3],
    })
}

/// A convex polygon over the reference face: x and y along the face, height above it.
struct Polygon {
    corners: [Vec3; 8],
    count: usize,
}

impl Polygon {
    const EMPTY: Polygon = Polygon { corners: [[0.0; 3]; 8], count: 0 };

    /// Four sides cut a quadrangle to eight corners at most; what rounding might add is dropped.
    #[cfg_attr(not(feature = "small"), inline(always))]
    fn push(&mut self, corner: Vec3) {
        if let Some(place) = self.corners.get_mut(self.count) {
            *place = corner;
            self.count += 1;
        }
    }

    fn corners(&self) -> &[Vec3] {
        self.corners.get(..self.count).unwrap_or_default()
    }

    /// The part where coordinate `k` times `side` is at most `bound`, from the same corner on in the same
    /// sense.
    fn clipped(&self, k: usize, side: f64, bound: f64) -> Polygon {
        let mut kept = Polygon::EMPTY;
        let corners = self.corners();
        let Some(&first) = corners.first() else { return kept };
        for (m, &corner) in corners.iter().enumerate() {
            let next = corners.get(m + 1).copied().unwrap_or(first);
            let (beyond, beyond_next) = (side * corner[k] - bound, side * next[k] - bound);
            if beyond <= 0.0 {
                kept.push(corner);
            }
            if (beyond <= 0.0) != (beyond_next <= 0.0) {
                let mut cut = add_scaled(corner, sub(next, corner), beyond / (beyond - beyond_next));
                cut[k] = side * bound;
                kept.push(cut);
            }
        }
        kept
    }
}

/// The contacts of a reference face, normal to axis `a` of the box `reference`, with the incident face of the
/// other box, which has the size `size`, the turn `turn` against the reference box and its centre at `offset`
/// in it. `outward` is 1 when the reference box is the first of the pair, -1 when it is the second.
#[allow(clippy::too_many_arguments)] // two boxes in the frame of one, and which of its faces
fn face_contacts(
    reference: &Shape,
    size: Vec3,
    turn: &Turn,
    offset: Vec3,
    a: usize,
    outward: f64,
    margin: f64,
    out: &mut Vec<Touch>,
) {
    let [x, y] = others(a);
    let half = [reference.size[x], reference.size[y]];
    let side = if offset[a] < 0.0 { -1.0 } else { 1.0 };

    let cosines = turn[a].map(f64::abs);
    let mut b = if cosines[1] > cosines[0] { 1 } else { 0 };
    b = if cosines[2] > cosines[b] { 2 } else { b };
    let [u, v] = others(b);
    let incident_side = if side * turn[a][b] > 0.0 { -size[b] } else { size[b] };
    // A vector of the other box seen over the reference face.
    let over = |k: usize, s: f64| [turn[x][k] * s, turn[y][k] * s, side * turn[a][k] * s];
    // The size last, so that the heights of faces that touch exactly are zero but for the tilt: as recorded.
    let mut centre = add([offset[x], offset[y], side * offset[a]], over(b, incident_side));
    centre[2] -= reference.size[a];
    let (edge_u, edge_v) = (over(u, size[u]), over(v, size[v]));
    // u before v: for faces that coincide the rounding tells which corners are beyond, as recorded.
    let (plus, minus) = (add(centre, edge_u), sub(centre, edge_u));

    let mut polygon = Polygon::EMPTY;
    for corner in [add(plus, edge_v), add(minus, edge_v), sub(minus, edge_v), sub(plus, edge_v)] {
        polygon.push(corner);
    }
    for k in 0..2 {
        for side in [1.0, -1.0] {
            // Of most faces that rest on one another, no corner is beyond.
            if polygon.corners().iter().any(|corner| side * corner[k] - half[k] > 0.0) {
                polygon = polygon.clipped(k, side, half[k]);
            }
        }
    }

    let same = SAME_CORNER * dot(half, half);
    let normal = scale(reference.axis(a), side * outward);
    let mut kept = Polygon::EMPTY;
    for &corner in polygon.corners() {
        let [px, py, height] = corner;
        let is_same = |q: &Vec3| (q[0] - px) * (q[0] - px) + (q[1] - py) * (q[1] - py) <= same;
        if height <= margin && !kept.corners().iter().any(is_same) {
            kept.push(corner);
            let mut pos = [0.0; 3];
            (pos[x], pos[y], pos[a]) = (px, py, side * (reference.size[a] + 0.5 * height));
            out.push(Touch { dist: height, pos: reference.world(pos), normal, tangent: [0.0; 3] });
        }
    }
}

#[cfg(test)]
mod tests;
