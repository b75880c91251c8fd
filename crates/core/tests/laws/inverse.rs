//! Inverse dynamics inverts forward dynamics, and is linear in accelerations.

use crate::definitions::*;
use crate::scenes::scene;
use labspec_core::xml::compile;
use labspec_core::{self as core, Data, disable};
use nalgebra::DVector;
use proptest::prelude::*;

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, ..ProptestConfig::default() })]

    /// inverse(forward(f)) = f for applied forces and actuator forces, with springs, dampers and fluid forces, and with
    /// constraints disabled.
    #[test]
    fn inverse_dynamics_finds_the_forces(scene in scene(), numbers in numbers()) {
        let mut m = compile(&scene.xml()).unwrap();
        m.set_disabled(disable::CONSTRAINT, true);
        // The discrete integrator solves couplings by tendons iteratively, to this tolerance.
        *m.edit().opt.tolerance = 1e-15;
        let mut d = Data::new(&m);
        scatter(&m, &mut d, &numbers);
        for i in 0..m.nv {
            d.edit().qfrc_applied[i] = numbers[(7 * i) % numbers.len()];
        }
        core::forward(&m, &mut d).unwrap();
        let [applied, actuators] = [&d.qfrc_applied, &d.qfrc_actuator].map(|f| DVector::from_column_slice(f));
        let (force, mass) = (applied + actuators, full_m(&m, &d));
        core::inverse(&m, &mut d).unwrap();
        let found = DVector::from_column_slice(&d.qfrc_inverse);
        let scale = (mass.amax() * DVector::from_column_slice(&d.qacc).amax()).max(1.0);
        prop_assert!((&found - &force).amax() <= 1e-11 * scale, "{found}{force}");
    }

    /// rne(a) - rne(0) = M a, without the armature of joints: it is linear in a.
    #[test]
    fn newton_and_euler_are_linear_in_the_acceleration(scene in scene(), numbers in numbers(), s in -3.0..3.0f64) {
        let mut m = compile(&scene.conservative()).unwrap();
        m.edit().dof_armature.fill(0.0);
        let mut d = Data::unplanned(&m);
        scatter(&m, &mut d, &numbers);
        core::forward(&m, &mut d).unwrap();
        let a: Vec<f64> = (0..m.nv).map(|i| numbers[(5 * i + 1) % numbers.len()]).collect();
        let b: Vec<f64> = (0..m.nv).map(|i| numbers[(3 * i + 2) % numbers.len()]).collect();
        let mut rne = |a: Option<&[f64]>| {
            DVector::from_vec(core::rne(&m, &mut d, a).unwrap())
        };
        let sum: Vec<f64> = a.iter().zip(&b).map(|(a, b)| a + s * b).collect();
        let (bias, of_a, of_b, of_sum) = (rne(None), rne(Some(&a)), rne(Some(&b)), rne(Some(&sum)));
        let scale = of_a.amax().max(of_b.amax()).max(bias.amax()).max(1.0);
        let difference = (&of_sum - &bias) - (&of_a - &bias) - s * (&of_b - &bias);
        prop_assert!(difference.amax() <= 20.0 * ROUNDING * scale, "{difference}");
        let m_a = mass_matrix(&m, &d) * DVector::from_column_slice(&a);
        prop_assert!((&of_a - &bias - &m_a).amax() <= 20.0 * ROUNDING * scale.max(m_a.amax()), "{of_a}{bias}{m_a}");
    }
}
