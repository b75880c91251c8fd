//! A box against a sphere and against a capsule. The box lies at the origin of the frame that is worked in.

use super::Touch;
use crate::geometry::Shape;
use crate::math::*;

/// The nearest point of the box; from inside, out through the nearest face.
pub(super) fn sphere_box(sphere: &Shape, cuboid: &Shape, margin: f64, out: &mut Vec<Touch>) {
    out.extend(ball(sphere.pos, sphere.size[0], cuboid, margin));
}

fn ball(at: Vec3, radius: f64, cuboid: &Shape, margin: f64) -> Option<Touch> {
    let size = cuboid.size;
    let centre = cuboid.local(at);
    let nearest: Vec3 = std::array::from_fn(|i| match size[i] > 0.0 {
        true => centre[i].max(-size[i]).min(size[i]),
        false => centre[i],
    });
    let (mut normal, mut dist) = normalize(sub(nearest, centre));
    if dist - radius > margin {
        return None;
    }
    let pos = if dist <= MINVAL {
        let mut depth = 2.0 * (size[0] + size[1] + size[2]);
        normal = [0.0; 3];
        for i in 0..3 {
            for side in [-1.0, 1.0] {
                let to_face = (side * size[i] - centre[i]).abs();
                if depth > to_face {
                    depth = to_face;
                    normal = [0.0; 3];
                    normal[i] = -side;
                }
            }
        }
        dist = -depth;
        add_scaled(centre, normal, 0.5 * (radius - depth))
    } else {
        let deepest = add_scaled(centre, normal, radius);
        add(scale(nearest, 0.5), scale(deepest, 0.5))
    };
    Some(Touch {
        dist: dist - radius,
        pos: cuboid.world(pos),
        normal: mat_mul_vec(&cuboid.mat, normal),
        tangent: [0.0; 3],
    })
}

/// Where the axis of a capsule comes nearest to a box.
#[derive(Clone, Copy, Debug)]
enum Feature {
    /// An end of the axis over a face with this axis; `None` when the end is inside the box.
    Face(Option<usize>),
    /// A corner, its bits saying on which side of each axis it is.
    Corner(usize),
    /// An edge along an axis, from a corner, at a place from -1 to 1.
    Edge { axis: usize, corner: usize, place: f64 },
}

/// The axis of a capsule as c + t h, t from -1 to 1.
struct Axis {
    centre: Vec3,
    half: Vec3,
    unit: Vec3,
    length: f64,
}

impl Axis {
    fn at(&self, t: f64) -> Vec3 {
        add_scaled(self.centre, self.half, t)
    }

    /// On which side of each axis of the box the half axis points, as the bits of a corner.
    fn octant(&self) -> usize {
        (0..3).map(|i| usize::from(self.half[i] > 0.0) << i).sum()
    }
}

/// A ball at the point of the axis that is nearest to the box; and a second one as far along the axis as it stays
/// over the box, when the axis lies along a face or an edge.
pub(super) fn capsule_box(capsule: &Shape, cuboid: &Shape, margin: f64, out: &mut Vec<Touch>) {
    let [radius, length, _] = capsule.size;
    let unit = mat_t_mul_vec(&cuboid.mat, capsule.axis(2));
    let axis = Axis { centre: cuboid.local(capsule.pos), half: scale(unit, length), unit, length };
    let size = cuboid.size;
    let far = margin + 2.0 * (radius + length + size[0] + size[1] + size[2]);
    let Some((t, feature)) = nearest_feature(&axis, size, far) else { return };
    let second = match feature {
        Feature::Face(face) => face.map(|face| over_face(&axis, size, t, face)),
        Feature::Corner(corner) => from_corner(&axis, size, t, corner),
        Feature::Edge { axis: along, corner, place } => from_edge(&axis, size, t, along, corner, place),
    };
    for t in [Some(t), second.map(|s| s + t)].into_iter().flatten() {
        out.extend(ball(cuboid.world(axis.at(t)), radius, cuboid, margin));
    }
}

fn nearest_feature(axis: &Axis, size: Vec3, far: f64) -> Option<(f64, Feature)> {
    let mut best2 = far;
    let mut best = None;
    for t in [-1.0, 1.0] {
        let end = axis.at(t);
        let inside: Vec3 = std::array::from_fn(|i| end[i].max(-size[i]).min(size[i]));
        let out = |i: &usize| end[*i].abs() > size[*i];
        // Past an edge or corner, these are nearer than any face.
        if (0..3).filter(out).count() > 1 {
            continue;
        }
        let to_box = sub(inside, end);
        let dist2 = dot(to_box, to_box);
        if dist2 < best2 {
            (best2, best) = (dist2, Some((t, Feature::Face((0..3).find(out)))));
        }
    }
    for j in 0..3 {
        for corner in (0..8).filter(|c| c >> j & 1 == 0) {
            let mut middle: Vec3 =
                std::array::from_fn(|i| if corner >> i & 1 == 1 { size[i] } else { -size[i] });
            middle[j] = 0.0;
            let Some(Closest { place, end, t }) = edge_and_axis(axis, size[j], j, middle) else { continue };
            let mut between = add_scaled(sub(middle, axis.centre), axis.half, -t);
            between[j] += size[j] * place;
            let dist2 = dot(between, between);
            // Slack keeps the first of equals when the axis is parallel to the box.
            if dist2 < best2 - MINVAL {
                let feature = match end {
                    Some(true) => Feature::Corner(corner | 1 << j),
                    Some(false) => Feature::Corner(corner),
                    None => Feature::Edge { axis: j, corner, place },
                };
                (best2, best) = (dist2, Some((t, feature)));
            }
        }
    }
    best
}

/// The nearest places of an edge and the axis of a capsule, each from -1 to 1.
struct Closest {
    place: f64,
    /// The upper or lower end of the edge, when the search came to it.
    end: Option<bool>,
    t: f64,
}

/// The nearest places of an edge of half length `size` along axis `j` and of the capsule's axis; `None` when they
/// are parallel.
fn edge_and_axis(axis: &Axis, size: f64, j: usize, middle: Vec3) -> Option<Closest> {
    let between = sub(middle, axis.centre);
    let (ee, ea, aa) = (size * size, -size * axis.half[j], axis.length * axis.length);
    let (u, v) = (-size * between[j], dot(axis.half, between));
    let det = ee * aa - ea * ea;
    if det.abs() < MINVAL {
        return None;
    }
    let inverse = 1.0 / det;
    let (mut place, mut t) = ((aa * u - ea * v) * inverse, (ee * v - ea * u) * inverse);
    let beyond = |place: f64| (place.abs() > 1.0).then_some(place > 0.0);
    let mut end = beyond(place);
    if end.is_some() {
        place = place.signum();
        t = (v - place * ea) * (1.0 / aa);
    }
    if t.abs() > 1.0 {
        t = t.signum();
        place = (u - t * ea) * (1.0 / ee);
        end = beyond(place).or(end);
        place = place.clamp(-1.0, 1.0);
    }
    Some(Closest { place, end, t })
}

/// How far along the axis the other end is still over the face, from the end over it.
fn over_face(axis: &Axis, size: Vec3, t: f64, face: usize) -> f64 {
    let (inwards, end) = (-t, axis.at(t));
    let mut far = 2.0;
    for i in (0..3).filter(|&i| i != face) {
        for side in [size[i], -size[i]] {
            let leaves = (side - end[i]) / axis.half[i] * inwards;
            if leaves > 0.0 && leaves < far {
                far = leaves;
            }
        }
    }
    far * inwards
}

/// The lesser of two lengths, the first when the second is not a number.
fn at_most(x: f64, limit: f64) -> f64 {
    if limit < x { limit } else { x }
}

/// From a corner along its edge or over its face; nowhere when the axis points to the corner or away from it.
fn from_corner(axis: &Axis, size: Vec3, t: f64, corner: usize) -> Option<f64> {
    let differ = axis.octant() ^ corner;
    let (odd, ahead) = match differ.count_ones() {
        1 => (differ, 1.0),
        2 => (7 - differ, -1.0),
        _ => return None,
    };
    let i = odd.trailing_zeros() as usize;
    let span = |i: usize| 2.0 * size[i] / axis.half[i].abs();
    Some(if axis.unit[i] * axis.unit[i] > 0.5 {
        at_most(1.0 - ahead * t, span(i)) * ahead
    } else {
        let far = at_most(1.0 + ahead * t, span((i + 1) % 3));
        at_most(far, span((i + 2) % 3)) * -ahead
    })
}

/// From a point on an edge over the face that the axis is flatter to; nowhere when both are crossed like a T.
fn from_edge(axis: &Axis, size: Vec3, t: f64, along: usize, corner: usize, place: f64) -> Option<f64> {
    let octant = axis.octant();
    let differ = (octant ^ corner) & !(1 << along);
    if differ.count_ones() != 1 {
        return None;
    }
    let (j, k) = ((along + 1) % 3, (along + 2) % 3);
    // The axis leans most along `lean`, away from the edge over a face.
    let lean = if axis.unit[j].abs() > axis.unit[k].abs() { j } else { k };
    let forward = differ >> lean & 1 == 1;
    let ahead = if forward { 1.0 } else { -1.0 };
    let far = at_most(1.0 - ahead * t, 2.0 * size[lean] / axis.half[lean].abs());
    let rest = if (octant >> along & 1 == 1) == forward { 1.0 - place } else { 1.0 + place };
    Some(at_most(far, size[along] * rest / axis.half[along].abs()) * ahead)
}
