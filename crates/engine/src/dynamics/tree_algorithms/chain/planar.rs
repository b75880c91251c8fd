//! Short chains in a plane: all hinge axes are parallel, and all slides are perpendicular to them.
//!
//! Angular velocities are scalars. With zero joint accelerations, all angular accelerations are zero, and the
//! gyroscopic torque has no component along the normal of the plane.

use super::{ChainLink, MAX_DOFS, length};
use crate::math::broken_invariant;
use crate::math::{EYE, Mat3, Vec3, column, cross, dot, mat_mul, mat_mul_vec, normalize, scale};

type Vec2 = [f64; 2];

/// Parameters of a link from the model, in the axes of the plane, in the default configuration.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct PlanarLinkParameters {
    /// Vector from the anchor of the previous link to its anchor.
    offset: Vec2,
    /// Direction of a slide.
    axis: Vec2,
    /// Sign of a hinge axis relative to the normal of the plane; 0 for a slide.
    sense: f64,
    com: Vec2,
    /// Moment of inertia about an axis through the centre of mass along the normal.
    inertia: f64,
    /// The axes of the plane, world frame.
    plane: [Vec3; 2],
}

/// Current position and orientation of a link.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Swing {
    anchor: Vec2,
    com: Vec2,
    axis: Vec2,
    cos: f64,
    sin: f64,
}

/// Largest deviation, as a cosine, of a direction that counts as in the plane or along its normal.
const FLAT: f64 = 1e-12;

/// Determines whether a chain is planar, and its parameters.
pub(super) fn load(chain: &mut [ChainLink]) {
    let mut all = [(EYE, [0.0; 3]); MAX_DOFS];
    // Longer chains are those of `planar_chain`, which has separate parameters.
    let Some(axes) = all.get_mut(..chain.len()) else { return };
    let mut above = EYE;
    for (link, (turn, axis)) in chain.iter().zip(axes.iter_mut()) {
        *turn = mat_mul(&above, &link.fixed.turn);
        *axis = mat_mul_vec(turn, link.fixed.axis);
        above = *turn;
    }
    let axes = &*axes;
    let hinge = chain.iter().zip(axes).find(|(link, _)| !link.slides);
    // Two slides define the plane. A single slide moves in any plane that contains it.
    let normal = match (hinge, axes) {
        (Some((_, &(_, axis))), _) => axis,
        (None, [(_, a), (_, b), ..]) => normalize(cross(*a, *b)).0,
        (None, [(_, a), ..]) => normalize(cross(*a, most_perpendicular_axis(*a))).0,
        (None, []) => return,
    };
    let plane = plane_of(normal);
    let flat = |v: Vec3| [dot(plane[0], v), dot(plane[1], v)];
    let fits = |(link, (_, axis)): (&ChainLink, &(Mat3, Vec3))| {
        let along = dot(*axis, normal).abs();
        if link.slides { along < FLAT } else { (along - 1.0).abs() < FLAT }
    };
    let planar = chain.iter().zip(axes).all(fits);
    let mut above = EYE;
    for (link, (turn, axis)) in chain.iter_mut().zip(axes) {
        let [xx, yy, zz, xy, xz, yz] = link.fixed.inertia;
        let n = [dot(normal, column(turn, 0)), dot(normal, column(turn, 1)), dot(normal, column(turn, 2))];
        link.planar = planar;
        link.flat = PlanarLinkParameters {
            offset: flat(mat_mul_vec(&above, link.fixed.position)),
            axis: flat(*axis),
            sense: if link.slides { 0.0 } else { dot(*axis, normal).round() },
            com: flat(mat_mul_vec(turn, link.fixed.com)),
            inertia: dot(
                n,
                [
                    xx * n[0] + xy * n[1] + xz * n[2],
                    xy * n[0] + yy * n[1] + yz * n[2],
                    xz * n[0] + yz * n[1] + zz * n[2],
                ],
            ),
            plane,
        };
        above = *turn;
    }
}

/// The axes of the plane with a given normal.
pub(crate) fn plane_of(normal: Vec3) -> [Vec3; 2] {
    let first = normalize(cross(normal, most_perpendicular_axis(normal))).0;
    [first, cross(normal, first)]
}

/// The coordinate axis that forms the largest angle with v.
fn most_perpendicular_axis(v: Vec3) -> Vec3 {
    let [x, y, z] = v.map(f64::abs);
    if x <= y && x <= z {
        [1.0, 0.0, 0.0]
    } else if y <= z {
        [0.0, 1.0, 0.0]
    } else {
        [0.0, 0.0, 1.0]
    }
}

/// v rotated by 90°.
#[cfg_attr(not(feature = "small"), inline(always))]
fn quarter(v: Vec2) -> Vec2 {
    [-v[1], v[0]]
}

impl Swing {
    /// v rotated like the link.
    #[cfg_attr(not(feature = "small"), inline(always))]
    fn rotated(&self, v: Vec2) -> Vec2 {
        [self.cos * v[0] - self.sin * v[1], self.sin * v[0] + self.cos * v[1]]
    }
}

/// Computes the rows of M of a chain.
pub(super) fn mass_matrix<const N: usize>(chain: &mut [ChainLink], qpos: &[f64], mass: &mut [f64]) {
    let n = length::<N>(chain);
    let Some(chain) = chain.get_mut(..n) else {
        return broken_invariant("a chain is as long as its length");
    };
    let mut rows = [[0.0; MAX_DOFS]; MAX_DOFS];
    let mut up = Swing { cos: 1.0, ..Swing::default() };
    let mut angle = 0.0;
    let mut swings = [up; MAX_DOFS];
    for i in 0..n {
        let ChainLink { flat, fixed, swing, coordinate, .. } = &mut chain[i];
        let displacement = qpos[*coordinate] - fixed.reference;
        let offset = if i == 0 { flat.offset } else { up.rotated(flat.offset) };
        let mut here = Swing { anchor: [up.anchor[0] + offset[0], up.anchor[1] + offset[1]], ..up };
        if flat.sense == 0.0 {
            here.axis = if i == 0 { flat.axis } else { up.rotated(flat.axis) };
            here.anchor[0] += here.axis[0] * displacement;
            here.anchor[1] += here.axis[1] * displacement;
        } else {
            angle += flat.sense * displacement;
            (here.sin, here.cos) = libm::sincos(angle);
        }
        let com = here.rotated(flat.com);
        here.com = [here.anchor[0] + com[0], here.anchor[1] + com[1]];
        (*swing, swings[i], up) = (here, here, here);
        rows[i][i] = fixed.armature;
    }
    for i in 0..n {
        if chain[i].fixed.massless {
            continue;
        }
        let (mass, inertia, com) = (chain[i].fixed.mass, chain[i].flat.inertia, swings[i].com);
        let columns: [Vec2; MAX_DOFS] =
            std::array::from_fn(
                |k| if k <= i { shift(chain[k].flat.sense, &swings[k], com) } else { [0.0; 2] },
            );
        for k in 0..=i {
            let (turn, push) = (chain[k].flat.sense * inertia, [mass * columns[k][0], mass * columns[k][1]]);
            for j in 0..=k {
                rows[k][j] += chain[j].flat.sense * turn + columns[j][0] * push[0] + columns[j][1] * push[1];
            }
        }
    }
    for i in 0..n {
        if let Some(to) = mass.get_mut(chain[i].row..chain[i].row + i + 1) {
            to.copy_from_slice(&rows[i][..i + 1]);
        }
    }
}

/// Velocity of a point that the joint moves, for a unit velocity of the joint.
#[cfg_attr(not(feature = "small"), inline(always))]
fn shift(sense: f64, joint: &Swing, point: Vec2) -> Vec2 {
    if sense == 0.0 {
        return joint.axis;
    }
    let arm = quarter([point[0] - joint.anchor[0], point[1] - joint.anchor[1]]);
    [sense * arm[0], sense * arm[1]]
}

/// Computes the bias force of a chain.
pub(super) fn bias<const N: usize>(
    chain: &mut [ChainLink],
    qvel: &[f64],
    qfrc_bias: &mut [f64],
    gravity: Vec3,
) {
    let n = length::<N>(chain);
    let Some(chain) = chain.get_mut(..n) else {
        return broken_invariant("a chain is as long as its length");
    };
    let (first, plane) = (chain[0].dof, chain[0].flat.plane);
    let (Some(v), Some(out)) = (qvel.get(first..first + n), qfrc_bias.get_mut(first..first + n)) else {
        return broken_invariant("every link of a chain has a degree of freedom");
    };
    // Gravity is included as an upward acceleration of the world.
    let up = scale(gravity, -1.0);
    let mut acceleration = [dot(plane[0], up), dot(plane[1], up)];
    let mut turning = 0.0;
    let mut forces = [0.0; MAX_DOFS];
    for i in 0..n {
        let ChainLink { flat, fixed, swing, .. } = &chain[i];
        if i > 0 {
            let above = chain[i - 1].swing.anchor;
            let centripetal = turning * turning;
            acceleration[0] -= centripetal * (swing.anchor[0] - above[0]);
            acceleration[1] -= centripetal * (swing.anchor[1] - above[1]);
            if flat.sense == 0.0 {
                let (drag, side) = (2.0 * turning * v[i], quarter(swing.axis));
                acceleration[0] += drag * side[0];
                acceleration[1] += drag * side[1];
            }
        }
        turning += flat.sense * v[i];
        if fixed.massless {
            continue;
        }
        let centripetal = turning * turning;
        let force = [
            fixed.mass * (acceleration[0] - centripetal * (swing.com[0] - swing.anchor[0])),
            fixed.mass * (acceleration[1] - centripetal * (swing.com[1] - swing.anchor[1])),
        ];
        for k in 0..=i {
            let column = shift(chain[k].flat.sense, &chain[k].swing, swing.com);
            forces[k] += column[0] * force[0] + column[1] * force[1];
        }
    }
    out.copy_from_slice(&forces[..n]);
}
