//! One test suite for all integrators: closed forms of one step, the observed order of convergence, conserved quantities.

use crate::definitions::*;
use crate::scenes::scene;
use labspec_core::xml::compile;
use labspec_core::{self as core, Data, Model, integrator, joint};
use proptest::prelude::*;

/// An integrator, its order, and its order for rotations in space. The Runge–Kutta method combines slopes of rotations as if they
/// commuted.
#[derive(Clone, Copy)]
struct Method {
    id: i32,
    order: f64,
    order_in_space: f64,
    /// A timestep at which the order can be observed: small enough for the method, and large enough that rounding does not
    /// dominate.
    step: f64,
}

const METHODS: [Method; 8] = [
    Method { id: integrator::EULER, order: 1.0, order_in_space: 1.0, step: 4e-3 },
    Method { id: integrator::RK4, order: 4.0, order_in_space: 2.0, step: 4e-3 },
    Method { id: integrator::IMPLICIT, order: 1.0, order_in_space: 1.0, step: 4e-3 },
    Method { id: integrator::IMPLICITFAST, order: 1.0, order_in_space: 1.0, step: 4e-3 },
    Method { id: integrator::DISCRETE, order: 1.0, order_in_space: 1.0, step: 4e-3 },
    Method { id: integrator::RKMK4, order: 4.0, order_in_space: 4.0, step: 8e-3 },
    Method { id: integrator::RKMK8, order: 8.0, order_in_space: 8.0, step: 0.04 },
    Method { id: integrator::GAUSS, order: 6.0, order_in_space: 6.0, step: 0.04 },
];

/// The state after `steps` steps of length `h`, from an initial state that `begin` sets.
fn end(m: &Model, method: &Method, h: f64, steps: usize, begin: impl Fn(&mut Data)) -> Data {
    let mut m = m.clone();
    (*m.edit().opt.timestep, *m.edit().opt.integrator) = (h, method.id);
    let mut d = Data::new(&m);
    begin(&mut d);
    (0..steps).for_each(|_| core::step(&m, &mut d).unwrap());
    d
}

fn distance(a: &Data, b: &Data) -> f64 {
    let differences = a.qpos.iter().zip(&b.qpos).chain(a.qvel.iter().zip(&b.qvel));
    differences.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// The observed order of three runs, each with half the timestep of the previous one: the logarithm of the ratio of their
/// differences, base 2. `None` if the differences are at the level of rounding.
fn observed_order(m: &Model, method: &Method, h: f64, time: f64, begin: impl Fn(&mut Data)) -> Option<f64> {
    let run = |k: usize| end(m, method, h / k as f64, k * (time / h).round() as usize, &begin);
    let [coarse, middle, fine] = [run(1), run(2), run(4)];
    let (first, second) = (distance(&coarse, &middle), distance(&middle, &fine));
    // Large numbers have larger rounding errors, which methods of high order reach quickly.
    let size = fine.qpos.iter().chain(fine.qvel.iter()).fold(1.0f64, |a, x| a.max(x.abs()));
    let rounding = if method.order > 4.0 { 1e-11 * size } else { 1e-12 };
    (second > rounding).then(|| (first / second).log2())
}

/// A cart with a two-link arm: springs, dampers, oblique axes, no rotations in space.
const ARM: &str = "<mujoco><worldbody><body pos='0 0 1'>
    <joint type='slide' axis='1 0.2 0' stiffness='20' damping='0.5'/><geom size='0.1' mass='2'/>
    <body pos='0 0 -0.1'><joint axis='0 1 0.3' damping='0.05'/><geom pos='0.02 0 -0.3' size='0.05' mass='1'/>
    <body pos='0 0 -0.4'><joint axis='0.5 1 0' stiffness='1' springref='20'/><geom pos='0 0.05 -0.2' size='0.05' mass='0.5'/>
    </body></body></body></worldbody></mujoco>";

/// A body in free rotation with a pendulum on a ball joint.
const TUMBLING_BODY: &str = "<mujoco><worldbody><body pos='0 0 1'>
    <freejoint/><geom pos='0.1 0 0' size='0.1' mass='1'/><geom pos='-0.2 0.1 0' size='0.05' mass='0.5'/><geom pos='0 0.1 0.1' size='0.05' mass='0.3'/>
    <body pos='0.2 0 0'><joint type='ball' damping='0.02' stiffness='0.5'/><geom pos='0.1 0.1 -0.2' size='0.05' mass='0.4'/>
    <geom pos='-0.1 0.1 0' size='0.05' mass='0.2'/></body></body></worldbody></mujoco>";

#[test]
fn orders_of_convergence() {
    let arm = compile(ARM).unwrap();
    let tumbler = compile(TUMBLING_BODY).unwrap();
    for method in &METHODS {
        let push =
            |d: &mut Data| d.edit().qvel.iter_mut().enumerate().for_each(|(i, v)| *v = 0.8 - 0.3 * i as f64);
        let time = if method.order > 4.0 { 0.32 } else { 0.16 };
        // At small timesteps, a method of high order reaches the level of rounding. At larger ones, the terms of the next orders,
        // which are smaller by powers of the timestep, still contribute.
        let above = if method.order > 4.0 { 0.7 } else { 0.15 };
        for (m, expected) in [(&arm, method.order), (&tumbler, method.order_in_space)] {
            let order = observed_order(m, method, method.step, time, push).unwrap();
            assert!(
                order > expected - 0.15 && order < expected + above,
                "integrator {}: order {order}, not {expected}",
                method.id
            );
        }
    }
}

/// The adaptive method does not need small timesteps: one step over the whole time is as accurate as 8,000 steps of order eight.
#[test]
fn the_adaptive_method_is_accurate_for_every_timestep() {
    let reference = Method { id: integrator::RKMK8, order: 8.0, order_in_space: 8.0, step: 0.0 };
    let adaptive = Method { id: integrator::ADAPTIVE, ..reference };
    let push =
        |d: &mut Data| d.edit().qvel.iter_mut().enumerate().for_each(|(i, v)| *v = 3.0 - 0.9 * i as f64);
    for xml in [ARM, TUMBLING_BODY] {
        let m = compile(xml).unwrap();
        let truth = end(&m, &reference, 1e-3, 400, push);
        for h in [0.4, 0.1, 0.02, 2e-3] {
            let error = distance(&end(&m, &adaptive, h, (0.4 / h).round() as usize, push), &truth);
            assert!(error < 2e-11, "{h}: {error}");
        }
    }
}

/// A body that rotates about its unstable middle axis, and the conserved quantities of free rotation: energy and momentum.
#[test]
fn free_rotation_keeps_its_energy_and_momentum() {
    let m = compile(
        "<mujoco><option gravity='0 0 0'><flag energy='enable'/></option><worldbody><body><freejoint/>
         <geom type='box' size='0.3 0.2 0.05' mass='1'/></body></worldbody></mujoco>",
    )
    .unwrap();
    let spin = |d: &mut Data| d.edit().qvel[3..6].copy_from_slice(&[0.01, 10.0, 0.02]);
    let invariants = |d: &Data| {
        let i = &m.body_inertia[3..6];
        let (w, frame) = (&d.qvel[3..6], &d.ximat[9..18]);
        let energy: f64 = (0..3).map(|k| 0.5 * i[k] * w[k] * w[k]).sum();
        let turn = |r: usize| (0..3).map(|k| frame[3 * r + k] * i[k] * w[k]).sum::<f64>();
        [energy, turn(0), turn(1), turn(2)]
    };
    let drift = |id: i32| {
        let mut m = m.clone();
        (*m.edit().opt.timestep, *m.edit().opt.integrator) = (0.01, id);
        let mut d = Data::new(&m);
        spin(&mut d);
        core::forward(&m, &mut d).unwrap();
        let before = invariants(&d);
        let mut worst = [0.0f64; 2];
        for _ in 0..1000 {
            core::step(&m, &mut d).unwrap();
            let mut seen = d.clone();
            core::forward(&m, &mut seen).unwrap();
            let current = invariants(&seen);
            worst[0] = worst[0].max((before[0] - current[0]).abs() / before[0]);
            worst[1] = (1..4).map(|k| (before[k] - current[k]).abs() / before[2]).fold(worst[1], f64::max);
        }
        worst
    };
    let [gauss, classic, on_the_group] = [integrator::GAUSS, integrator::RK4, integrator::RKMK4].map(drift);
    assert!(gauss[0] < 1e-13 && gauss[1] < 1e-9, "{gauss:?}");
    assert!(on_the_group[1] * 10.0 < classic[1], "{on_the_group:?} {classic:?}");
}

/// A mass on a spring with a damper, in any state.
#[derive(Clone, Copy, Debug)]
struct Oscillator {
    mass: f64,
    stiffness: f64,
    damping: f64,
    timestep: f64,
    x: f64,
    v: f64,
}

fn an_oscillator() -> impl Strategy<Value = Oscillator> {
    (-1.0..1.0f64, -1.0..1.0f64, 1e-4..0.05f64, 0.1..1000.0f64, 0.01..50.0f64, 0.1..10.0f64).prop_map(
        |(x, v, timestep, stiffness, damping, mass)| Oscillator { mass, stiffness, damping, timestep, x, v },
    )
}

impl Oscillator {
    /// x and v after one step, computed from the definition of each method.
    fn step(&self, id: i32) -> (f64, f64) {
        let Oscillator { mass: m, stiffness: k, damping: b, timestep: h, x, v } = *self;
        let v1 = match id {
            integrator::RK4 | integrator::RKMK4 => {
                let slope = |x: f64, v: f64| (v, (-k * x - b * v) / m);
                let k1 = slope(x, v);
                let k2 = slope(x + 0.5 * h * k1.0, v + 0.5 * h * k1.1);
                let k3 = slope(x + 0.5 * h * k2.0, v + 0.5 * h * k2.1);
                let k4 = slope(x + h * k3.0, v + h * k3.1);
                let sum = |a: f64, b: f64, c: f64, d: f64| h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
                return (x + sum(k1.0, k2.0, k3.0, k4.0), v + sum(k1.1, k2.1, k3.1, k4.1));
            }
            integrator::DISCRETE => v + h * (-k * x - b * v - h * k * v) / (m + h * b + h * h * k),
            // Implicit in damping, explicit in stiffness.
            _ => v + h * (-k * x - b * v) / (m + h * b),
        };
        (x + h * v1, v1)
    }

    /// The exact state after a step, from the series of the matrix exponential. `None` if the step is long.
    fn exact_state(&self) -> Option<(f64, f64)> {
        let Oscillator { mass: m, stiffness: k, damping: b, timestep: h, x, v } = *self;
        let (mut sum, mut term) = ((x, v), (x, v));
        for n in 1..40 {
            let f = h / f64::from(n);
            term = (f * term.1, f * (-k * term.0 - b * term.1) / m);
            sum = (sum.0 + term.0, sum.1 + term.1);
        }
        (h * (k / m).sqrt() < 0.5 && h * b / m < 0.5).then_some(sum)
    }

    fn check(&self, method: &Method) -> Result<(), TestCaseError> {
        let Oscillator { mass, stiffness, damping, timestep, x, v } = *self;
        let m = compile(&format!(
            "<mujoco><option gravity='0 0 0'/><worldbody><body>
             <joint type='slide' axis='0 0 1' stiffness='{stiffness}' damping='{damping}'/>
             <geom size='0.1' mass='{mass}'/></body></worldbody></mujoco>"
        ))
        .unwrap();
        let d = end(&m, method, timestep, 1, |d| (d.edit().qpos[0], d.edit().qvel[0]) = (x, v));
        if method.order > 4.0 {
            // The error of a step of length h is about hᵖ⁺¹/(p+1)!, in the units of the motion.
            let Some((x1, v1)) = self.exact_state() else { return Ok(()) };
            let length = timestep * (stiffness / mass).sqrt().max(damping / mass);
            let small = ROUNDING + length.powf(method.order + 1.0) / 1e3;
            let scale = 1.0 + v1.abs() + (stiffness / mass).sqrt();
            prop_assert!((d.qpos[0] - x1).abs() <= small * scale, "{}: {} {x1}", method.id, d.qpos[0]);
            prop_assert!((d.qvel[0] - v1).abs() <= small * scale, "{}: {} {v1}", method.id, d.qvel[0]);
            return Ok(());
        }
        let (x1, v1) = self.step(method.id);
        let scale = 1.0 + v1.abs();
        prop_assert!((d.qpos[0] - x1).abs() <= ROUNDING * scale, "{}: {} {x1}", method.id, d.qpos[0]);
        prop_assert!((d.qvel[0] - v1).abs() <= ROUNDING * scale, "{}: {} {v1}", method.id, d.qvel[0]);
        prop_assert_eq!(d.time, timestep);
        Ok(())
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 100, ..ProptestConfig::default() })]

    #[test]
    fn one_step_of_an_oscillator(o in an_oscillator()) {
        for method in &METHODS {
            o.check(method)?;
        }
    }

    /// Gravity alone: the parabola, or the sum of rectangles that a first-order method computes instead.
    #[test]
    fn free_fall(h in 1e-4..0.02f64, steps in 1usize..50, v in -2.0..2.0f64) {
        let m = compile("<mujoco><worldbody><body><freejoint/><geom size='0.1'/></body></worldbody></mujoco>").unwrap();
        for method in &METHODS {
            let d = end(&m, method, h, steps, |d| d.edit().qvel[2] = v);
            let t = h * steps as f64;
            let late = if method.order > 1.0 { 0.0 } else { h };
            let height = v * t - 0.5 * 9.81 * t * (t + late);
            prop_assert!((d.qpos[2] - height).abs() <= ROUNDING, "{}: {} {height}", method.id, d.qpos[2]);
            prop_assert!((d.qvel[2] - (v - 9.81 * t)).abs() <= ROUNDING);
        }
    }

    /// Rotation about a principal axis continues, and a scene at rest without forces stays at rest, bit for bit.
    #[test]
    fn principal_rotations_continue_and_scenes_at_rest_stay(scene in scene(), numbers in numbers(), spin in -20.0..20.0f64) {
        let top = compile(
            "<mujoco><option gravity='0 0 0'/><worldbody><body><freejoint/><geom pos='0.1 0 0' size='0.1'/>
             <geom pos='-0.1 0 0' size='0.1'/></body></worldbody></mujoco>",
        ).unwrap();
        let m = compile(&scene.floating()).unwrap();
        for method in &METHODS {
            let d = end(&top, method, 5e-3, 40, |d| d.edit().qvel[5] = spin);
            prop_assert!((d.qvel[5] - spin).abs() <= ROUNDING * 20.0, "{}: {:?}", method.id, d.qvel);
            let still = end(&m, method, 5e-3, 3, |d| core::integrate_pos(&m, d.edit().qpos, &vec![0.0; m.nv], 1.0).unwrap());
            let start = Data::new(&m);
            let springs = m.jnt_stiffness.iter().any(|&k| k != 0.0);
            prop_assert!(springs || distance(&still, &start) == 0.0, "{}: {:?}", method.id, still.qvel);
            prop_assert_eq!(end(&m, method, 2e-3, 3, |d| scatter(&m, d, &numbers)), end(&m, method, 2e-3, 3, |d| scatter(&m, d, &numbers)));
        }
    }

    /// For any tree, with springs and dampers, no method converges more slowly than its order, and quaternions keep their
    /// norm.
    #[test]
    fn no_tree_converges_more_slowly(scene in scene(), numbers in numbers()) {
        let m = compile(&scene.smooth()).unwrap();
        let scalar = m.jnt_type.iter().all(|&t| t == joint::HINGE || t == joint::SLIDE);
        for method in &METHODS {
            let expected = if scalar { method.order } else { method.order_in_space };
            let mut seen = Vec::new();
            // For fast motions, for which the step is too long, shorter steps are tried.
            let right = (0..5).any(|k| {
                let h = 1e-3 * 0.5f64.powi(k);
                let order = observed_order(&m, method, h, 0.016, |d| scatter(&m, d, &numbers));
                seen.push(order);
                order.is_none_or(|p| p > expected - 0.4)
            });
            prop_assert!(right, "integrator {}: orders {seen:?}, not {expected}", method.id);
            let d = end(&m, method, 2e-3, 20, |d| scatter(&m, d, &numbers));
            for j in (0..m.njnt).filter(|&j| m.jnt_type[j] == joint::FREE || m.jnt_type[j] == joint::BALL) {
                let at = m.jnt_qposadr[j] as usize + if m.jnt_type[j] == joint::FREE { 3 } else { 0 };
                let length = d.qpos[at..at + 4].iter().map(|x| x * x).sum::<f64>().sqrt();
                prop_assert!((length - 1.0).abs() <= 1e-15 * 8.0, "{length}");
            }
        }
    }
}
