//! Optimality conditions of the constraint problem, for every solver: forces are inside their cones and bounds, they are the
//! derivatives of the costs at the acceleration, and the equations of motion are satisfied.

use labspec_core::xml::compile;
use labspec_core::{self as core, Contact, Data, Model, solver};
use proptest::prelude::*;
use std::fmt::Write;

/// Types of rows (mjtConstraint).
const EQUALITY: i32 = 0;
const FRICTION: [i32; 2] = [1, 2];
const ELLIPTIC: i32 = 7;

/// A ball that penetrates the floor and its neighbour.
#[derive(Clone, Copy, Debug)]
struct Ball {
    depth: f64,
    condim: usize,
    friction: [f64; 3],
    mass: f64,
}

#[derive(Clone, Debug)]
struct Scene {
    balls: Vec<Ball>,
    elliptic: bool,
    impratio: f64,
    loss: f64,
    angle: f64,
    speeds: Vec<f64>,
}

fn scene() -> impl Strategy<Value = Scene> {
    let friction = (0.2..1.2, 0.005..0.1, 0.001..0.05).prop_map(|(a, b, c)| [a, b, c]);
    let ball = (1e-4..5e-3, prop::sample::select(vec![1, 3, 4, 6]), friction, 0.3..3.0)
        .prop_map(|(depth, condim, friction, mass)| Ball { depth, condim, friction, mass });
    let speeds = prop::collection::vec(-0.5..0.5, 32);
    let balls = prop::collection::vec(ball, 1..4);
    (balls, any::<bool>(), 0.5..5.0, 0.01..2.0, -0.4..0.4, speeds).prop_map(
        |(balls, elliptic, impratio, loss, angle, speeds)| Scene {
            balls,
            elliptic,
            impratio,
            loss,
            angle,
            speeds,
        },
    )
}

impl Scene {
    /// Balls in a row. The first is connected to an arm with dry friction and limits.
    fn model(&self) -> Model {
        let mut balls = String::new();
        for (i, b) in self.balls.iter().enumerate() {
            let [slide, spin, roll] = b.friction;
            let (x, z) = (0.199 * i as f64, 0.1 - b.depth);
            let _ = write!(
                balls,
                "<body name='b{i}' pos='{x} 0 {z}'><freejoint/><geom size='.1' mass='{}' condim='{}' priority='1' \
                 friction='{slide} {spin} {roll}'/></body>",
                b.mass, b.condim
            );
        }
        let (cone, loss) = (if self.elliptic { "elliptic" } else { "pyramidal" }, self.loss);
        let m = compile(&format!(
            "<mujoco><option cone='{cone}' impratio='{}' tolerance='0' ls_tolerance='1e-10' iterations='300' \
             ls_iterations='100'/><worldbody><geom type='plane' size='5 5 1'/>{balls}\
             <body name='arm' pos='-.4 0 .1'><joint name='arm' axis='0 1 0' range='-10 10' frictionloss='{loss}'/>\
             <geom type='capsule' fromto='0 0 0 .2 0 0' size='.03' contype='0' conaffinity='0'/></body></worldbody>\
             <equality><connect body1='arm' body2='b0' anchor='.3 0 0'/></equality></mujoco>",
            self.impratio
        ));
        m.unwrap()
    }

    fn data(&self, m: &Model) -> Data {
        let mut d = Data::new(m);
        if let Some(angle) = d.edit().qpos.last_mut() {
            *angle = self.angle;
        }
        for (v, s) in d.edit().qvel.iter_mut().zip(&self.speeds) {
            *v = *s;
        }
        d
    }
}

fn largest(v: &[f64]) -> f64 {
    v.iter().fold(1.0, |s: f64, x| s.max(x.abs()))
}

/// The distance of the friction force of a contact outside its cone, relative to its normal force.
fn outside(m: &Model, d: &Data, c: &Contact) -> f64 {
    let [normal, tangents @ ..] = core::contact_force(m, d, c).unwrap();
    let shares = tangents.iter().zip(c.friction).take(c.dim - 1).map(|(f, mu)| (f / mu).abs());
    let size: f64 = if m.opt.cone == 0 { shares.sum() } else { shares.map(|s| s * s).sum::<f64>().sqrt() };
    (-normal).max(size - normal) / (1.0 + normal)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn forces_obey_their_constraints(scene in scene()) {
        let m = scene.model();
        let mut d = scene.data(&m);
        core::forward(&m, &mut d).unwrap();
        for c in d.contact.iter().filter(|c| c.efc_address.is_some()) {
            prop_assert!(outside(&m, &d, c) < 1e-9, "{c:?} {:?}", core::contact_force(&m, &d, c).unwrap());
        }
        // Forces computed from accelerations: x = J a - aref.
        let jac = core::full_j(&m, &d).unwrap();
        let scale = largest(&d.efc_force);
        for row in 0..d.nefc {
            let (f, stiff) = (d.efc_force[row], d.efc_D[row]);
            let ja: f64 = (0..m.nv).map(|k| jac[row * m.nv + k] * d.qacc[k]).sum();
            let pull = -stiff * (ja - d.efc_aref[row]);
            let expected = match d.efc_type[row] {
                EQUALITY => pull,
                t if FRICTION.contains(&t) => pull.clamp(-d.efc_frictionloss[row], d.efc_frictionloss[row]),
                ELLIPTIC => continue,
                _ => pull.max(0.0),
            };
            prop_assert!((f - expected).abs() < 1e-6 * scale, "row {row}: {f}, not {expected}");
        }
        // M a = smooth forces + Jᵀ f.
        let mass = core::full_m(&m, &d).unwrap();
        for i in 0..m.nv {
            let ma: f64 = (0..m.nv).map(|k| mass[i * m.nv + k] * d.qacc[k]).sum();
            let jf: f64 = (0..d.nefc).map(|r| jac[r * m.nv + i] * d.efc_force[r]).sum();
            let scale = largest(&d.qfrc_constraint);
            prop_assert!((jf - d.qfrc_constraint[i]).abs() < 1e-10 * scale);
            prop_assert!((ma - d.qfrc_smooth[i] - jf).abs() < 1e-6 * scale, "{ma} {} {jf}", d.qfrc_smooth[i]);
        }
    }

    #[test]
    fn solvers_agree(scene in scene()) {
        let mut m = scene.model();
        let mut d = scene.data(&m);
        core::forward(&m, &mut d).unwrap();
        let newton = d.qacc.clone();
        for (which, iterations, tolerance) in [(solver::CG, 2000, 1e-6), (solver::PGS, 20_000, 1e-5)] {
            (*m.edit().opt.solver, *m.edit().opt.iterations) = (which, iterations);
            let mut d = scene.data(&m);
            core::forward(&m, &mut d).unwrap();
            let difference = newton.iter().zip(&d.qacc).fold(0.0, |s: f64, (a, b)| s.max((a - b).abs()));
            prop_assert!(difference < tolerance * largest(&newton), "solver {which}: {difference} of {}", largest(&newton));
        }
    }

    /// f is the minimum of the dual problem if and only if f is in the set of valid forces of its rows, and no valid change of f
    /// along the negative gradient g = J a - aref + R f decreases the cost: g = 0 inside the set, outward at a bound, and for a
    /// cone in the dual cone and perpendicular to f.
    #[test]
    fn dual_forces_are_optimal(scene in scene()) {
        let mut m = scene.model();
        (*m.edit().opt.solver, *m.edit().opt.iterations) = (solver::PGS, 20_000);
        let mut d = scene.data(&m);
        core::forward(&m, &mut d).unwrap();
        let jac = core::full_j(&m, &d).unwrap();
        let gradient: Vec<f64> = (0..d.nefc)
            .map(|r| (0..m.nv).map(|k| jac[r * m.nv + k] * d.qacc[k]).sum::<f64>() - d.efc_aref[r] + d.efc_R[r] * d.efc_force[r])
            .collect();
        let small = 1e-6 * largest(&d.qacc).max(largest(&d.efc_aref));
        for row in 0..d.nefc {
            let (f, g, loss) = (d.efc_force[row], gradient[row], d.efc_frictionloss[row]);
            match d.efc_type[row] {
                EQUALITY => prop_assert!(g.abs() < small, "row {row}: {g}"),
                t if FRICTION.contains(&t) => {
                    prop_assert!(f.abs() <= loss);
                    let bound = if f.abs() < loss { g.abs() } else { (g * f.signum()).max(0.0) };
                    prop_assert!(bound < small, "row {row}: {g} at {f}");
                }
                ELLIPTIC => {}
                _ => {
                    prop_assert!(f >= 0.0 && g > -small, "row {row}: {g} at {f}");
                    prop_assert!(f == 0.0 || g < small, "row {row}: {g} at {f}");
                }
            }
        }
        for c in d.contact.iter().filter(|c| scene.elliptic && c.dim > 1) {
            let Some(first) = c.efc_address else { continue };
            let tangents = || (1..c.dim).map(|j| (first + j, c.friction[j - 1]));
            let length = |parts: &mut dyn Iterator<Item = f64>| parts.map(|x| x * x).sum::<f64>().sqrt();
            let friction = length(&mut tangents().map(|(r, mu)| d.efc_force[r] / mu));
            let pull = length(&mut tangents().map(|(r, mu)| gradient[r] * mu));
            let (normal, slope) = (d.efc_force[first], gradient[first]);
            prop_assert!(friction <= normal * (1.0 + 1e-12), "{friction} {normal}");
            prop_assert!(pull - slope < small, "{pull} {slope}");
            let across: f64 = (0..c.dim).map(|j| d.efc_force[first + j] * gradient[first + j]).sum();
            prop_assert!(across.abs() < small * (1.0 + normal), "{across}");
        }
    }

    /// After the removal of slip, sticking contacts have only the tangential acceleration of their reference, and forces are
    /// inside their cones.
    #[test]
    fn removal_of_slip_keeps_the_cones(scene in scene()) {
        let mut m = scene.model();
        (*m.edit().opt.noslip_iterations, *m.edit().opt.noslip_tolerance) = (20_000, 0.0);
        let mut d = scene.data(&m);
        core::forward(&m, &mut d).unwrap();
        let jac = core::full_j(&m, &d).unwrap();
        let slip = |row: usize| {
            (0..m.nv).map(|k| jac[row * m.nv + k] * d.qacc[k]).sum::<f64>() - d.efc_aref[row]
        };
        let small = 1e-5 * largest(&d.qacc).max(largest(&d.efc_aref));
        for c in d.contact.iter() {
            let Some(first) = c.efc_address else { continue };
            prop_assert!(outside(&m, &d, c) < 1e-9, "{c:?} {:?}", core::contact_force(&m, &d, c).unwrap());
            if !scene.elliptic || c.dim == 1 || d.efc_force[first] == 0.0 {
                continue;
            }
            // In coordinates in which the friction limit is a ball: no slip inside the ball; at its boundary, slip opposite to
            // the force.
            let rows = || (1..c.dim).map(|j| (d.efc_force[first + j] / c.friction[j - 1], slip(first + j) * c.friction[j - 1]));
            let length = |parts: &mut dyn Iterator<Item = f64>| parts.map(|x| x * x).sum::<f64>().sqrt();
            let (force, pull) = (length(&mut rows().map(|(y, _)| y)), length(&mut rows().map(|(_, g)| g)));
            if force < d.efc_force[first] * (1.0 - 1e-9) {
                prop_assert!(pull < small, "{pull}");
            } else {
                let against = rows().map(|(y, g)| -y * g).sum::<f64>() / force;
                prop_assert!(pull - against < small, "{pull} {against}");
            }
        }
        for row in (0..d.nefc).filter(|&r| FRICTION.contains(&d.efc_type[r])) {
            let (f, g, loss) = (d.efc_force[row], slip(row), d.efc_frictionloss[row]);
            prop_assert!(f.abs() <= loss);
            let bound = if f.abs() < loss { g.abs() } else { (g * f.signum()).max(0.0) };
            prop_assert!(bound < small, "row {row}: {g} at {f}");
        }
    }
}
