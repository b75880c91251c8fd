//! Contacts of a sphere and of a capsule with a box.
//!
//! The contacts of a capsule with a box are those of one or two balls of its radius, centred on its axis. The axis is
//! the segment c + t h, |t| ≤ 1, in the frame of the box.
//!
//! *Axis outside the box*: for the point p = c + t h and the half sizes s, the squared distance from the box is Σ
//! eᵢ², with eᵢ = pᵢ - clamp(pᵢ, ±sᵢ). It is a convex function of t. Half its derivative, Σ hᵢ eᵢ, is non-decreasing
//! and linear between the planes of the faces, so its zero is found without iteration. The first ball is at this
//! zero. If the derivative is zero on an interval, because the axis is parallel to a face or an edge, there is a ball
//! at each end of the interval. Otherwise the second ball is at the point where the capsule, followed across the box
//! from the first ball, leaves it.
//!
//! *Axis intersecting the box*: the shortest translation that separates segment and box is along a face normal or
//! along the common perpendicular of the segment and an edge (the separating axes of the two). The contacts are at
//! the ends of the part of the segment below the face, or between the closest points of segment and edge.

use super::ContactPoint;
use crate::geometry::Shape;
use crate::geometry::clip::ROUNDING;
use crate::geometry::ray::slab;
use crate::geometry::segments::{Segment, closest_points};
use crate::math::*;

/// Contact of a sphere and a box.
pub(super) fn sphere_box(sphere: &Shape, cuboid: &Shape, margin: f64, out: &mut Vec<ContactPoint>) {
    out.extend(ball(cuboid.local(sphere.pos), sphere.size[0], cuboid, margin));
}

/// Contacts of a capsule and a box: none, one or two.
pub(super) fn capsule_box(capsule: &Shape, cuboid: &Shape, margin: f64, out: &mut Vec<ContactPoint>) {
    let [radius, half_length, _] = capsule.size;
    if half_length <= 0.0 {
        return sphere_box(capsule, cuboid, margin, out);
    }
    let half = mat_t_mul_vec(&cuboid.mat, scale(capsule.axis(2), half_length));
    let segment = Segment { centre: cuboid.local(capsule.pos), half };
    let axis = CapsuleAxis { segment, size: cuboid.size };
    let [from, to] = axis.nearest();
    let distance = norm(axis.offset_from_box(from));
    if distance <= axis.rounding() {
        let contacts = axis.pierced(radius).into_iter().flatten();
        out.extend(contacts.filter(|c| c.dist <= margin).map(|c| to_world(cuboid, c)));
    } else if distance - radius <= margin {
        let second = if from == to { axis.exit_parameter(from) } else { Some(to) };
        let balls = [Some(from), second].into_iter().flatten();
        out.extend(balls.filter_map(|t| ball(segment.at(t), radius, cuboid, margin)));
    }
}

/// Transforms a contact from the frame of the box to the world frame.
fn to_world(cuboid: &Shape, contact: ContactPoint) -> ContactPoint {
    ContactPoint {
        pos: cuboid.world(contact.pos),
        normal: mat_mul_vec(&cuboid.mat, contact.normal),
        ..contact
    }
}

/// Contact of the box and a ball whose centre is given in the frame of the box.
fn ball(centre: Vec3, radius: f64, cuboid: &Shape, margin: f64) -> Option<ContactPoint> {
    let size = cuboid.size;
    let nearest: Vec3 = std::array::from_fn(|i| clip(centre[i], [-size[i], size[i]]));
    let offset = sub(nearest, centre);
    let gap = norm(offset);
    let (normal, gap) = if gap > MINVAL * (radius + size[0] + size[1] + size[2]) {
        (scale(offset, 1.0 / gap), gap)
    } else {
        nearest_face(centre, size)
    };
    let dist = gap - radius;
    // This comparison is false for NaN.
    (dist <= margin).then(|| {
        let pos = add_scaled(centre, normal, radius + 0.5 * dist);
        to_world(cuboid, ContactPoint { dist, pos, normal, tangent: [0.0; 3] })
    })
}

/// For a point in the box: the inward normal of the nearest face, and minus the depth below it. Of equally near
/// faces, the one normal to the axis with the lowest index is taken, and of its two sides the negative one.
fn nearest_face(p: Vec3, size: Vec3) -> (Vec3, f64) {
    let mut best = ([0.0; 3], f64::NEG_INFINITY);
    for i in 0..3 {
        for side in [-1.0, 1.0] {
            let gap = side * p[i] - size[i];
            if gap > best.1 {
                best = ([0.0; 3], gap);
                best.0[i] = -side;
            }
        }
    }
    best
}

/// The axis of a capsule in the frame of a box with half sizes `size`.
struct CapsuleAxis {
    segment: Segment,
    size: Vec3,
}

impl CapsuleAxis {
    /// Vector from the nearest point of the box to the point `t` of the axis.
    #[cfg_attr(not(feature = "small"), inline(always))]
    fn offset_from_box(&self, t: f64) -> Vec3 {
        let p = self.segment.at(t);
        std::array::from_fn(|i| p[i] - clamp(p[i], -self.size[i], self.size[i]))
    }

    /// Rounding error of a length.
    #[cfg_attr(not(feature = "small"), inline(always))]
    fn rounding(&self) -> f64 {
        let sum = |v: Vec3| v[0].abs() + v[1].abs() + v[2].abs();
        ROUNDING * (sum(self.segment.centre) + sum(self.segment.half) + sum(self.size))
    }

    /// The interval of the axis that is nearest to the box; in general a single point. The end that is nearer to the
    /// box comes first.
    fn nearest(&self) -> [f64; 2] {
        let Segment { centre, half } = self.segment;
        let slack = self.rounding() * norm(half);
        // A parameter t and half the derivative there: the largest t where the distance decreases, and the smallest t
        // where it increases.
        let (mut falls, mut rises) = ([f64::NEG_INFINITY, 0.0], [f64::INFINITY, 0.0]);
        let mut level = [f64::INFINITY, f64::NEG_INFINITY];
        let mut look = |t: f64| {
            let slope = dot(half, self.offset_from_box(t));
            if slope < -slack && t > falls[0] {
                falls = [t, slope];
            } else if slope > slack && t < rises[0] {
                rises = [t, slope];
            } else if slope.abs() <= slack {
                level = [level[0].min(t), level[1].max(t)];
            }
        };
        look(-1.0);
        look(1.0);
        for i in 0..3 {
            for t in slab(centre[i], half[i], self.size[i]) {
                if t.abs() < 1.0 {
                    look(t);
                }
            }
        }
        if level[0] <= level[1] {
            let [a, b] = level;
            let square = |t: f64| dot(self.offset_from_box(t), self.offset_from_box(t));
            return if a < b && square(b) < square(a) { [b, a] } else { level };
        }
        let ([a, at_a], [b, at_b]) = (falls, rises);
        let t = if a == f64::NEG_INFINITY {
            -1.0
        } else if b == f64::INFINITY {
            1.0
        } else {
            a - at_a * (b - a) / (at_b - at_a)
        };
        [t, t]
    }

    /// The parameter at which the capsule leaves the box, when followed from the point of the axis that is nearest to
    /// a face, an edge or a corner. From an end of the axis over a face, the capsule is followed along its axis. From
    /// an edge or a corner, it is followed in the direction whose components into the box are larger. The capsule
    /// stays over the box for the shortest of these lengths: up to the end of the axis; the width of the box, along
    /// each axis on which the capsule enters over an edge; up to the end of the face, along the other axes.
    fn exit_parameter(&self, t: f64) -> Option<f64> {
        let (p, half, size) = (self.segment.at(t), self.segment.half, self.size);
        let slack = self.rounding();
        let side: Vec3 =
            std::array::from_fn(|i| if p[i].abs() >= size[i] - slack { 1f64.copysign(p[i]) } else { 0.0 });
        // Squared length of the components that point into the box, forwards and backwards along the axis.
        let (mut forwards, mut backwards) = (0.0, 0.0);
        for i in 0..3 {
            let inwards = -side[i] * half[i];
            forwards += if inwards > 0.0 { half[i] * half[i] } else { 0.0 };
            backwards += if inwards < 0.0 { half[i] * half[i] } else { 0.0 };
        }
        let sense = match side.iter().filter(|s| **s != 0.0).count() {
            0 => return None,
            1 if t.abs() == 1.0 => -t,
            1 => return None,
            _ if forwards > backwards => 1.0,
            _ => -1.0,
        };
        let mut length = 1.0 - sense * t;
        for i in 0..3 {
            let ahead = sense * half[i];
            if side[i] == 0.0 {
                length = length.min((size[i] - p[i] * 1f64.copysign(ahead)) / ahead.abs());
            } else if side[i] * ahead < 0.0 {
                length = length.min(2.0 * size[i] / ahead.abs());
            }
        }
        (length > 0.0).then_some(t + sense * length)
    }

    /// Contacts of a capsule whose axis intersects the box, in the frame of the box.
    fn pierced(&self, radius: f64) -> [Option<ContactPoint>; 2] {
        let Segment { centre, half } = self.segment;
        let [x, y, z] = self.size;
        let slack = self.rounding();
        let (mut best, mut face) = (f64::NEG_INFINITY, 0);
        for i in 0..3 {
            let gap = centre[i].abs() - half[i].abs() - self.size[i];
            if gap > best + slack {
                (best, face) = (gap, i);
            }
        }
        let mut edge = None;
        for i in 0..3 {
            let mut along = [0.0; 3];
            along[i] = 1.0;
            let across = cross(along, half);
            let length = norm(across);
            let reach = x * across[0].abs() + y * across[1].abs() + z * across[2].abs();
            // The subtracted term is the rounding error of the products, which the division by a small length
            // magnifies.
            let gap = (dot(across, centre).abs() - reach - slack * norm(half)) / length;
            if gap > best {
                (best, edge) = (gap, Some((i, scale(across, -1f64.copysign(dot(across, centre)) / length))));
            }
        }
        match edge {
            Some((i, normal)) => [Some(self.edge_contact(i, normal, radius)), None],
            None => self.face_contacts(face, radius),
        }
    }

    /// The contacts at the ends of the part of the axis inside the side planes of face `i`. The face is the upper or
    /// lower one, whichever is nearer to the centre of the capsule.
    fn face_contacts(&self, i: usize, radius: f64) -> [Option<ContactPoint>; 2] {
        let Segment { centre, half } = self.segment;
        let side = 1f64.copysign(centre[i]);
        let mut normal = [0.0; 3];
        normal[i] = -side;
        let contact = |t: f64| {
            let p = self.segment.at(t);
            let dist = side * p[i] - self.size[i] - radius;
            ContactPoint { dist, pos: add_scaled(p, normal, radius + 0.5 * dist), normal, tangent: [0.0; 3] }
        };
        let (mut from, mut to) = (-1f64, 1f64);
        for k in [(i + 1) % 3, (i + 2) % 3] {
            let [a, b] = slab(centre[k], half[k], self.size[k]);
            (from, to) = (from.max(a), to.min(b));
        }
        if from < to {
            [from, to].map(|t| Some(contact(t)))
        } else {
            // The box has no thickness.
            [Some(contact(clamp(0.5 * (from + to), -1.0, 1.0))), None]
        }
    }

    /// The contact with the edge along axis `i` that is farthest in the direction opposite to the normal. The normal
    /// points from the capsule to the box.
    fn edge_contact(&self, i: usize, normal: Vec3, radius: f64) -> ContactPoint {
        let mut edge = Segment { centre: [0.0; 3], half: [0.0; 3] };
        for k in 0..3 {
            let place = if k == i { &mut edge.half[k] } else { &mut edge.centre[k] };
            *place = if k == i { self.size[k] } else { self.size[k].copysign(-normal[k]) };
        }
        let [t, y] = closest_points(&self.segment, &edge);
        let (on_axis, on_edge) = (self.segment.at(t), edge.at(y));
        let dist = dot(sub(on_edge, on_axis), normal) - radius;
        let on_capsule = add_scaled(on_axis, normal, radius);
        ContactPoint { dist, pos: scale(add(on_capsule, on_edge), 0.5), normal, tangent: [0.0; 3] }
    }
}

#[cfg(test)]
mod tests;
