//! Passes over a planar chain: positions of the links, and the articulated-body algorithm (see `planar_chain`).

use crate::math::*;

pub(super) type Vec2 = [f64; 2];

/// A link: the bodies that move with one hinge.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct PlanarLink {
    /// Vectors from the previous anchor to the anchor, and from the anchor to the centre of mass, in the default
    /// configuration.
    pub(super) offset: Vec2,
    pub(super) com: Vec2,
    /// Sign of the hinge axis relative to the normal of the plane.
    pub(super) sense: f64,
    pub(super) mass: f64,
    /// Moment of inertia about the anchor.
    pub(super) inertia: f64,
    pub(super) armature: f64,
    pub(super) reference: f64,
    /// Index of its coordinate in `qpos`.
    pub(super) coordinate: usize,
    /// Current values of `offset`, rotated by a further 90°, and of `com`.
    pub(super) quarter: Vec2,
    pub(super) arm: Vec2,
    /// Current position of the anchor.
    pub(super) anchor: Vec2,
    /// Moment of inertia and first moment about the anchor of this link and all links beyond it, if M is read.
    pub(super) beyond: (f64, Vec2),
    /// Torque about the anchor and force that the motion of the link needs with zero joint accelerations: torque, x,
    /// y.
    pub(super) force: [f64; 3],
}

/// U and 1/D, the addition of the joint to the diagonal of the matrix, and an element of the vector that is solved
/// for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct PlanarJoint {
    pub(super) u: [f64; 3],
    /// The torque of U about the previous anchor.
    pub(super) torque: f64,
    pub(super) inv: f64,
    pub(super) diagonal: f64,
    pub(super) x: f64,
}

impl PlanarJoint {
    /// U about the previous anchor.
    #[cfg_attr(not(feature = "small"), inline(always))]
    fn above(&self) -> [f64; 3] {
        [self.torque, self.u[1], self.u[2]]
    }
}

/// Articulated inertia about an anchor (J, h and M of `planar_chain`), and a force, with its torque about the anchor
/// first.
#[derive(Clone, Copy, Debug, Default)]
struct PlanarBody {
    moment: f64,
    first: Vec2,
    mass: [f64; 3],
    force: [f64; 3],
}

/// Computes the current positions and orientations of the links.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(super) fn forward_kinematics(links: &mut [PlanarLink], qpos: &[f64]) {
    let (mut angle, mut cos, mut sin) = (0.0, 1.0, 0.0);
    let mut anchor = [0.0; 2];
    for link in links {
        let offset = rotated(link.offset, sin, cos);
        anchor = add(anchor, offset);
        angle += link.sense * (qpos.get(link.coordinate).copied().unwrap_or(0.0) - link.reference);
        (sin, cos) = libm::sincos(angle);
        link.arm = rotated(link.com, sin, cos);
        link.quarter = [-offset[1], offset[0]];
        link.anchor = anchor;
    }
}

/// A vector rotated by an angle with this sine and cosine.
#[cfg_attr(not(feature = "small"), inline(always))]
fn rotated([x, y]: Vec2, sin: f64, cos: f64) -> Vec2 {
    [cos * x - sin * y, sin * x + cos * y]
}

/// The inward pass, for the matrices `A..B` at the same time: computes U and D of every hinge. Returns the first one
/// whose D is not positive. With `X`, the pass includes the vector that is solved for.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(super) fn inward<const A: usize, const B: usize, const X: bool>(
    links: &[PlanarLink],
    joints: &mut [[PlanarJoint; 2]],
) -> Option<usize> {
    let mut bad = None;
    let mut bodies = [PlanarBody::default(); 2];
    for (k, (link, joint)) in links.iter().zip(joints).enumerate().rev() {
        let q = link.quarter;
        for i in A..B {
            let (body, joint) = (&mut bodies[i], &mut joint[i]);
            let moment = body.moment + link.inertia;
            let h = add_scaled(body.first, [-link.arm[1], link.arm[0]], link.mass);
            let [xx, xy, yy] = body.mass;
            let (xx, yy) = (xx + link.mass, yy + link.mass);
            let (across, moved) = (dot(q, h), [xx * q[0] + xy * q[1], xy * q[0] + yy * q[1]]);
            let d = moment + joint.diagonal;
            if d < MINVAL {
                bad = Some(k);
            }
            let inv = 1.0 / d.max(MINVAL);
            joint.inv = inv;
            joint.u = [link.sense * moment, link.sense * h[0], link.sense * h[1]];
            joint.torque = link.sense * (moment + across);
            // I - U Uᵀ / D: J and h are multiplied by the fraction of D that is the inertia of the joint. Products that
            // do not need 1/D are computed while it is divided.
            let (part, ratio, share) = (scale(h, inv), joint.diagonal * inv, across * inv);
            body.mass = [xx - h[0] * part[0], xy - h[0] * part[1], yy - h[1] * part[1]];
            body.first = add(scale(h, ratio), add_scaled(moved, h, -share));
            body.moment = ratio * (moment + 2.0 * across) + (dot(q, moved) - across * share);
            if X {
                pass_on(link, joint, &mut body.force);
            }
        }
    }
    bad
}

/// Subtracts what a hinge takes up of the force of all links beyond it, and transforms the rest to the previous
/// anchor.
#[cfg_attr(not(feature = "small"), inline(always))]
fn pass_on(link: &PlanarLink, joint: &mut PlanarJoint, force: &mut [f64; 3]) {
    let [torque, x, y] = *force;
    joint.x = joint.x * joint.inv - (link.sense * joint.inv) * torque;
    let moved = torque + (link.quarter[0] * x + link.quarter[1] * y);
    *force = add_scaled([moved, x, y], joint.above(), joint.x);
}

/// The outward pass, from the world to the end of the chain.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(super) fn outward<const A: usize, const B: usize>(links: &[PlanarLink], joints: &mut [[PlanarJoint; 2]]) {
    let mut all = [[0.0; 3]; 2];
    for (link, joint) in links.iter().zip(joints) {
        for i in A..B {
            let (joint, [turn, x, y]) = (&mut joint[i], &mut all[i]);
            *x += *turn * link.quarter[0];
            *y += *turn * link.quarter[1];
            joint.x -= joint.inv * (joint.u[0] * *turn + (joint.u[1] * *x + joint.u[2] * *y));
            *turn += link.sense * joint.x;
        }
    }
}

/// Both passes for a vector if U and D are known.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(super) fn solve_known(links: &[PlanarLink], joints: &mut [[PlanarJoint; 2]]) {
    let mut force = [0.0; 3];
    for (link, joint) in links.iter().zip(joints.iter_mut()).rev() {
        pass_on(link, &mut joint[0], &mut force);
    }
    outward::<0, 1>(links, joints);
}
