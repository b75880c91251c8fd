//! Conservation laws: energy, momentum, and reversibility.

use crate::definitions::*;
use crate::scenes::scene;
use labspec_core::xml::compile;
use labspec_core::{self as core, Data, Model, integrator, joint};
use proptest::prelude::*;

/// A run of `steps` steps of length `h` with the Runge–Kutta method from a random state.
fn run(m: &Model, start: &[f64], h: f64, steps: usize) -> (Model, Data, Data) {
    let mut m = m.clone();
    (*m.edit().opt.timestep, *m.edit().opt.integrator) = (h, integrator::RK4);
    let mut d = Data::new(&m);
    scatter(&m, &mut d, start);
    core::forward(&m, &mut d).unwrap();
    let before = d.clone();
    (0..steps).for_each(|_| core::step(&m, &mut d).unwrap());
    core::forward(&m, &mut d).unwrap();
    (m, before, d)
}

/// The largest change of an invariant over a short run.
fn drift(m: &Model, start: &[f64], h: f64, steps: usize, invariants: fn(&Model, &Data) -> Vec<f64>) -> f64 {
    let (m, before, after) = run(m, start, h, steps);
    largest_difference(&invariants(&m, &before), &invariants(&m, &after))
}

/// The distance from the initial state after a motion whose velocity is reversed halfway.
fn return_distance(m: &Model, start: &[f64], h: f64, steps: usize) -> f64 {
    let (m, before, mut d) = run(m, start, h, steps);
    d.edit().qvel.iter_mut().for_each(|v| *v = -*v);
    (0..steps).for_each(|_| core::step(&m, &mut d).unwrap());
    d.edit().qvel.iter_mut().for_each(|v| *v = -*v);
    largest_difference(&before.qpos, &d.qpos).max(largest_difference(&before.qvel, &d.qvel))
}

fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

fn energy(_: &Model, d: &Data) -> Vec<f64> {
    vec![d.energy[0] + d.energy[1]]
}

fn all_momentum(m: &Model, d: &Data) -> Vec<f64> {
    momentum(m, d).to_vec()
}

/// The factor by which an error must decrease when the step is halved. The Runge–Kutta method has order four: a factor of 16, or
/// 12 to allow for the next order. For rotations in space, it combines the slopes as if rotations commuted, which is correct to
/// second order only: a factor of 4, or 3 with tolerance.
fn gain(m: &Model) -> f64 {
    let scalar = m.jnt_type.iter().all(|&t| t == joint::HINGE || t == joint::SLIDE);
    if scalar { 12.0 } else { 3.0 }
}

/// Checks that the error of a run decreases according to the order of the method, or is at the level of rounding. For fast
/// motions, for which the step is too long, shorter steps are tried.
fn shrinks(m: &Model, error: impl Fn(f64, usize) -> f64) -> Result<(), String> {
    let rounding = 1e-10;
    let mut h: f64 = 2e-3;
    let mut seen = Vec::new();
    for _ in 0..5 {
        let steps = (0.032 / h).round() as usize;
        let (coarse, fine) = (error(h, steps), error(h / 2.0, 2 * steps));
        if fine <= rounding || fine <= coarse / gain(m) {
            return Ok(());
        }
        seen.push((h, coarse, fine));
        h /= 2.0;
    }
    Err(format!("timestep, error, error with half of it: {seen:?}"))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 100, max_shrink_iters: 300, ..ProptestConfig::default() })]

    #[test]
    fn energy_is_conserved_to_the_order_of_the_integrator(scene in scene(), numbers in numbers()) {
        let m = compile(&scene.conservative()).unwrap();
        let result = shrinks(&m, |h, n| drift(&m, &numbers, h, n, energy));
        prop_assert!(result.is_ok(), "{result:?}");
    }

    #[test]
    fn momentum_of_floating_trees_is_conserved(scene in scene(), numbers in numbers()) {
        let m = compile(&scene.floating()).unwrap();
        let result = shrinks(&m, |h, n| drift(&m, &numbers, h, n, all_momentum));
        prop_assert!(result.is_ok(), "{result:?}");
    }

    #[test]
    fn a_frictionless_motion_is_reversible(scene in scene(), numbers in numbers()) {
        let m = compile(&scene.conservative()).unwrap();
        let result = shrinks(&m, |h, n| return_distance(&m, &numbers, h, n));
        prop_assert!(result.is_ok(), "{result:?}");
    }
}
