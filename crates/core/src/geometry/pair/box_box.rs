//! Two boxes: the axis that separates them best, then the contacts along it.
//!
//! Separating axes after Gottschalk, Lin, Manocha: *OBBTree* (1996): three face normals of each box and nine cross
//! products of edges. Along a face normal, the face of the other box that looks against it is clipped by the sides of
//! the first (Sutherland, Hodgman: *Reentrant polygon clipping*, 1974); across two edges, the contact is where these
//! come nearest. Faces give several points and are preferred where both would do.

use super::Touch;
use crate::geometry::Shape;
use crate::math::*;

/// Slack of the separation, in half sizes of both boxes: their reach along an axis is not known better.
const SEPARATION_SLACK: f64 = 1e-13;
/// Squared sine of two edges below which their cross product has no direction.
const PARALLEL: f64 = 1e-16;
/// An edge must separate better than a face by this part.
const EDGE_PENALTY: f64 = 1e-6;
/// Cosine of an edge axis and a face normal above which they are the same contact …
const ALIKE: f64 = 0.99;
/// … unless the edge is better by this part of the face's depth.
const ALIKE_GAIN: f64 = 0.05;
/// Component of an axis below which both edges on its sides support it.
const EITHER_SIDE: f64 = 1e-9;
/// Squared distance of equal corners of a clipped face, relative to its size.
const SAME_CORNER: f64 = 1e-14;

/// Both boxes in the frame of the first.
struct Boxes<'a> {
    first: &'a Shape<'a>,
    second: &'a Shape<'a>,
    /// Axes of the second as columns.
    turn: Mat3,
    /// Centre of the second, and of the first in the frame of the second.
    second_at: Vec3,
    first_at: Vec3,
}

/// The direction that separates best.
#[derive(Clone, Copy, Debug)]
enum Axis {
    /// Normal of a face: of the first box or not, along this axis.
    Face(bool, usize),
    /// Across an edge of each box.
    Edges(usize, usize),
}

pub(super) fn box_box(first: &Shape, second: &Shape, margin: f64, out: &mut Vec<Touch>) {
    let apart = sub(second.pos, first.pos);
    let columns = [0, 1, 2].map(|j| mat_t_mul_vec(&first.mat, second.axis(j)));
    let boxes = Boxes {
        first,
        second,
        turn: std::array::from_fn(|i| columns[i % 3][i / 3]),
        second_at: mat_t_mul_vec(&first.mat, apart),
        first_at: mat_t_mul_vec(&second.mat, scale(apart, -1.0)),
    };
    let sizes: f64 = first.size.iter().chain(&second.size).sum();
    let limit = margin + SEPARATION_SLACK * sizes;
    match boxes.best_axis(limit) {
        Some(Axis::Edges(i, j)) => out.extend(boxes.edges(i, j, limit)),
        Some(Axis::Face(of_first, axis)) => boxes.face(of_first, axis, margin, out),
        None => {}
    }
}

impl Boxes<'_> {
    /// The axis of largest separation, `None` when it is above the limit.
    fn best_axis(&self, limit: f64) -> Option<Axis> {
        let (s1, s2) = (self.first.size, self.second.size);
        let turn = self.turn.map(f64::abs);
        let mut best = -1e10;
        let mut axis = Axis::Face(true, 0);
        for i in 0..3 {
            let reach = turn[3 * i] * s2[0] + turn[3 * i + 1] * s2[1] + turn[3 * i + 2] * s2[2];
            let gap = self.second_at[i].abs() - s1[i] - reach;
            if gap > limit {
                return None;
            }
            if gap > best {
                (best, axis) = (gap, Axis::Face(true, i));
            }
        }
        for j in 0..3 {
            let reach = turn[j] * s1[0] + turn[3 + j] * s1[1] + turn[6 + j] * s1[2];
            let gap = self.first_at[j].abs() - s2[j] - reach;
            if gap > limit {
                return None;
            }
            if gap > best {
                (best, axis) = (gap, Axis::Face(false, j));
            }
        }
        let (face_gap, face) = (best, axis);
        for i in 0..3 {
            for j in 0..3 {
                let Some(gap) = self.edge_gap(i, j) else { continue };
                if gap > limit {
                    return None;
                }
                if gap - EDGE_PENALTY * gap.abs() > best && gap > face_gap {
                    (best, axis) = (gap, Axis::Edges(i, j));
                }
            }
        }
        if let Axis::Edges(i, j) = axis {
            let across = self.across(i, j);
            let cosine = match face {
                Axis::Face(true, f) => across[f].abs(),
                Axis::Face(false, f) => dot(across, column(&self.turn, f)).abs(),
                Axis::Edges(..) => 0.0,
            };
            if cosine > ALIKE && best < face_gap + ALIKE_GAIN * face_gap.abs() + MINVAL {
                axis = face;
            }
        }
        Some(axis)
    }

    /// Separation across edge `i` of the first and `j` of the second box; `None` when they are parallel.
    fn edge_gap(&self, i: usize, j: usize) -> Option<f64> {
        let (s1, s2, t) = (self.first.size, self.second.size, &self.turn);
        let (i1, i2, j1, j2) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
        // e_i × column j has no component along i.
        let (u, v) = (-t[3 * i2 + j], t[3 * i1 + j]);
        let length2 = u * u + v * v;
        if length2 < PARALLEL {
            return None;
        }
        let inverse = 1.0 / length2.sqrt();
        let (u, v) = (u * inverse, v * inverse);
        let first = s1[i1] * u.abs() + s1[i2] * v.abs();
        let along = |k: usize| (u * t[3 * i1 + k] + v * t[3 * i2 + k]).abs();
        let second = s2[j1] * along(j1) + s2[j2] * along(j2);
        Some((u * self.second_at[i1] + v * self.second_at[i2]).abs() - first - second)
    }

    /// The unit vector across two edges.
    fn across(&self, i: usize, j: usize) -> Vec3 {
        let (i1, i2) = ((i + 1) % 3, (i + 2) % 3);
        let mut axis = [0.0; 3];
        (axis[i1], axis[i2]) = (-self.turn[3 * i2 + j], self.turn[3 * i1 + j]);
        normalize(axis).0
    }

    /// One contact in the middle of the nearest points of two edges.
    fn edges(&self, i: usize, j: usize, limit: f64) -> Option<Touch> {
        let (s1, s2) = (self.first.size, self.second.size);
        let mut axis = self.across(i, j);
        if dot(axis, self.second_at) < 0.0 {
            axis = scale(axis, -1.0);
        }
        let against = mat_t_mul_vec(&self.turn, axis);
        // The edge of each box that is farthest along the axis; when the axis lies in a face, either edge of it.
        let corners1 = supporting(i, s1, axis);
        let corners2 = supporting(j, s2, scale(against, -1.0));
        let along = column(&self.turn, j);
        let mut nearest = None;
        let mut least = 1e10;
        for &c1 in corners1.iter().flatten() {
            for &c2 in corners2.iter().flatten() {
                let c2 = add(mat_mul_vec(&self.turn, c2), self.second_at);
                let (p1, p2) = nearest_on_lines(c1, i, s1[i], c2, along, s2[j]);
                let gap = sub(p2, p1);
                if dot(gap, gap) < least {
                    (least, nearest) = (dot(gap, gap), Some((p1, p2)));
                }
            }
        }
        let (p1, p2) = nearest?;
        let dist = dot(sub(p2, p1), axis);
        (dist <= limit).then(|| Touch {
            dist,
            pos: self.first.world(scale(add(p1, p2), 0.5)),
            normal: mat_mul_vec(&self.first.mat, axis),
            tangent: [0.0; 3],
        })
    }

    /// The other box's face, clipped by the sides of a face: contacts half way between the two.
    fn face(&self, of_first: bool, a: usize, margin: f64, out: &mut Vec<Touch>) {
        let (own, other, at) = match of_first {
            true => (self.first, self.second, self.second_at),
            false => (self.second, self.first, self.first_at),
        };
        // Component r of the other's axis c.
        let turn = |r: usize, c: usize| self.turn[if of_first { 3 * r + c } else { 3 * c + r }];
        let side = if at[a] >= 0.0 { 1.0 } else { -1.0 };
        let mut b = 0;
        for k in 1..3 {
            if turn(a, k).abs() > turn(a, b).abs() {
                b = k;
            }
        }
        let towards = if side * turn(a, b) > 0.0 { -1.0 } else { 1.0 };

        // The face in the plane's two axes, and its height above the plane.
        let (ax, ay) = ((a + 1) % 3, (a + 2) % 3);
        let (bu, bv) = ((b + 1) % 3, (b + 2) % 3);
        let seen = |v: Vec3| [v[ax], v[ay], side * v[a]];
        let edge = |k: usize| seen([0, 1, 2].map(|r| other.size[k] * turn(r, k)));
        let mut centre = seen([0, 1, 2].map(|r| at[r] + towards * other.size[b] * turn(r, b)));
        centre[2] -= own.size[a];
        let (u, v) = (edge(bu), edge(bv));
        let mut polygon = Polygon::new(
            [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)]
                .map(|(su, sv)| add(add(centre, scale(u, su)), scale(v, sv))),
        );
        for (k, limit) in [(0, own.size[ax]), (1, own.size[ay])] {
            polygon.clip(|p| p[k] - limit);
            polygon.clip(|p| -p[k] - limit);
        }

        let same = SAME_CORNER * (own.size[ax] * own.size[ax] + own.size[ay] * own.size[ay]);
        let normal = scale(own.axis(a), if of_first { side } else { -side });
        let corners = polygon.corners();
        for (k, &p) in corners.iter().enumerate() {
            let twice = |q: &Vec3| {
                let (dx, dy) = (q[0] - p[0], q[1] - p[1]);
                q[2] <= margin && dx * dx + dy * dy < same
            };
            if p[2] > margin || corners[..k].iter().any(twice) {
                continue;
            }
            let mut pos = [0.0; 3];
            (pos[ax], pos[ay], pos[a]) = (p[0], p[1], side * (own.size[a] + 0.5 * p[2]));
            out.push(Touch { dist: p[2], pos: own.world(pos), normal, tangent: [0.0; 3] });
        }
    }
}

/// Middles of the edges along axis `i` that are farthest in a direction: two when it lies in a face.
fn supporting(i: usize, size: Vec3, dir: Vec3) -> [Option<Vec3>; 2] {
    let (j, k) = ((i + 1) % 3, (i + 2) % 3);
    let mut middle = [0.0; 3];
    for n in [j, k] {
        middle[n] = if dir[n] >= 0.0 { size[n] } else { -size[n] };
    }
    let other = [j, k].into_iter().find(|&n| dir[n].abs() < EITHER_SIDE).map(|n| {
        let mut other = middle;
        other[n] = -other[n];
        other
    });
    [Some(middle), other]
}

/// The nearest points of two segments: through `c1` along axis `i` and through `c2` along a unit vector.
fn nearest_on_lines(c1: Vec3, i: usize, half1: f64, c2: Vec3, along: Vec3, half2: f64) -> (Vec3, Vec3) {
    let between = sub(c2, c1);
    let (d1, d2, cosine) = (between[i], dot(along, between), along[i]);
    let sine2 = 1.0 - cosine * cosine;
    let clip = |x: f64, half: f64| x.max(-half).min(half);
    let s = if sine2 < MINVAL { 0.0 } else { (d1 - cosine * d2) / sine2 };
    let t = clip(cosine * clip(s, half1) - d2, half2);
    let s = clip(d1 + cosine * t, half1);
    let mut p1 = c1;
    p1[i] += s;
    (p1, add_scaled(c2, along, t))
}

/// A face that is clipped: each of four half planes adds a corner at most.
struct Polygon {
    corners: [Vec3; Polygon::MOST],
    n: usize,
}

impl Polygon {
    const MOST: usize = 12;

    fn new(face: [Vec3; 4]) -> Polygon {
        let mut corners = [[0.0; 3]; Polygon::MOST];
        corners[..4].copy_from_slice(&face);
        Polygon { corners, n: 4 }
    }

    fn corners(&self) -> &[Vec3] {
        &self.corners[..self.n]
    }

    /// Keeps what is at or below zero.
    fn clip(&mut self, height: impl Fn(Vec3) -> f64) {
        let old = self.corners;
        let n = self.n;
        if old[..n].iter().all(|&p| height(p) <= 0.0) {
            return;
        }
        self.n = 0;
        for k in 0..n {
            let (p, q) = (old[k], old[(k + 1) % n]);
            let (hp, hq) = (height(p), height(q));
            if hp <= 0.0 {
                self.push(p);
            }
            if hp * hq < 0.0 {
                self.push(add_scaled(p, sub(q, p), hp / (hp - hq)));
            }
        }
    }

    fn push(&mut self, p: Vec3) {
        if let Some(corner) = self.corners.get_mut(self.n) {
            *corner = p;
            self.n += 1;
        }
    }
}
