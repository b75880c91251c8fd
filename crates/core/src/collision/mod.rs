//! Collision detection: which geoms touch, where, and with which contact parameters.

mod filter;
mod params;
mod primitive;

use filter::Pair;
pub use filter::can_collide;
pub(crate) use filter::candidate_pairs;
use params::Params;

use crate::math::*;
use crate::{Contact, Data, Model, geom};

/// What a pair function knows of one touching point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Touch {
    /// Distance of the surfaces, negative when they overlap, m.
    pub(crate) dist: f64,
    /// Midpoint between the surfaces, m, world.
    pub(crate) pos: Vec3,
    /// Unit normal from geom 1 to geom 2, world.
    pub(crate) normal: Vec3,
}

/// The pairs that a plan tests, with their contact parameters when nothing can change these.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Pairs {
    pairs: Vec<Pair>,
    params: Vec<Params>,
    /// Filters are asked at every step, because what they look at may be written.
    filter: bool,
}

/// Most pairs whose parameters are kept: beyond, memory costs more than mixing them again.
const MAX_KEPT: usize = 4096;

/// Finds the pairs that may touch: all that can ever, when contact bits and flags may be written later,
/// otherwise those that they admit now.
pub(crate) fn pairs(m: &Model, pairs_may_change: bool, params_may_change: bool) -> Pairs {
    let pairs = candidate_pairs(m, pairs_may_change);
    let keep = !params_may_change && pairs.len() <= MAX_KEPT;
    let mix = |p: &Pair| params::params(m, p.geom1 as usize, p.geom2 as usize);
    let params = if keep { pairs.iter().map(mix).collect() } else { Vec::new() };
    Pairs { pairs, params, filter: pairs_may_change }
}

/// `contact`, `ncon`: tests the pairs of the plan in their order.
#[inline(never)]
pub(crate) fn collide(m: &Model, d: &mut Data) {
    d.contact.clear();
    let list = std::mem::take(&mut d.work.pairs);
    for (i, pair) in list.pairs.iter().enumerate() {
        let (g1, g2) = (pair.geom1 as usize, pair.geom2 as usize);
        if list.filter && !filter::admitted(m, g1, g2) {
            continue;
        }
        match list.params.get(i) {
            Some(params) => narrow(m, d, g1, g2, params),
            None => narrow(m, d, g1, g2, &params::params(m, g1, g2)),
        }
    }
    d.work.pairs = list;
    d.ncon = d.contact.len();
}

/// No contacts: they are switched off.
pub(crate) fn none(d: &mut Data) {
    d.contact.clear();
    d.ncon = 0;
}

/// The exact test of one pair.
#[inline]
fn narrow(m: &Model, d: &mut Data, g1: usize, g2: usize, params: &Params) {
    let touch = match (m.geom_type[g1], m.geom_type[g2]) {
        (geom::PLANE, geom::SPHERE) => primitive::plane_sphere(m, d, g1, g2, params.reach),
        (geom::SPHERE, geom::SPHERE) => primitive::sphere_sphere(m, d, g1, g2, params.reach),
        _ => None,
    };
    if let Some(t) = touch {
        d.contact.push(params::contact(params, g1, g2, t));
    }
}

/// Normal and two tangents as rows. The tangents start from the world's y axis, or z when the normal is
/// near y.
pub(crate) fn frame(normal: Vec3) -> Mat3 {
    let seed = if normal[1] < 0.5 && normal[1] > -0.5 { [0.0, 1.0, 0.0] } else { [0.0, 0.0, 1.0] };
    let (t1, _) = normalize(add_scaled(seed, normal, -dot(seed, normal)));
    let t2 = cross(normal, t1);
    [normal[0], normal[1], normal[2], t1[0], t1[1], t1[2], t2[0], t2[1], t2[2]]
}

/// Normal and two tangents as rows, the first tangent along a given direction unless that is short.
pub(crate) fn frame_along(normal: Vec3, tangent: Vec3) -> Mat3 {
    if norm(tangent) < 0.5 {
        return frame(normal);
    }
    let (t1, _) = normalize(add_scaled(tangent, normal, -dot(tangent, normal)));
    let t2 = cross(normal, t1);
    [normal[0], normal[1], normal[2], t1[0], t1[1], t1[2], t2[0], t2[1], t2[2]]
}

/// Force and torque of a contact in the contact's frame: normal, two tangents, then three torques
/// (`mj_contactForce`), N and N m. Zero when the contact has no constraint.
pub fn contact_force(m: &Model, d: &Data, contact: &Contact) -> [f64; 6] {
    let mut out = [0.0; 6];
    let Some(row) = contact.efc_address else { return out };
    if contact.dim == 1 {
        out[0] = d.efc_force[row];
        return out;
    }
    debug_assert_eq!(m.opt.cone, 0);
    // Pyramid: each edge pushes along n ± μ t.
    for k in 0..contact.dim - 1 {
        let (plus, minus) = (d.efc_force[row + 2 * k], d.efc_force[row + 2 * k + 1]);
        out[0] += plus + minus;
        out[1 + k] = (plus - minus) * contact.friction[k];
    }
    out
}
