//! Distance and penetration of two convex bodies: GJK, and EPA where they overlap.

use super::epa::{self, Deepest, Scratch, Shallow};
use super::gjk::{Gjk, Limits, Vertex, gjk};
use super::support::Body;
use crate::math::*;

pub(crate) use super::epa::Scratch as Room;
pub(crate) use super::gjk::Limits as Effort;
pub(crate) use super::support::Body as Convex;

/// Distance and nearest points of two bodies.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Nearest {
    /// Signed distance, m; [`f64::MAX`] beyond the cutoff.
    pub(crate) dist: f64,
    /// A point of each body; when they overlap, the deepest of each in the other. `None` when these are not known.
    pub(crate) witness: Option<[Vec3; 2]>,
    /// The support points that the depth was found between.
    support: Option<[Vertex; 3]>,
}

/// The deepest place of two bodies that overlap.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Deep {
    /// Signed distance, below zero, m.
    pub(crate) dist: f64,
    /// The deepest point of each body in the other.
    pub(crate) witness: [Vec3; 2],
    /// The support points that it was found between.
    pub(super) support: [Vertex; 3],
}

/// Where two bodies overlap most, when they do.
pub(crate) fn deepest(a: &mut Body, b: &mut Body, limits: Limits, room: &mut Scratch) -> Option<Deep> {
    let found = nearest(a, b, 0.0, limits, room);
    let (witness, support) = (found.witness?, found.support?);
    (found.dist < 0.0).then_some(Deep { dist: found.dist, witness, support })
}

impl Nearest {
    fn at(dist: f64, witness: Option<[Vec3; 2]>) -> Nearest {
        Nearest { dist, witness, support: None }
    }
}

/// Signed distance up to `cutoff`; with a cutoff of zero, only the depth of bodies that overlap.
///
/// A sphere is a point, a capsule a segment, with a radius around: as long as these do not overlap, the distance
/// is theirs less the radii.
pub(crate) fn nearest(
    a: &mut Body,
    b: &mut Body,
    cutoff: f64,
    limits: Limits,
    room: &mut Scratch,
) -> Nearest {
    let price = 60 + a.price() + b.price();
    if a.round() || b.round() {
        let radii = [a.radius(), b.radius()];
        (a.core, b.core) = (a.round(), b.round());
        let cores = gjk(a, b, cutoff + radii[0] + radii[1], limits);
        (a.core, b.core) = (false, false);
        room.cost += (1 + cores.steps as u64) * price;
        if cores.dist > limits.tolerance {
            return thicken(&cores, radii, cutoff);
        }
    }
    let mut found = gjk(a, b, cutoff, limits);
    room.cost += (1 + found.steps as u64) * price;
    if found.dist > limits.tolerance || found.size < 2 {
        return Nearest::at(found.dist, found.witness);
    }
    if cutoff > 0.0 && found.dist > MINVAL {
        // Nearer than distances are known: whether they overlap is another question, with a sharper answer.
        let overlap = gjk(a, b, 0.0, limits);
        room.cost += (1 + overlap.steps as u64) * price;
        if overlap.dist > limits.tolerance {
            return Nearest::at(found.dist, found.witness);
        }
        found = overlap;
    }
    match epa::epa(&found, a, b, limits, room) {
        Ok(Deepest { depth, witness, support }) => {
            Nearest { dist: -depth, witness: Some(witness), support: Some(support) }
        }
        Err(Shallow::Border) => Nearest::at(0.0, found.witness),
        Err(Shallow::Lost) => Nearest::at(0.0, None),
    }
}

/// The distance of bodies from that of their cores.
fn thicken(cores: &Gjk, radii: [f64; 2], cutoff: f64) -> Nearest {
    let Some([on_a, on_b]) = cores.witness else { return Nearest::at(f64::MAX, None) };
    let (dir, _) = normalize(sub(on_b, on_a));
    let witness = [add_scaled(on_a, dir, radii[0]), add_scaled(on_b, dir, -radii[1])];
    let dist = cores.dist - (radii[0] + radii[1]);
    Nearest::at(if dist > cutoff { f64::MAX } else { dist }, Some(witness))
}
