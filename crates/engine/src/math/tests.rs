//! Laws of rotations and spatial vectors.

use super::*;
use proptest::prelude::*;

fn unit_quat() -> impl Strategy<Value = Quat> {
    prop::array::uniform4(-1.0f64..1.0)
        .prop_filter("not short", |q| dot(*q, *q) > 0.01)
        .prop_map(quat_normalize)
}

fn close(a: &[f64], b: &[f64]) -> bool {
    a.iter().zip(b).all(|(x, y)| (x - y).abs() < 1e-12 * (1.0 + x.abs()))
}

proptest! {
    #[test]
    fn rotating_by_quaternion_and_by_matrix_agree(q in unit_quat(), v in prop::array::uniform3(-2.0f64..2.0)) {
        prop_assert!(close(&rotate(v, q), &mat_mul_vec(&quat_to_mat(q), v)));
        prop_assert!(close(&mat_t_mul_vec(&quat_to_mat(q), rotate(v, q)), &v));
    }

    #[test]
    fn product_of_quaternions_is_composition(a in unit_quat(), b in unit_quat(), v in prop::array::uniform3(-2.0f64..2.0)) {
        prop_assert!(close(&rotate(v, quat_mul(a, b)), &rotate(rotate(v, b), a)));
    }

    #[test]
    fn integration_inverts_the_rotation_vector(q in unit_quat(), w in prop::array::uniform3(-1.0f64..1.0)) {
        let r = quat_to_vel(quat_mul(quat_conj(q), quat_integrate(q, w, 1.0)));
        prop_assert!(close(&r, &w));
    }

    #[test]
    fn momentum_is_power_dual(m in prop::array::uniform3(0.1f64..2.0), q in unit_quat(), d in prop::array::uniform3(-1.0f64..1.0),
                              mass in 0.1f64..5.0, a in prop::array::uniform6(-1.0f64..1.0), b in prop::array::uniform6(-1.0f64..1.0)) {
        // Symmetry of the inertia, and the derivative of a scalar product is zero: (v×a)·f + a·(v×*f) = 0.
        let i = inertia_about(m, &quat_to_mat(q), d, mass);
        prop_assert!((dot(a, inertia_mul(&i, &b)) - dot(b, inertia_mul(&i, &a))).abs() < 1e-12);
        let f = inertia_mul(&i, &b);
        prop_assert!((dot(cross_motion(&b, &a), f) + dot(a, cross_force(&b, &f))).abs() < 1e-11);
    }
}
