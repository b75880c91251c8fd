//! Contacts of a sphere and of a capsule with a box.
//!
//! A capsule touches a box like one or two balls of its radius on its axis, and everything is worked out in
//! the frame of the box. The first ball sits at the point of the axis nearest to the box. The squared
//! distance along the axis, Σ max(0, |cᵢ + t hᵢ| - sᵢ)², is a convex piecewise quadratic of one variable,
//! and its minimum is found exactly: piece by piece between at most six sorted breakpoints, without
//! iteration.
//!
//! Where that minimum is not unique, where the second ball sits, and beyond which distance nothing is found,
//! geometry does not say: these are conventions, taken from the recorded behaviour of MuJoCo 3.14.0.

use super::Touch;
use crate::geometry::Shape;
use crate::math::sort::sort_by;
use crate::math::*;

/// Squared sine of the angle up to which an axis is parallel to an edge.
const PARALLEL: f64 = 1e-12;

/// Contact of a sphere and a box.
pub(super) fn sphere_box(sphere: &Shape, cuboid: &Shape, margin: f64, out: &mut Vec<Touch>) {
    out.extend(ball(cuboid.local(sphere.pos), sphere.size[0], cuboid, margin));
}

/// Contacts of a capsule and a box: none, one or two.
pub(super) fn capsule_box(capsule: &Shape, cuboid: &Shape, margin: f64, out: &mut Vec<Touch>) {
    let [radius, half_length, _] = capsule.size;
    let axis = Axis {
        centre: cuboid.local(capsule.pos),
        half: mat_t_mul_vec(&cuboid.mat, scale(capsule.axis(2), half_length)),
        size: cuboid.size,
    };
    let first = nearest(&axis);
    // Of what is farther neither ball touches. (The library compares the square with the length: there, large shapes that
    // overlap by little are lost.)
    let [a, b, c] = cuboid.size;
    let reach = margin + 2.0 * (radius + half_length + a + b + c);
    if first.square < reach * reach {
        let second = second_ball(&axis, &first);
        for t in [Some(first.t), second].into_iter().flatten() {
            out.extend(ball(axis.at(t), radius, cuboid, margin));
        }
    }
}

/// Contact of the box and a ball, whose centre is given in the frame of the box.
fn ball(centre: Vec3, radius: f64, cuboid: &Shape, margin: f64) -> Option<Touch> {
    let nearest: Vec3 = std::array::from_fn(|i| clip(centre[i], [-cuboid.size[i], cuboid.size[i]]));
    let apart = sub(nearest, centre);
    let gap = norm(apart);
    let touching = MINVAL * (radius + cuboid.size.iter().sum::<f64>());
    let (normal, dist, pos) = if gap > touching {
        let normal = scale(apart, 1.0 / gap);
        (normal, gap - radius, scale(add(nearest, add_scaled(centre, normal, radius)), 0.5))
    } else {
        let (depth, normal) = way_in(centre, cuboid.size);
        (normal, -depth - radius, add_scaled(centre, normal, 0.5 * (radius - depth)))
    };
    // A NaN fails either comparison.
    (gap - radius <= margin && dist <= margin).then(|| Touch {
        dist,
        pos: cuboid.world(pos),
        normal: mat_mul_vec(&cuboid.mat, normal),
        tangent: [0.0; 3],
    })
}

/// Of a point in the box: how deep it lies under the nearest face, and that face's inward normal. Among
/// equally near faces the lowest axis counts, and its negative side.
fn way_in(p: Vec3, size: Vec3) -> (f64, Vec3) {
    let (mut least, mut normal) = (f64::INFINITY, [0.0; 3]);
    for i in 0..3 {
        for side in [-1.0, 1.0] {
            let depth = size[i] - side * p[i];
            if depth < least {
                (least, normal) = (depth, [0.0; 3]);
                normal[i] = -side;
            }
        }
    }
    (least, normal)
}

/// A capsule's axis in the frame of a box: centre + t half, t in [-1, 1]; and the half lengths of the box.
struct Axis {
    centre: Vec3,
    half: Vec3,
    size: Vec3,
}

/// Per box axis the side of the box beyond which something lies: -1, 1, or 0 for between the two faces. As a
/// feature of the box: a face has one side, an edge two, a corner three.
type Sides = Vec3;

/// Where the first ball sits.
struct First {
    /// Parameter of the axis.
    t: f64,
    /// The feature of the box that is nearest there.
    sides: Sides,
    /// Its squared distance.
    square: f64,
}

impl Axis {
    fn at(&self, t: f64) -> Vec3 {
        add_scaled(self.centre, self.half, t)
    }

    /// The feature of the box that is nearest to a point of the axis; no sides: the point is in the box.
    fn sides(&self, t: f64) -> Sides {
        let p = self.at(t);
        std::array::from_fn(|i| if p[i].abs() > self.size[i] { 1f64.copysign(p[i]) } else { 0.0 })
    }

    /// Squared distance of a point of the axis from the box.
    fn square(&self, t: f64) -> f64 {
        let p = self.at(t);
        let beyond: Vec3 = std::array::from_fn(|i| (p[i].abs() - self.size[i]).max(0.0));
        dot(beyond, beyond)
    }

    /// Where the axis crosses the plane of a face; infinite or NaN if it is parallel.
    fn crossing(&self, i: usize, side: f64) -> f64 {
        (side * self.size[i] - self.centre[i]) / self.half[i]
    }

    /// Where the line of the axis is nearest to the planes of some sides, by the sum of squared distances.
    /// None if it is parallel to all of them.
    fn turn(&self, sides: Sides) -> Option<f64> {
        let (mut up, mut down) = (0.0, 0.0);
        for (i, side) in sides.into_iter().enumerate().filter(|(_, side)| *side != 0.0) {
            up += self.half[i] * (side * self.size[i] - self.centre[i]);
            down += self.half[i] * self.half[i];
        }
        (down > 0.0).then(|| up / down)
    }

    /// The ends of the axis and the places between where it crosses the planes of the faces, in order.
    fn knots(&self) -> [f64; 8] {
        let mut knots = [1.0; 8];
        knots[0] = -1.0;
        for i in 0..3 {
            for (k, side) in [-1.0, 1.0].into_iter().enumerate() {
                let t = self.crossing(i, side);
                if t.abs() < 1.0 {
                    knots[1 + 2 * i + k] = t;
                }
            }
        }
        sort_by(&mut knots, f64::total_cmp);
        knots
    }

    /// Rounding errors of a distance are below this.
    fn rounding(&self) -> f64 {
        let sum = |a: Vec3| a[0].abs() + a[1].abs() + a[2].abs();
        1e-15 * (sum(self.centre) + sum(self.half) + sum(self.size))
    }
}

fn count(sides: Sides) -> usize {
    sides.iter().filter(|side| **side != 0.0).count()
}

/// The point of the axis nearest to the box.
fn nearest(axis: &Axis) -> First {
    let knots = axis.knots();
    let pieces = || knots.iter().zip(&knots[1..]).map(|(&a, &b)| (a, b)).filter(|(a, b)| a < b);
    if pieces().any(|(a, b)| count(axis.sides(0.5 * (a + b))) == 0) {
        return pierced(axis);
    }
    let (t, sides) = lowest(axis, pieces());
    let square = axis.square(t);

    // What is as near as the nearest to rounding: an end over a face, else what an interval of the axis
    // shares.
    let enough = (square.sqrt() + axis.rounding()).powi(2);
    for end in [-1.0, 1.0] {
        let sides = axis.sides(end);
        if count(sides) == 1 && axis.square(end) <= enough {
            return First { t: end, sides, square };
        }
    }
    let mut level = knots.into_iter().filter(|&t| axis.square(t) <= enough);
    if let (Some(from), Some(to)) = (level.next(), level.next_back())
        && from < to
    {
        let sides = axis.sides(0.5 * (from + to));
        match count(sides) {
            1 => return to_corner(axis, along_face(axis, sides, [from, to], square)),
            2 => return along_edge(axis, sides, [from, to]),
            _ => {}
        }
    }
    to_corner(axis, First { t, sides, square })
}

/// The minimum of the squared distance over the pieces of the axis between its knots, and the feature there.
/// The derivative does not decrease, so that the first piece where it reaches zero has it.
fn lowest(axis: &Axis, pieces: impl Iterator<Item = (f64, f64)>) -> (f64, Sides) {
    let mut before = axis.sides(-1.0);
    for (from, to) in pieces {
        let sides = axis.sides(0.5 * (from + to));
        let turn = axis.turn(sides).unwrap_or(from);
        if turn <= from {
            // At a knot both pieces' features are near.
            let either = |i| if before[i] == 0.0 { sides[i] } else { before[i] };
            return (from, if from > -1.0 { std::array::from_fn(either) } else { before });
        }
        if turn < to {
            return (turn, sides);
        }
        before = sides;
    }
    (1.0, axis.sides(1.0))
}

/// Of a first ball near an edge: whether the edge or its corner counts as the nearest feature. As recorded
/// the whole line of the axis decides: the corner, if that is where the limited edge is nearest to the line,
/// even where the ball, at an end of the axis, is nearer to the edge's middle. The distance stays the ball's
/// own.
fn to_corner(axis: &Axis, first: First) -> First {
    let First { t, sides, .. } = first;
    let (Some(along), 2) = (sides.iter().position(|side| *side == 0.0), count(sides)) else {
        return first;
    };
    let place = axis.at(axis.turn(sides).unwrap_or(t))[along];
    // At the very end the edges along the lower box axes come first.
    let slack = if along == 0 { axis.rounding() } else { -axis.rounding() };
    if place.abs() <= axis.size[along] + slack {
        return first;
    }
    First { square: first.square, ..corner_at(axis, t, sides, along, place) }
}

/// The first ball at an end of an edge.
fn corner_at(axis: &Axis, t: f64, edge: Sides, along: usize, side: f64) -> First {
    let mut sides = edge;
    sides[along] = 1f64.copysign(side);
    let p = axis.at(t);
    let apart: Vec3 = std::array::from_fn(|i| sides[i] * axis.size[i] - p[i]);
    First { t, sides, square: dot(apart, apart) }
}

/// The first ball of an axis parallel to a face and over it between its ends only: where it passes over an
/// edge of the face. As recorded, of the two such places the one whose edge lies along the lower box axis,
/// and then the one on the negative side.
fn along_face(axis: &Axis, face: Sides, level: [f64; 2], square: f64) -> First {
    let free = |i: &usize| face[*i] == 0.0;
    for along in (0..3).filter(free) {
        for across in (0..3).filter(free).filter(|&i| i != along) {
            for side in [-1.0, 1.0] {
                let t = axis.crossing(across, side);
                if level.contains(&t) {
                    let mut sides = face;
                    sides[across] = side;
                    return First { t, sides, square };
                }
            }
        }
    }
    First { t: level[0], sides: face, square }
}

/// The first ball of an axis parallel to an edge and next to it: as recorded, at a corner, the negative one
/// first, or else at the end of the axis that is nearest to a corner. Either counts as near that corner.
fn along_edge(axis: &Axis, edge: Sides, level: [f64; 2]) -> First {
    let along = edge.iter().position(|side| *side == 0.0).unwrap_or(0);
    for side in [-1.0, 1.0] {
        let crossing = axis.crossing(along, side);
        let t = clip(crossing, level);
        if ((t - crossing) * axis.half[along]).abs() <= axis.rounding() {
            return corner_at(axis, t, edge, along, side);
        }
    }
    let [p, q] = level.map(|t| axis.at(t)[along]);
    let side = if p + q > 0.0 { 1.0 } else { -1.0 };
    let t = if (p < q) == (side > 0.0) { level[1] } else { level[0] };
    corner_at(axis, t, edge, along, side)
}

/// The first ball of an axis that has points in the box. As recorded: at an end in the box; else where the
/// axis is nearest to something at its surface, that is, an end over a face, or the place nearest to an
/// edge.
fn pierced(axis: &Axis) -> First {
    for t in [-1.0, 1.0] {
        let sides = axis.sides(t);
        if count(sides) == 0 {
            return First { t, sides, square: 0.0 };
        }
    }
    let mut best = First { t: -1.0, sides: [0.0; 3], square: f64::INFINITY };
    let slack = MINVAL * (dot(axis.half, axis.half) + dot(axis.size, axis.size));
    let mut consider = |t, sides, square| {
        if square < best.square - slack {
            best = First { t, sides, square };
        }
    };
    for t in [-1.0, 1.0] {
        let sides = axis.sides(t);
        if count(sides) == 1 {
            consider(t, sides, axis.square(t));
        }
    }
    for along in 0..3 {
        for second in [-1.0, 1.0] {
            for first in [-1.0, 1.0] {
                let mut sides = [0.0; 3];
                let others = [0, 1, 2].into_iter().filter(|&i| i != along);
                others.zip([first, second]).for_each(|(i, side)| sides[i] = side);
                if let Some((t, place, square)) = nearest_to_edge(axis, along, sides) {
                    sides[along] = if place.abs() < 1.0 { 0.0 } else { place };
                    consider(t, sides, square);
                }
            }
        }
    }
    best
}

/// Where the axis is nearest to an edge of the box: its parameter, the place on the edge in [-1, 1], and the
/// squared distance. None if they are parallel.
fn nearest_to_edge(axis: &Axis, along: usize, edge: Sides) -> Option<(f64, f64, f64)> {
    let length = axis.size[along];
    let across: Vec3 = std::array::from_fn(|i| if i == along { 0.0 } else { axis.half[i] });
    if dot(across, across) <= PARALLEL * dot(axis.half, axis.half) {
        return None;
    }
    // Seen along the edge the distance depends on t alone; then the limits of both segments.
    let place = |t: f64| axis.at(t)[along] / length;
    let free = axis.turn(edge)?;
    let t = clip(free, [-1.0, 1.0]);
    let beyond = place(t);
    if beyond.abs() < 1.0 {
        return Some((t, beyond, square_to(axis, t, along, edge, beyond)));
    }
    // The squared distance is convex, so that its minimum lies at the end of the edge beyond which the
    // unlimited edge would have it.
    let end = 1f64.copysign(beyond);
    let mut corner = edge;
    corner[along] = end;
    let t = clip(axis.turn(corner)?, [-1.0, 1.0]);
    Some((t, end, square_to(axis, t, along, edge, end)))
}

/// Squared distance of a point of the axis from a point of an edge.
fn square_to(axis: &Axis, t: f64, along: usize, edge: Sides, place: f64) -> f64 {
    let mut foot = edge;
    foot[along] = place;
    let apart: Vec3 = std::array::from_fn(|i| axis.at(t)[i] - foot[i] * axis.size[i]);
    dot(apart, apart)
}

/// Where the second ball sits, if there is one: from the first one along the axis, as far as both shapes go.
/// The rules are recorded behaviour.
fn second_ball(axis: &Axis, first: &First) -> Option<f64> {
    let &First { t, sides, .. } = first;
    // Forward along the axis is inwards over the box: towards the opposite face.
    let inwards: [bool; 3] =
        std::array::from_fn(|i| sides[i] != 0.0 && (axis.half[i] > 0.0) != (sides[i] > 0.0));
    let (sense, limit) = match count(sides) {
        1 => from_face(axis, t, sides)?,
        2 => from_edge(axis, t, sides, inwards)?,
        3 => from_corner(axis, inwards)?,
        _ => return None,
    };
    // What is left of the axis. A limit that is NaN does not limit.
    let left = 1.0 - sense * t;
    Some(t + sense * left.min(limit))
}

/// From an end of the axis over a face, inwards along the axis until it leaves the rectangle of the face.
fn from_face(axis: &Axis, t: f64, face: Sides) -> Option<(f64, f64)> {
    if t.abs() != 1.0 {
        return None;
    }
    let mut limit = f64::INFINITY;
    for i in (0..3).filter(|&i| face[i] == 0.0) {
        for side in [-1.0, 1.0] {
            let way = (axis.crossing(i, side) - t) * -t;
            if way > 0.0 {
                limit = limit.min(way);
            }
        }
    }
    Some((-t, limit))
}

/// From an edge, in the sense that is inwards along the normal of one of its faces: the one along which the
/// axis runs more.
fn from_edge(axis: &Axis, t: f64, edge: Sides, inwards: [bool; 3]) -> Option<(f64, f64)> {
    let along = edge.iter().position(|side| *side == 0.0)?;
    let (j, k) = ((along + 1) % 3, (along + 2) % 3);
    // Inwards along both or neither, axis and edge cross like a T.
    if inwards[j] == inwards[k] {
        return None;
    }
    let lean = if axis.half[j].abs() > axis.half[k].abs() { j } else { k };
    let sense = if inwards[lean] { 1.0 } else { -1.0 };
    let (place, speed) = (axis.at(t)[along], sense * axis.half[along]);
    let left = if speed > 0.0 { axis.size[along] - place } else { axis.size[along] + place };
    Some((sense, width(axis, lean).min(left / speed.abs())))
}

/// From a corner, in the sense that is inwards along one box axis if the capsule lies along that one, else
/// in the opposite sense, which is inwards along the other two.
fn from_corner(axis: &Axis, inwards: [bool; 3]) -> Option<(f64, f64)> {
    let sense = match inwards.iter().filter(|inwards| **inwards).count() {
        1 => 1.0,
        2 => -1.0,
        _ => return None,
    };
    let single = inwards.iter().position(|inwards| *inwards == (sense > 0.0))?;
    let (j, k) = ((single + 1) % 3, (single + 2) % 3);
    if axis.half[single].powi(2) > 0.5 * dot(axis.half, axis.half) {
        Some((sense, width(axis, single)))
    } else {
        Some((-sense, width(axis, j).min(width(axis, k))))
    }
}

/// How far along the axis the box is wide.
fn width(axis: &Axis, i: usize) -> f64 {
    2.0 * axis.size[i] / axis.half[i].abs()
}

#[cfg(test)]
mod tests;
