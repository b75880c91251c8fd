//! Laws of contacts: forces are equal and opposite, a contact returns no more energy than it receives, and no result
//! depends on the order of the bodies in the file.

use labspec_core::math::{Vec3, cross};
use labspec_core::xml::compile;
use labspec_core::{self as core, Data, Model};
use proptest::prelude::*;
use std::fmt::Write;

/// A free body of one shape.
#[derive(Clone, Copy, Debug)]
struct Solid {
    kind: &'static str,
    size: Vec3,
    turn: Vec3,
    mass: f64,
    condim: usize,
    speed: [f64; 6],
}

fn triple(range: std::ops::Range<f64>) -> impl Strategy<Value = Vec3> {
    [range.clone(), range.clone(), range]
}

fn solid() -> impl Strategy<Value = Solid> {
    let kind = prop::sample::select(vec!["sphere", "capsule", "ellipsoid", "cylinder", "box"]);
    let condim = prop::sample::select(vec![1, 3, 4, 6]);
    (kind, triple(0.08..0.15), triple(-3.0..3.0), 0.2..5.0, condim, prop::array::uniform6(-1.0..1.0))
        .prop_map(|(kind, size, turn, mass, condim, speed)| Solid { kind, size, turn, mass, condim, speed })
}

/// The text of a scene: overlapping solids in a row, in this order, and nothing else.
fn row(solids: &[Solid], order: &[usize], cone: &str, head: &str) -> String {
    let mut bodies = String::new();
    for &i in order {
        let Solid { kind, size, turn, mass, condim, .. } = solids[i];
        let [a, b, c] = size;
        let [x, y, z] = turn;
        let place = 0.15 * i as f64;
        let _ = write!(
            bodies,
            "<body name='b{i}' pos='{place} {} {}' euler='{x} {y} {z}'><freejoint/><geom type='{kind}' \
             size='{a} {b} {c}' mass='{mass}' condim='{condim}'/></body>",
            0.03 * (i % 2) as f64,
            0.02 * (i % 3) as f64
        );
    }
    format!(
        "<mujoco><compiler angle='radian'/><option cone='{cone}' tolerance='0' ls_tolerance='1e-10' iterations='300' \
         ls_iterations='100'/><worldbody>{head}{bodies}</worldbody></mujoco>"
    )
}

/// Data with the velocities of the solids, for any order.
fn moving(m: &Model, solids: &[Solid], order: &[usize]) -> Data {
    let mut d = Data::new(m);
    for (place, &i) in order.iter().enumerate() {
        d.edit().qvel[6 * place..6 * place + 6].copy_from_slice(&solids[i].speed);
    }
    core::forward(m, &mut d).unwrap();
    d
}

/// The constraint force and torque about the origin on a free body, world axes.
fn wrench(m: &Model, d: &Data, body: usize) -> (Vec3, Vec3) {
    let at = m.body_dofadr[body] as usize;
    let f = &d.qfrc_constraint[at..at + 6];
    let (mat, pos) = (&d.xmat[9 * body..], &d.xpos[3 * body..]);
    let force = [f[0], f[1], f[2]];
    // The torque is about the body's origin, along its own axes.
    let turn: Vec3 = std::array::from_fn(|r| (0..3).map(|c| mat[3 * r + c] * f[3 + c]).sum());
    let lever = cross([pos[0], pos[1], pos[2]], force);
    (force, std::array::from_fn(|k| turn[k] + lever[k]))
}

fn largest(v: &[f64]) -> f64 {
    v.iter().fold(1.0, |s: f64, x| s.max(x.abs()))
}

/// A ball that is thrown at a wall, without gravity.
#[derive(Clone, Copy, Debug)]
struct Throw {
    time: f64,
    damping: f64,
    solimp: [f64; 5],
    mass: f64,
    friction: f64,
    speed: Vec3,
    spin: Vec3,
    elliptic: bool,
}

fn throw() -> impl Strategy<Value = Throw> {
    let solimp = (0.3..1.0, 0.5..0.95, 1e-3..2e-2, 0.2..0.8, 1.0..3.0)
        .prop_map(|(share, dw, width, mid, power)| [share * dw, dw, width, mid, power]);
    let speed = (-1.0..1.0, -1.0..1.0, -2.0..-0.2).prop_map(|(x, y, z)| [x, y, z]);
    (0.01..0.1, 0.05..1.5, solimp, 0.1..5.0, 0.0..1.5, speed, triple(-5.0..5.0), any::<bool>()).prop_map(
        |(time, damping, solimp, mass, friction, speed, spin, elliptic)| Throw {
            time,
            damping,
            solimp,
            mass,
            friction,
            speed,
            spin,
            elliptic,
        },
    )
}

impl Throw {
    /// The kinetic energy after the contact, divided by that before, with this timestep.
    fn returned(&self, timestep: f64) -> f64 {
        let [a, b, c, d, e] = self.solimp;
        let cone = if self.elliptic { "elliptic" } else { "pyramidal" };
        let m = compile(&format!(
            "<mujoco><option timestep='{timestep}' gravity='0 0 0' cone='{cone}' tolerance='0' ls_tolerance='1e-10'>
             <flag energy='enable'/></option><default><geom friction='{}' solref='{} {}' solimp='{a} {b} {c} {d} {e}'/>
             </default><worldbody><geom type='plane' size='1 1 1'/><body pos='0 0 .1001'><freejoint/>
             <geom size='.1' mass='{}'/></body></worldbody></mujoco>",
            self.friction, self.time, self.damping, self.mass
        ))
        .unwrap();
        let mut data = Data::new(&m);
        data.edit().qvel[..3].copy_from_slice(&self.speed);
        data.edit().qvel[3..].copy_from_slice(&self.spin);
        core::forward(&m, &mut data).unwrap();
        let before = data.energy[1];
        // Half a period of the softest contact is a few time constants.
        for _ in 0..(40.0 * self.time / timestep) as usize {
            core::step(&m, &mut data).unwrap();
            if data.qpos[2] > 0.11 {
                break;
            }
        }
        core::forward(&m, &mut data).unwrap();
        data.energy[1] / before
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, ..ProptestConfig::default() })]

    /// The system is closed: contacts of any shapes and friction do not change linear and angular momentum.
    #[test]
    fn forces_are_equal_and_opposite(solids in prop::collection::vec(solid(), 2..6), elliptic: bool) {
        let order: Vec<usize> = (0..solids.len()).collect();
        let cone = if elliptic { "elliptic" } else { "pyramidal" };
        let m = compile(&row(&solids, &order, cone, "")).unwrap();
        let d = moving(&m, &solids, &order);
        let (mut force, mut torque) = ([0.0; 3], [0.0; 3]);
        for body in 1..m.nbody {
            let (f, t) = wrench(&m, &d, body);
            for k in 0..3 {
                force[k] += f[k];
                torque[k] += t[k];
            }
        }
        let scale = largest(&d.qfrc_constraint);
        for k in 0..3 {
            prop_assert!(force[k].abs() < 1e-12 * scale, "{force:?} of {scale}");
            prop_assert!(torque[k].abs() < 1e-12 * scale, "{torque:?} of {scale}");
        }
    }

    /// Bodies in another order have the same accelerations.
    #[test]
    fn order_of_bodies_does_not_matter(solids in prop::collection::vec(solid(), 2..6), elliptic: bool, by in 1usize..5) {
        let n = solids.len();
        let first: Vec<usize> = (0..n).collect();
        let second: Vec<usize> = (0..n).map(|i| (i + by) % n).collect();
        let (cone, floor) = (if elliptic { "elliptic" } else { "pyramidal" }, "<geom type='plane' size='1 1 1' pos='0 0 -.08'/>");
        let [(m, a), (_, b)] = [&first, &second].map(|order| {
            let m = compile(&row(&solids, order, cone, floor)).unwrap();
            let d = moving(&m, &solids, order);
            (m, d)
        });
        prop_assume!(m.ngeom == n + 1);
        // Pairs of equal types are tested in the order of the file. If there are several deepest points, another one may be
        // selected.
        prop_assume!(a.ncon == b.ncon && positions_agree(&a, &b));
        let scale = largest(&a.qacc);
        for (place, &i) in second.iter().enumerate() {
            for k in 0..6 {
                let difference = (a.qacc[6 * i + k] - b.qacc[6 * place + k]).abs();
                prop_assert!(difference < 1e-7 * scale, "body {i}, {k}: {difference} of {scale}");
            }
        }
    }

    /// In the limit of short steps, a contact returns no more energy than it receives. The excess decreases with the
    /// length of the step.
    #[test]
    fn contacts_create_no_energy(throw in throw()) {
        let [coarse, fine] = [50.0, 800.0].map(|n| (throw.returned(throw.time / n) - 1.0).max(0.0));
        prop_assert!(fine < 2e-3 && fine <= 0.25 * coarse + 1e-9, "{coarse} {fine}");
    }
}

/// Whether two lists of contacts have the same positions, in any order.
fn positions_agree(a: &Data, b: &Data) -> bool {
    let near = |p: &Vec3, q: &Vec3| (0..3).all(|k| (p[k] - q[k]).abs() < 1e-9);
    a.contact.iter().all(|c| b.contact.iter().any(|e| near(&c.pos, &e.pos)))
}
