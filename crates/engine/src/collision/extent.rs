//! The regions where the geoms of a model can be in any state, to find pairs that can never reach each other.
//!
//! A body that is connected to the world by hinge and ball joints stays within a sphere about the first of these
//! joints: the distances from joint to joint, and from the last joint to the geom, add up. A slide joint allows its
//! descendants any position along its axis; joint limits are soft and do not bound the position. The descendants of a
//! free joint and mocap bodies can be anywhere.
//!
//! The proof uses bounding spheres. Contacts are only searched within bounding spheres, so a full run finds no
//! contact of such a pair either.

use super::filter::Pair;
use crate::dynamics::kinematics::sameframe;
use crate::kinds::{geom, joint};
use crate::math::*;
use crate::model::Model;
use crate::model::index::element_range;
use crate::model::reflect::{FieldId, model as fields_of};

/// The fields that the proof depends on, besides contact parameters.
pub(crate) const FIELDS: [FieldId; 8] = [
    fields_of::body_pos,
    fields_of::body_quat,
    fields_of::body_ipos,
    fields_of::body_iquat,
    fields_of::jnt_pos,
    fields_of::jnt_axis,
    fields_of::geom_pos,
    fields_of::geom_quat,
];

/// Safety margin for rounding errors, as a fraction of all lengths involved.
const ROUNDING: f64 = 1e-9;

/// The region where a point of a body can be.
#[derive(Clone, Copy, Debug)]
struct Extent {
    /// The point is within `radius` of `centre`, m, except along the world axes in `free`, along which it can be
    /// anywhere.
    centre: Vec3,
    radius: f64,
    free: [bool; 3],
    /// The point, in the frame of the body, m.
    point: Vec3,
    /// The orientation of the body if it is constant.
    turned: Option<Quat>,
}

impl Extent {
    const WORLD: Extent = Extent {
        centre: [0.0; 3],
        radius: 0.0,
        free: [false; 3],
        point: [0.0; 3],
        turned: Some([1.0, 0.0, 0.0, 0.0]),
    };

    /// The region of another point of the same body.
    fn at(self, point: Vec3) -> Extent {
        let by = sub(point, self.point);
        match self.turned {
            Some(turned) => Extent { centre: add(self.centre, rotate(by, turned)), point, ..self },
            None => Extent { radius: self.radius + norm(by), point, ..self },
        }
    }

    /// The region after joint `j` of the body has moved it.
    fn after_joint(self, m: &Model, j: usize) -> Extent {
        let axis = rows::<3>(&m.jnt_axis)[j];
        match (m.jnt_type[j], self.turned) {
            (joint::HINGE | joint::BALL, _) => Extent { turned: None, ..self.at(rows::<3>(&m.jnt_pos)[j]) },
            (joint::SLIDE, Some(turned)) => {
                let along = rotate(axis, turned).map(|x| x != 0.0);
                // If the slide is along a world axis, the other coordinates are constant, bit for bit.
                let one = along.iter().filter(|&&x| x).count() == 1;
                let free = [0, 1, 2].map(|k| self.free[k] || along[k] || !one);
                Extent { free, ..self }
            }
            _ => Extent { free: [true; 3], turned: None, ..self },
        }
    }
}

/// The region of each geom.
pub(super) struct Extents {
    geoms: Vec<Extent>,
}

impl Extents {
    pub(super) fn new(m: &Model) -> Extents {
        let mut bodies: Vec<Extent> = Vec::with_capacity(m.nbody);
        for b in 0..m.nbody {
            // Parents precede their children.
            let parent = bodies.get(m.body_parentid[b] as usize).copied().filter(|_| b > 0);
            let from = parent.unwrap_or(Extent::WORLD).at(rows::<3>(&m.body_pos)[b]);
            let quat = quat_normalize(rows::<4>(&m.body_quat)[b]);
            let turned = from.turned.map(|turned| if b > 0 { quat_mul(turned, quat) } else { turned });
            let mut here = Extent { point: [0.0; 3], turned, ..from };
            for j in element_range(m.body_jntadr[b], m.body_jntnum[b]) {
                here = here.after_joint(m, j);
            }
            if m.body_mocapid[b] >= 0 {
                here = Extent { free: [true; 3], turned: None, ..here };
            }
            bodies.push(here);
        }
        let geom = |g: usize| {
            let body = bodies.get(m.geom_bodyid[g] as usize).copied().unwrap_or(Extent::WORLD);
            let (pos, quat) = attached(m, g);
            let (here, rotation) = (body.at(pos), quat_normalize(quat));
            Extent { turned: here.turned.map(|turned| quat_mul(turned, rotation)), ..here }
        };
        Extents { geoms: (0..m.ngeom).map(geom).collect() }
    }

    /// Whether the two geoms can never come within the distance `reach` (m) of each other.
    pub(super) fn never_within(&self, m: &Model, pair: &Pair, reach: f64) -> bool {
        let [g1, g2] = [pair.geom1 as usize, pair.geom2 as usize];
        let (Some(a), Some(b)) = (self.geoms.get(g1), self.geoms.get(g2)) else { return false };
        let [ra, rb] = [m.geom_rbound[g1], m.geom_rbound[g2]];
        let between = sub(b.centre, a.centre);
        let spread = a.radius + b.radius;
        let (distance, least) = match (ra > 0.0, rb > 0.0) {
            (true, true) => {
                let fixed = [0, 1, 2].map(|k| if a.free[k] || b.free[k] { 0.0 } else { between[k] });
                (norm(fixed) - spread, ra + rb + reach)
            }
            (false, true) if m.geom_type[g1] == geom::PLANE => (above(a, b, between) - spread, rb + reach),
            (true, false) if m.geom_type[g2] == geom::PLANE => {
                (above(b, a, between.map(|x| -x)) - spread, ra + reach)
            }
            _ => return false,
        };
        let lengths = norm(a.centre) + norm(b.centre) + spread + ra + rb + reach.abs();
        distance > least + ROUNDING * (1.0 + lengths)
    }
}

/// The pose of a geom in the frame of its body, from which its world pose is computed (`dynamics::kinematics`). Where
/// it coincides with a frame of the body (`geom_sameframe`), `geom_pos` and `geom_quat` have no effect until
/// `mj_setConst` compares them again.
fn attached(m: &Model, g: usize) -> (Vec3, Quat) {
    const IDENTITY: Quat = [1.0, 0.0, 0.0, 0.0];
    let b = m.geom_bodyid[g] as usize;
    let inertial_pos = match m.body_sameframe[b] {
        sameframe::BODY => [0.0; 3],
        _ => rows::<3>(&m.body_ipos)[b],
    };
    let inertial_quat = match m.body_sameframe[b] {
        sameframe::BODY | sameframe::BODYROT => IDENTITY,
        _ => rows::<4>(&m.body_iquat)[b],
    };
    let pos = match m.geom_sameframe[g] {
        sameframe::BODY => [0.0; 3],
        sameframe::INERTIA => inertial_pos,
        _ => rows::<3>(&m.geom_pos)[g],
    };
    let quat = match m.geom_sameframe[g] {
        sameframe::BODY | sameframe::BODYROT => IDENTITY,
        sameframe::INERTIA | sameframe::INERTIAROT => inertial_quat,
        _ => rows::<4>(&m.geom_quat)[g],
    };
    (pos, quat)
}

/// The height of the centre of a geom's region above a fixed plane, m; minus infinity if the plane can move or the
/// height is unbounded.
fn above(plane: &Extent, other: &Extent, between: Vec3) -> f64 {
    let Some(turned) = plane.turned.filter(|_| plane.radius == 0.0 && plane.free == [false; 3]) else {
        return f64::NEG_INFINITY;
    };
    let normal = rotate([0.0, 0.0, 1.0], turned);
    let leaves = (0..3).any(|k| other.free[k] && normal[k] != 0.0);
    if leaves { f64::NEG_INFINITY } else { dot(normal, between) }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)] // a failing test prints the reason
mod tests {
    use super::super::candidates::{Changes, candidate_pairs};
    use crate::tests::compile;

    fn left(world: &str) -> usize {
        let m = compile(&format!("<mujoco><worldbody>{world}</worldbody></mujoco>")).unwrap();
        candidate_pairs(&m, Changes::default()).len()
    }

    /// A pendulum of 1 m with a bob of 0.1 m above a floor, a cart on rails, and two pendulums next to each other.
    #[test]
    fn pairs_out_of_reach_are_excluded() {
        let floor = "<geom type='plane' size='1 1 1'/>";
        let pendulum = |x: f64, z: f64, joint: &str| {
            format!("<body pos='{x} 0 {z}'>{joint}<geom size='.1' pos='0 0 -1'/></body>")
        };
        let (hinge, ball) = ("<joint axis='0 1 0'/>", "<joint type='ball'/>");
        let slide = "<joint type='slide' axis='1 0 0'/><joint axis='0 1 0'/>";
        for (z, pairs) in [(1.2, 0), (1.09, 1)] {
            for joint in [hinge, ball, slide] {
                assert_eq!(left(&format!("{floor}{}", pendulum(0.0, z, joint))), pairs, "{joint} at {z}");
            }
        }
        for free in [
            "<freejoint/>",
            "<joint type='slide' axis='1 0 1'/>",
            "<joint axis='0 1 0'/><joint type='slide' axis='1 0 0'/>",
        ] {
            assert_eq!(left(&format!("{floor}{}", pendulum(0.0, 9.0, free))), 1, "{free}");
        }
        // A joint anchor off the origin of the body, and a chain of two links.
        let moved = "<joint axis='0 1 0' pos='0 0 -1'/>";
        assert_eq!(left(&format!("{floor}{}", pendulum(0.0, 1.2, moved))), 0);
        let two = "<body pos='0 0 2.2'><joint axis='0 1 0'/><geom size='.1' pos='0 0 -1'/>\
            <body pos='0 0 -1'><joint axis='0 1 0'/><geom size='.1' pos='0 0 -1'/></body></body>";
        assert_eq!(left(&format!("{floor}{two}")), 0);
        assert_eq!(left(&format!("{floor}{}", two.replace("2.2", "1.9"))), 1);
        // Pendulums next to each other stay within spheres about their pivots.
        let beside = |x: f64| left(&(pendulum(0.0, 2.0, hinge) + &pendulum(x, 2.0, hinge)));
        assert_eq!((beside(2.3), beside(2.1)), (0, 1));
        // Margins and mocap bodies are taken into account.
        let wide = pendulum(0.0, 1.2, hinge).replace("size='.1'", "size='.1' margin='.2'");
        assert_eq!(left(&format!("{floor}{wide}")), 1);
        let hand = "<body mocap='true' pos='9 9 9'><geom size='.1'/></body>";
        assert_eq!(left(&(pendulum(0.0, 2.0, hinge) + hand)), 1);
    }
}
