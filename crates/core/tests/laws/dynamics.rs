//! The mass matrix, forces and accelerations of one state.

use crate::definitions::*;
use crate::scenes::scene;
use labspec_core::xml::compile;
use labspec_core::{self as core, Data, integrator, joint};
use nalgebra::{DVector, Vector3};
use proptest::prelude::*;

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, ..ProptestConfig::default() })]

    #[test]
    fn the_mass_matrix_is_that_of_its_definition(scene in scene(), numbers in numbers()) {
        let m = compile(&scene.conservative()).unwrap();
        let mut d = Data::new(&m);
        scatter(&m, &mut d, &numbers);
        core::forward(&m, &mut d).unwrap();
        let computed = full_m(&m, &d);
        let expected = mass_matrix(&m, &d);
        let scale = expected.amax().max(1.0);
        prop_assert!((&computed - &expected).amax() <= ROUNDING * scale, "{computed}{expected}");
        prop_assert_eq!(&computed, &computed.transpose());
        // Positive definite: a Cholesky factor exists.
        prop_assert!(m.nv == 0 || computed.cholesky().is_some());
    }

    /// M a + bias = force, with the forces computed from their definitions; and the gravity part of the bias force.
    #[test]
    fn forces_and_accelerations_balance(scene in scene(), numbers in numbers()) {
        let mut m = compile(&scene.xml()).unwrap();
        if m.opt.integrator == integrator::DISCRETE {
            // Its acceleration belongs to a whole step.
            *m.edit().opt.integrator = integrator::EULER;
        }
        let mut d = Data::new(&m);
        scatter(&m, &mut d, &numbers);
        for i in 0..m.nv {
            d.edit().qfrc_applied[i] = numbers[(7 * i) % numbers.len()];
        }
        for i in 6..6 * m.nbody {
            d.edit().xfrc_applied[i] = numbers[(11 * i) % numbers.len()];
        }
        core::forward(&m, &mut d).unwrap();
        let vec = DVector::from_column_slice;
        let mut force =
            vec(&d.qfrc_passive) + vec(&d.qfrc_actuator) + vec(&d.qfrc_applied) + vec(&d.qfrc_constraint);
        for b in 1..m.nbody {
            let (move_, turn) = jacobian(&m, &d, b);
            force += move_.tr_mul(&vector(&d.xfrc_applied, 2 * b)) + turn.tr_mul(&vector(&d.xfrc_applied, 2 * b + 1));
        }
        let mass = full_m(&m, &d);
        let residual = &mass * vec(&d.qacc) + vec(&d.qfrc_bias) - &force;
        // The sum of the edge forces of a contact cannot be more accurate than these forces. On a body that can only rotate, a
        // contact may carry no weight, and edge forces of 1e17 N balance each other.
        let edges = vec(&d.efc_force).amax();
        let scale = (mass.amax() * vec(&d.qacc).amax()).max(force.amax()).max(edges).max(1.0);
        prop_assert!(residual.amax() <= 1e-10 * scale, "{residual}");

        d.edit().qvel.fill(0.0);
        core::forward(&m, &mut d).unwrap();
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
            core::step(&m, &mut d).unwrap();
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

    /// Without friction, a motion with reversed velocity has the same accelerations, because the bias force is quadratic in
    /// velocity.
    #[test]
    fn forces_of_motion_are_quadratic(scene in scene(), numbers in numbers()) {
        let m = compile(&scene.conservative()).unwrap();
        let mut d = Data::new(&m);
        scatter(&m, &mut d, &numbers);
        let velocity = d.qvel.clone();
        let mut bias = |factor: f64| {
            d.edit().qvel.iter_mut().zip(&velocity).for_each(|(v, v0)| *v = factor * v0);
            core::forward(&m, &mut d).unwrap();
            (DVector::from_column_slice(&d.qfrc_bias), DVector::from_column_slice(&d.qacc))
        };
        let ((there, a), (back, b), (rest, _), (twice, _)) = (bias(1.0), bias(-1.0), bias(0.0), bias(2.0));
        let close = |x: &DVector<f64>, y: &DVector<f64>| (x - y).amax() <= ROUNDING * x.amax().max(1.0);
        prop_assert!(close(&there, &back), "{there}{back}");
        prop_assert!(close(&a, &b), "{a}{b}");
        prop_assert!(close(&(&twice - &rest), &(4.0 * (&there - &rest))), "{twice}{there}{rest}");
    }

    /// The bias force is the force for zero acceleration: Σ Jᵀ m (J̇ v - g) + Jᵀ (I J̇ v + ω × I ω). J̇ v is computed
    /// as the finite difference of velocities shortly before and after.
    #[test]
    fn the_bias_force_is_that_of_its_definition(scene in scene(), numbers in numbers()) {
        let m = compile(&scene.conservative()).unwrap();
        let mut d = Data::new(&m);
        scatter(&m, &mut d, &numbers);
        core::forward(&m, &mut d).unwrap();
        let moment = 1e-5;
        let at = |time: f64| {
            let mut d = d.clone();
            let velocity = d.qvel.clone();
            core::integrate_pos(&m, d.edit().qpos, &velocity, time).unwrap();
            core::forward(&m, &mut d).unwrap();
            d
        };
        let (before, after) = (at(-moment), at(moment));
        let v = DVector::from_column_slice(&d.qvel);
        let mut expected = DVector::zeros(m.nv);
        for b in 1..m.nbody {
            let [(move0, turn0), (move1, turn1), (move_, turn)] = [&before, &after, &d].map(|d| jacobian(&m, d, b));
            let acceleration = (&move1 - &move0) * &v / (2.0 * moment) - Vector3::from(m.opt.gravity);
            let spin: Vector3<f64> = Vector3::from_iterator((&turn * &v).iter().copied());
            let change: Vector3<f64> = Vector3::from_iterator(((&turn1 - &turn0) * &v / (2.0 * moment)).iter().copied());
            let i = inertia(&m, &d, b);
            expected += m.body_mass[b] * move_.tr_mul(&acceleration) + turn.tr_mul(&(i * change + spin.cross(&(i * spin))));
        }
        let computed = DVector::from_column_slice(&d.qfrc_bias);
        // A finite difference over 1e-5 s of numbers that are accurate to 1e-16.
        prop_assert!((&computed - &expected).amax() <= 1e-8 * expected.amax().max(1.0), "{computed}{expected}");
    }
}
