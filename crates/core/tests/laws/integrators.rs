//! One suite that every integrator passes: closed forms of one step, and the observed order of convergence.

use crate::definitions::*;
use crate::scenes::scene;
use labspec_core::xml::compile;
use labspec_core::{self as core, Data, Model, integrator, joint};
use proptest::prelude::*;

/// An integrator, the order of its error, and its order where bodies turn in space: Runge and Kutta's method combines
/// slopes of rotations as if they commuted.
struct Method {
    id: i32,
    order: f64,
    order_in_space: f64,
}

const METHODS: [Method; 5] = [
    Method { id: integrator::EULER, order: 1.0, order_in_space: 1.0 },
    Method { id: integrator::RK4, order: 4.0, order_in_space: 2.0 },
    Method { id: integrator::IMPLICIT, order: 1.0, order_in_space: 1.0 },
    Method { id: integrator::IMPLICITFAST, order: 1.0, order_in_space: 1.0 },
    Method { id: integrator::DISCRETE, order: 1.0, order_in_space: 1.0 },
];

/// The state after `steps` of length `h` from a state that `begin` sets.
fn end(m: &Model, method: &Method, h: f64, steps: usize, begin: impl Fn(&mut Data)) -> Data {
    let mut m = m.clone();
    (*m.edit().opt.timestep, *m.edit().opt.integrator) = (h, method.id);
    let mut d = Data::new(&m);
    begin(&mut d);
    (0..steps).for_each(|_| core::step(&m, &mut d).unwrap());
    d
}

fn apart(a: &Data, b: &Data) -> f64 {
    let differences = a.qpos.iter().zip(&b.qpos).chain(a.qvel.iter().zip(&b.qvel));
    differences.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// The order that three runs show, each with half the step of the one before: the ratio of their differences, base 2.
/// `None` when only rounding is left.
fn observed_order(m: &Model, method: &Method, h: f64, time: f64, begin: impl Fn(&mut Data)) -> Option<f64> {
    let run = |k: usize| end(m, method, h / k as f64, k * (time / h).round() as usize, &begin);
    let [coarse, middle, fine] = [run(1), run(2), run(4)];
    let (first, second) = (apart(&coarse, &middle), apart(&middle, &fine));
    (second > 1e-12).then(|| (first / second).log2())
}

/// A cart with a two-link arm: springs, dampers, oblique axes, nothing that turns in space.
const ARM: &str = "<mujoco><worldbody><body pos='0 0 1'>
    <joint type='slide' axis='1 0.2 0' stiffness='20' damping='0.5'/><geom size='0.1' mass='2'/>
    <body pos='0 0 -0.1'><joint axis='0 1 0.3' damping='0.05'/><geom pos='0.02 0 -0.3' size='0.05' mass='1'/>
    <body pos='0 0 -0.4'><joint axis='0.5 1 0' stiffness='1' springref='20'/><geom pos='0 0.05 -0.2' size='0.05' mass='0.5'/>
    </body></body></body></worldbody></mujoco>";

/// A body that tumbles freely with a pendulum on a ball joint.
const TUMBLER: &str = "<mujoco><worldbody><body pos='0 0 1'>
    <freejoint/><geom pos='0.1 0 0' size='0.1' mass='1'/><geom pos='-0.2 0.1 0' size='0.05' mass='0.5'/><geom pos='0 0.1 0.1' size='0.05' mass='0.3'/>
    <body pos='0.2 0 0'><joint type='ball' damping='0.02' stiffness='0.5'/><geom pos='0.1 0.1 -0.2' size='0.05' mass='0.4'/>
    <geom pos='-0.1 0.1 0' size='0.05' mass='0.2'/></body></body></worldbody></mujoco>";

#[test]
fn orders_of_convergence() {
    let arm = compile(ARM).unwrap();
    let tumbler = compile(TUMBLER).unwrap();
    for method in &METHODS {
        let push =
            |d: &mut Data| d.edit().qvel.iter_mut().enumerate().for_each(|(i, v)| *v = 0.8 - 0.3 * i as f64);
        let order = observed_order(&arm, method, 4e-3, 0.16, push).unwrap();
        assert!((order - method.order).abs() < 0.15, "integrator {}: order {order}", method.id);
        let order = observed_order(&tumbler, method, 4e-3, 0.16, push).unwrap();
        assert!(
            (order - method.order_in_space).abs() < 0.15,
            "integrator {}: order {order} in space",
            method.id
        );
    }
}

/// A mass on a spring with a damper, somewhere in its motion.
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
    /// x and v after one step: the definition of each method.
    fn step(&self, id: i32) -> (f64, f64) {
        let Oscillator { mass: m, stiffness: k, damping: b, timestep: h, x, v } = *self;
        let v1 = match id {
            integrator::RK4 => {
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

    fn check(&self, method: &Method) -> Result<(), TestCaseError> {
        let Oscillator { mass, stiffness, damping, timestep, x, v } = *self;
        let m = compile(&format!(
            "<mujoco><option gravity='0 0 0'/><worldbody><body>
             <joint type='slide' axis='0 0 1' stiffness='{stiffness}' damping='{damping}'/>
             <geom size='0.1' mass='{mass}'/></body></worldbody></mujoco>"
        ))
        .unwrap();
        let d = end(&m, method, timestep, 1, |d| (d.edit().qpos[0], d.edit().qvel[0]) = (x, v));
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

    /// Gravity alone: the parabola, or the sum of rectangles that a first-order method makes of it.
    #[test]
    fn free_fall(h in 1e-4..0.02f64, steps in 1usize..50, v in -2.0..2.0f64) {
        let m = compile("<mujoco><worldbody><body><freejoint/><geom size='0.1'/></body></worldbody></mujoco>").unwrap();
        for method in &METHODS {
            let d = end(&m, method, h, steps, |d| d.edit().qvel[2] = v);
            let t = h * steps as f64;
            let late = if method.id == integrator::RK4 { 0.0 } else { h };
            let height = v * t - 0.5 * 9.81 * t * (t + late);
            prop_assert!((d.qpos[2] - height).abs() <= ROUNDING, "{}: {} {height}", method.id, d.qpos[2]);
            prop_assert!((d.qvel[2] - (v - 9.81 * t)).abs() <= ROUNDING);
        }
    }

    /// Spin about a principal axis goes on, and what is at rest without forces stays there to the bit.
    #[test]
    fn what_keeps_moving_and_what_rests(scene in scene(), numbers in numbers(), spin in -20.0..20.0f64) {
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
            prop_assert!(springs || apart(&still, &start) == 0.0, "{}: {:?}", method.id, still.qvel);
            prop_assert_eq!(end(&m, method, 2e-3, 3, |d| scatter(&m, d, &numbers)), end(&m, method, 2e-3, 3, |d| scatter(&m, d, &numbers)));
        }
    }

    /// On any tree, with springs and dampers, no method converges more slowly than its order, and quaternions keep their
    /// length.
    #[test]
    fn no_tree_converges_more_slowly(scene in scene(), numbers in numbers()) {
        let m = compile(&scene.smooth()).unwrap();
        let scalar = m.jnt_type.iter().all(|&t| t == joint::HINGE || t == joint::SLIDE);
        for method in &METHODS {
            let expected = if scalar { method.order } else { method.order_in_space };
            let mut seen = Vec::new();
            // Fast motions, for which the step is long, are left to shorter ones.
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
