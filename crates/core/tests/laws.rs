//! Laws of mechanics, on random trees: what must hold whatever the algorithm. Where a quantity is needed twice it
//! is built here a second time from its definition, with dense matrices.

#![allow(clippy::unwrap_used)]

#[path = "../../../tests/scenes.rs"]
mod scenes;

use labspec_core::mjcf::compile;
use labspec_core::{self as core, Data, Model, integrator, joint};
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};
use proptest::collection::vec;
use proptest::prelude::*;
use scenes::scene;

fn vector(a: &[f64], i: usize) -> Vector3<f64> {
    Vector3::from_column_slice(&a[3 * i..3 * i + 3])
}

fn matrix(a: &[f64], i: usize) -> Matrix3<f64> {
    Matrix3::from_row_slice(&a[9 * i..9 * i + 9])
}

/// Jacobian of a body's centre of mass and of its orientation, 3 × nv each, joint by joint from the definition.
fn jacobian(m: &Model, d: &Data, body: usize) -> (DMatrix<f64>, DMatrix<f64>) {
    let (mut move_, mut turn) = (DMatrix::zeros(3, m.nv), DMatrix::zeros(3, m.nv));
    let point = vector(&d.xipos, body);
    let mut b = body;
    while b > 0 {
        for j in (0..m.njnt).filter(|&j| m.jnt_bodyid[j] as usize == b) {
            let dof = m.jnt_dofadr[j] as usize;
            let mut rotation = |k: usize, axis: Vector3<f64>| {
                turn.set_column(k, &axis);
                move_.set_column(k, &axis.cross(&(point - vector(&d.xanchor, j))));
            };
            match m.jnt_type[j] {
                joint::HINGE => rotation(dof, vector(&d.xaxis, j)),
                joint::SLIDE => move_.set_column(dof, &vector(&d.xaxis, j)),
                kind => {
                    // Rotations of ball and free joints are about the body's own axes.
                    let first = if kind == joint::FREE { dof + 3 } else { dof };
                    (0..3).for_each(|k| rotation(first + k, matrix(&d.xmat, b).column(k).into()));
                    if kind == joint::FREE {
                        (0..3).for_each(|k| move_[(k, dof + k)] = 1.0);
                    }
                }
            }
        }
        b = m.body_parentid[b] as usize;
    }
    (move_, turn)
}

/// Inertia of a body about its centre of mass, world axes.
fn inertia(m: &Model, d: &Data, body: usize) -> Matrix3<f64> {
    let axes = matrix(&d.ximat, body);
    axes * Matrix3::from_diagonal(&vector(&m.body_inertia, body)) * axes.transpose()
}

/// Σ m Jᵀ J + Jᵀ I J over all bodies, and the armature.
fn mass_matrix(m: &Model, d: &Data) -> DMatrix<f64> {
    let mut all = DMatrix::from_diagonal(&DVector::from_column_slice(&m.dof_armature));
    for b in 1..m.nbody {
        let (move_, turn) = jacobian(m, d, b);
        all += m.body_mass[b] * move_.tr_mul(&move_) + turn.tr_mul(&(inertia(m, d, b) * &turn));
    }
    all
}

/// Momentum of everything: linear, and angular about the origin.
fn momentum(m: &Model, d: &Data) -> [f64; 6] {
    let v = DVector::from_column_slice(&d.qvel);
    let (mut linear, mut angular) = (Vector3::zeros(), Vector3::zeros());
    for b in 1..m.nbody {
        let (move_, turn) = jacobian(m, d, b);
        let p: Vector3<f64> = Vector3::from_iterator((&move_ * &v * m.body_mass[b]).iter().copied());
        let spin = inertia(m, d, b) * Vector3::from_iterator((&turn * &v).iter().copied());
        linear += p;
        angular += spin + vector(&d.xipos, b).cross(&p);
    }
    [linear.x, linear.y, linear.z, angular.x, angular.y, angular.z]
}

/// Moves to a random place with a random velocity.
fn scatter(m: &Model, d: &mut Data, numbers: &[f64]) {
    let take = |from: usize| (0..m.nv).map(|i| numbers[(from + i) % numbers.len()]).collect::<Vec<_>>();
    core::integrate_pos(m, &mut d.qpos, &take(0), 0.5);
    d.qvel.copy_from_slice(&take(m.nv));
}

fn numbers() -> impl Strategy<Value = Vec<f64>> {
    vec(-1.0..1.0, 61)
}

fn full_m(m: &Model, d: &Data) -> DMatrix<f64> {
    DMatrix::from_row_slice(m.nv, m.nv, &core::full_m(m, d))
}

/// Rounding: sums of some hundred products, of which the largest cancel at most in the third digit.
const ROUNDING: f64 = 1e-12;

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, ..ProptestConfig::default() })]

    #[test]
    fn the_mass_matrix_is_that_of_its_definition(scene in scene(), numbers in numbers()) {
        let m = compile(&scene.conservative()).unwrap();
        let mut d = Data::new(&m);
        scatter(&m, &mut d, &numbers);
        core::forward(&m, &mut d);
        let ours = full_m(&m, &d);
        let theirs = mass_matrix(&m, &d);
        let scale = theirs.amax().max(1.0);
        prop_assert!((&ours - &theirs).amax() <= ROUNDING * scale, "{ours}{theirs}");
        prop_assert_eq!(&ours, &ours.transpose());
        // Positive definite: a Cholesky factor exists.
        prop_assert!(m.nv == 0 || ours.cholesky().is_some());
    }

    /// M a + bias = force, with the forces put together from their definitions; gravity's part of the bias, too.
    #[test]
    fn forces_and_accelerations_balance(scene in scene(), numbers in numbers()) {
        let m = compile(&scene.xml()).unwrap();
        let mut d = Data::new(&m);
        scatter(&m, &mut d, &numbers);
        for i in 0..m.nv {
            d.qfrc_applied[i] = numbers[(7 * i) % numbers.len()];
        }
        for i in 6..6 * m.nbody {
            d.xfrc_applied[i] = numbers[(11 * i) % numbers.len()];
        }
        core::forward(&m, &mut d);
        let vec = DVector::from_column_slice;
        let mut force = vec(&d.qfrc_passive) + vec(&d.qfrc_applied) + vec(&d.qfrc_constraint);
        for b in 1..m.nbody {
            let (move_, turn) = jacobian(&m, &d, b);
            force += move_.tr_mul(&vector(&d.xfrc_applied, 2 * b)) + turn.tr_mul(&vector(&d.xfrc_applied, 2 * b + 1));
        }
        let mass = full_m(&m, &d);
        let residual = &mass * vec(&d.qacc) + vec(&d.qfrc_bias) - &force;
        // The sum of a constraint's edges can be no more exact than they are: on a body that can only turn, a
        // contact has no weight to lean on, and edges of 1e17 N keep each other in balance.
        let edges = vec(&d.efc_force).amax();
        let scale = (mass.amax() * vec(&d.qacc).amax()).max(force.amax()).max(edges).max(1.0);
        prop_assert!(residual.amax() <= 1e-10 * scale, "{residual}");

        d.qvel.fill(0.0);
        core::forward(&m, &mut d);
        let mut gravity = DVector::zeros(m.nv);
        for b in 1..m.nbody {
            gravity -= jacobian(&m, &d, b).0.tr_mul(&(m.body_mass[b] * Vector3::from(m.opt.gravity)));
        }
        prop_assert!((vec(&d.qfrc_bias) - &gravity).amax() <= ROUNDING * gravity.amax().max(1.0), "{gravity}");
    }

    #[test]
    fn quaternions_keep_their_length(scene in scene(), numbers in numbers()) {
        let m = compile(&scene.xml()).unwrap();
        let mut d = Data::new(&m);
        scatter(&m, &mut d, &numbers);
        for _ in 0..100 {
            core::step(&m, &mut d);
        }
        let length = |q: &[f64]| q.iter().map(|x| x * x).sum::<f64>().sqrt();
        for j in 0..m.njnt {
            let at = m.jnt_qposadr[j] as usize;
            let first = match m.jnt_type[j] {
                joint::FREE => at + 3,
                joint::BALL => at,
                _ => continue,
            };
            // One product of unit quaternions since the last normalization.
            prop_assert!((length(&d.qpos[first..first + 4]) - 1.0).abs() <= 1e-15 * 8.0);
        }
        for b in 0..m.nbody {
            prop_assert!((length(&d.xquat[4 * b..4 * b + 4]) - 1.0).abs() <= 1e-15 * 8.0);
        }
    }
}

/// Largest change of an invariant over a short run, relative to its own scale.
fn drift(m: &Model, start: &[f64], h: f64, steps: usize, invariants: fn(&Model, &Data) -> Vec<f64>) -> f64 {
    let mut m = m.clone();
    (m.opt.timestep, m.opt.integrator) = (h, integrator::RK4);
    let mut d = Data::new(&m);
    scatter(&m, &mut d, start);
    core::forward(&m, &mut d);
    let before = invariants(&m, &d);
    for _ in 0..steps {
        core::step(&m, &mut d);
    }
    core::forward(&m, &mut d);
    let after = invariants(&m, &d);
    before.iter().zip(&after).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

fn energy(_: &Model, d: &Data) -> Vec<f64> {
    vec![d.energy[0] + d.energy[1]]
}

fn all_momentum(m: &Model, d: &Data) -> Vec<f64> {
    momentum(m, d).to_vec()
}

/// How much smaller an error must become when the step is halved. Runge and Kutta's method is of fourth order:
/// 16 times, 12 leaves room for the next order. Rotations in space combine the slopes as if they commuted,
/// which is right to second order only: 4 times, 3 with room.
fn gain(m: &Model) -> f64 {
    let scalar = m.jnt_type.iter().all(|&t| t == joint::HINGE || t == joint::SLIDE);
    if scalar { 12.0 } else { 3.0 }
}

/// The drift shrinks as the method's order says, or is rounding already. Fast motions, for which the step is
/// long, are left to shorter steps.
fn shrinks(m: &Model, start: &[f64], invariants: fn(&Model, &Data) -> Vec<f64>) -> Result<(), String> {
    let rounding = 1e-10;
    let mut h: f64 = 2e-3;
    let mut seen = Vec::new();
    for _ in 0..5 {
        let steps = (0.032 / h).round() as usize;
        let (coarse, fine) =
            (drift(m, start, h, steps, invariants), drift(m, start, h / 2.0, 2 * steps, invariants));
        if fine <= rounding || fine <= coarse / gain(m) {
            return Ok(());
        }
        seen.push((h, coarse, fine));
        h /= 2.0;
    }
    Err(format!("timestep, drift, drift with half of it: {seen:?}"))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 100, max_shrink_iters: 300, ..ProptestConfig::default() })]

    #[test]
    fn energy_is_conserved_to_the_order_of_the_integrator(scene in scene(), numbers in numbers()) {
        let m = compile(&scene.conservative()).unwrap();
        let result = shrinks(&m, &numbers, energy);
        prop_assert!(result.is_ok(), "{result:?}");
    }

    #[test]
    fn momentum_of_floating_trees_is_conserved(scene in scene(), numbers in numbers()) {
        let m = compile(&scene.floating()).unwrap();
        let result = shrinks(&m, &numbers, all_momentum);
        prop_assert!(result.is_ok(), "{result:?}");
    }
}

/// Contact parameters of a resting sphere.
#[derive(Clone, Copy, Debug)]
struct Rest {
    time: f64,
    damping: f64,
    solimp: [f64; 5],
    mass: f64,
    timestep: f64,
    friction: Option<f64>,
}

/// Any contact, or one that comes to rest: a contact that answers within a few steps and damps little goes on
/// bouncing, in MuJoCo as here, because each step applies the force of its beginning.
fn rest(settles: bool) -> impl Strategy<Value = Rest> {
    let (steps, damping, end) = if settles { (4.0, 0.8, 0.8) } else { (0.5, 0.3, 0.3) };
    let solimp = (0.3..1.0, end..0.98, 2e-4..5e-3, 0.2..0.8, 1.0..4.0);
    (steps..20.0, damping..1.5, solimp, 0.01..10.0, 0.0005..0.005, prop::option::of(0.2..1.5)).prop_map(
        |(steps, damping, (share, dw, width, mid, power), mass, timestep, friction)| Rest {
            time: steps * timestep,
            damping,
            solimp: [share * dw, dw, width, mid, power],
            mass,
            timestep,
            friction,
        },
    )
}

impl Rest {
    /// Impedance at a depth.
    fn impedance(&self, depth: f64) -> f64 {
        let [d0, dw, width, mid, power] = self.solimp;
        let x = (depth / width).min(1.0);
        let y = if x <= mid {
            x.powf(power) / mid.powf(power - 1.0)
        } else {
            1.0 - (1.0 - x).powf(power) / (1.0 - mid).powf(power - 1.0)
        };
        d0 + y * (dw - d0)
    }

    /// The depth at which the contact carries the weight: K d r = g (1 - d) / d, with K = 1 / (dw tc ζ)². Four
    /// edges of a pyramid, each with R = 2 µ² (1 + µ²) (1 - d) / (d m), carry µ² (1 + µ²) / 2 times as deep.
    fn depth(&self) -> f64 {
        let time = self.time.max(2.0 * self.timestep);
        let k = 1.0 / (self.solimp[1] * time * self.damping).powi(2);
        let share = self.friction.map_or(1.0, |mu| 0.5 * mu * mu * (1.0 + mu * mu));
        let excess = |r: f64| {
            let d = self.impedance(r);
            k * d * r - share * 9.81 * (1.0 - d) / d
        };
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            if excess(middle) < 0.0 { low = middle } else { high = middle }
        }
        low
    }

    fn model(&self) -> Model {
        let [a, b, c, d, e] = self.solimp;
        let contact = match self.friction {
            Some(mu) => format!("condim='3' friction='{mu}'"),
            None => "condim='1'".into(),
        };
        let same = format!("solref='{} {}' solimp='{a} {b} {c} {d} {e}' {contact}", self.time, self.damping);
        compile(&format!(
            "<mujoco><option timestep='{}'/><worldbody><geom type='plane' size='1 1 1' {same}/>
             <body pos='0 0 2'><freejoint/><geom size='2' mass='{}' {same}/></body></worldbody></mujoco>",
            self.timestep, self.mass
        ))
        .unwrap()
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 50, max_shrink_iters: 300, ..ProptestConfig::default() })]

    #[test]
    fn a_sphere_rests_as_deep_as_the_closed_form_says(rest in rest(true)) {
        let mut m = rest.model();
        // At the default tolerance the solver stops early and the sphere creeps up and down by 1e-9 m/s.
        (m.opt.tolerance, m.opt.ls_tolerance) = (0.0, 1e-10);
        let mut d = Data::new(&m);
        for _ in 0..20_000 {
            core::step(&m, &mut d);
        }
        let depth = 2.0 - d.qpos[2];
        let expected = rest.depth();
        // The last motion has died out; a depth of 1e-5 m is known to 1e-16 of the height of 2 m.
        prop_assert!((depth - expected).abs() <= 1e-10 * expected + 1e-14, "{depth} {expected}");
        prop_assert!(d.qvel.iter().all(|v| v.abs() < 1e-12), "{:?}", d.qvel);
    }

    /// At that depth forces balance, whether or not steps of this length would find it.
    #[test]
    fn the_closed_form_is_in_balance(rest in rest(false)) {
        let mut m = rest.model();
        (m.opt.tolerance, m.opt.ls_tolerance) = (0.0, 1e-10);
        let mut d = Data::new(&m);
        d.qpos[2] = 2.0 - rest.depth();
        core::forward(&m, &mut d);
        prop_assert_eq!(d.ncon, 1);
        // The depth is known to 1e-16 of the radius; the reference acceleration is its product with K d.
        let stiffness = d.efc_KBIP[0] * d.efc_KBIP[2];
        prop_assert!(d.qacc[2].abs() <= 1e-9 + 1e-14 * stiffness, "{:?} {stiffness}", d.qacc);
    }
}
