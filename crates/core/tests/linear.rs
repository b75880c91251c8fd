//! The feature `nalgebra`: poses, velocities, Jacobians, M and the linearization of a step, compared with the results of MuJoCo
//! 3.14.0 (`tests/golden/linear.py`), with closed forms, with the functions on plain arrays, and with laws.
//!
//!     cargo test -p labspec-core --features nalgebra --test linear

// A panic is the report of a failed test.
#![allow(clippy::panic, clippy::unwrap_used)]
#![allow(clippy::too_many_lines, reason = "a test is one sequence of steps")]

use labspec_core::nalgebra::{self as algebra, FiniteDifferences, Transition, transition_fd};
use labspec_core::{self as core, AccessSet, Data, Error, Integrator, Model, Plan, reflect};
use nalgebra::{DMatrix, DVector, Matrix3, Point3, Rotation3, Vector3};
use serde_json::Value;
use std::path::Path;

#[path = "../examples/upright.rs"]
mod upright;

fn workspace(path: &str) -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(path)
}

fn largest<'a>(list: impl IntoIterator<Item = &'a f64>) -> f64 {
    list.into_iter().fold(0.0, |most, x| most.max(x.abs()))
}

fn near(computed: &DMatrix<f64>, recorded_matrix: &DMatrix<f64>, tolerance: f64, what: &str) {
    assert_eq!(computed.shape(), recorded_matrix.shape(), "{what}");
    let difference = largest(&(computed - recorded_matrix));
    assert!(difference <= tolerance, "{what} differs by {difference:e}:\n{computed}{recorded_matrix}");
}

/// A free body, a ball joint on a hinge, and a slide: every kind of joint, rotated and moving.
const TREE: &str = "<mujoco><worldbody>
  <body name='free' pos='1 2 3'><freejoint/><geom name='box' type='box' size='.1 .2 .3' pos='.1 0 .2' euler='10 20 30'/>
   <site name='corner' pos='.1 .2 .3' euler='40 0 10'/>
   <body name='fin' pos='.3 .1 0' euler='0 30 0'><joint axis='1 1 0'/><geom size='.1' pos='.2 0 0'/></body></body>
  <body name='arm' pos='-1 0 1'><joint axis='0 1 0' armature='.2'/><geom type='capsule' size='.05' fromto='0 0 0 .5 0 0'/>
   <body name='hand' pos='.5 0 0'><joint type='ball'/><geom type='box' size='.1 .05 .02' pos='.1 0 0'/>
    <body name='drawer' pos='.2 .1 0'><joint type='slide' axis='0 1 1'/><geom size='.05'/></body></body></body>
 </worldbody></mujoco>";

/// The tree, in a state without zeros.
fn tree() -> (Model, Data) {
    let model = Model::from_xml(TREE).unwrap();
    let mut data = Data::new(&model);
    let turn: Vec<f64> = (0..model.nv).map(|k| (1.0 + k as f64).sin()).collect();
    let mut qpos = data.qpos.clone();
    core::integrate_pos(&model, &mut qpos, &turn, 0.8).unwrap();
    data.edit().qpos.copy_from_slice(&qpos);
    data.edit().qvel.iter_mut().enumerate().for_each(|(k, v)| *v = (2.0 + 3.0 * k as f64).cos());
    core::forward(&model, &mut data).unwrap();
    (model, data)
}

#[test]
fn linearizations_are_those_of_mujoco() {
    let text = std::fs::read_to_string(workspace("tests/golden/linear.json")).unwrap();
    let cases: Vec<Value> = serde_json::from_str(&text).unwrap();
    assert_eq!(cases.len(), 8);
    for case in &cases {
        let numbers = |key: &str| -> Vec<f64> {
            case[key].as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect()
        };
        let name = case["model"].as_str().unwrap();
        let mut model = Model::from_file(workspace(&format!("specs/models/{name}.xml"))).unwrap();
        model.set_integrator(Integrator::Euler);
        *model.edit().opt.tolerance = 0.0;
        let mut data = Data::new(&model);
        let edit = data.edit();
        edit.qpos.copy_from_slice(&numbers("qpos"));
        edit.qvel.copy_from_slice(&numbers("qvel"));
        edit.act.copy_from_slice(&numbers("act"));
        edit.ctrl.copy_from_slice(&numbers("ctrl"));
        edit.qacc_warmstart.copy_from_slice(&numbers("qacc_warmstart"));
        core::forward(&model, &mut data).unwrap();

        let n = 2 * model.nv + model.na;
        let recorded = |key: &str, r, c| DMatrix::from_row_slice(r, c, &numbers(key));
        let check = |computed: &DMatrix<f64>, key: &str, tolerance: f64| {
            let recorded_matrix = recorded(key, computed.nrows(), computed.ncols());
            println!("{name} {key}: {:.1e}", largest(&(computed - &recorded_matrix)));
            near(computed, &recorded_matrix, tolerance, &format!("{name}: {key}"));
        };
        let body = model.bodies().nth(case["body"].as_u64().unwrap() as usize).unwrap();
        let point = Point3::from_slice(&numbers("point"));
        check(&algebra::full_m(&model, &data).unwrap(), "full_m", 1e-10);
        let of_body = algebra::jac_body(&model, &data, &body).unwrap();
        check(&of_body.translation, "jac_body_p", 1e-10);
        check(&of_body.rotation, "jac_body_r", 1e-10);
        let of_point = algebra::jac(&model, &data, point, &body).unwrap();
        check(&of_point.translation, "jac_p", 1e-10);
        check(&of_point.rotation, "jac_r", 1e-10);
        let before = data.clone();
        for (centered, scheme) in [(false, "forward"), (true, "centered")] {
            let eps = case["eps"].as_f64().unwrap();
            let how = FiniteDifferences { eps, centered, sensors: true };
            let computed = transition_fd(&model, &data, &how).unwrap();
            let (nu, ns) = (model.nu, model.nsensordata);
            let shapes = [(n, n), (n, nu), (ns, n), (ns, nu)];
            for ((matrix, shape), key) in [&computed.a, &computed.b, &computed.c, &computed.d]
                .into_iter()
                .zip(shapes)
                .zip("abcd".chars())
            {
                assert_eq!(matrix.shape(), shape);
                let key = format!("{key}_{scheme}");
                if matrix.nrows() == n {
                    check(matrix, &key, 1e-6);
                    continue;
                }
                // A sensor value of 5e4 has a rounding error of 7e-12: divided by `eps`, 7e-6. MuJoCo's D has the opposite sign
                // if the differences are centered: for a motor without a gear, whose force is its control, D = 1 with forward
                // differences, and -1 with centered ones.
                let sign = if key == "d_centered" { -1.0 } else { 1.0 };
                let recorded_matrix = recorded(&key, shape.0, shape.1) * sign;
                for (row, value) in data.sensordata.iter().enumerate() {
                    let difference = largest(&(matrix.row(row) - recorded_matrix.row(row)));
                    let tolerance = 1e-6 + 2.0 * f64::EPSILON * value.abs() / eps;
                    assert!(difference <= tolerance, "{name}: {key}, row {row} differs by {difference:e}");
                }
                println!("{name} {key}: {:.1e}", largest(&(matrix - recorded_matrix)));
            }
            let fewer = transition_fd(&model, &data, &FiniteDifferences { sensors: false, ..how }).unwrap();
            assert_eq!((fewer.c.nrows(), fewer.d.nrows()), (0, 0));
            assert_eq!((fewer.a, fewer.b), (computed.a, computed.b));
        }
        assert!(data == before, "the data of {name} have changed");
    }
}

/// A mass of 2 kg on a spring and a damper, with a motor and a filtered actuator. The damper is implicit.
const SPRING: &str = "<mujoco><option timestep='0.01' gravity='0 0 0'/><worldbody>
  <body><joint name='x' type='slide' stiffness='30' damping='4'/><geom size='.1' mass='2'/></body></worldbody>
  <actuator><motor joint='x' gear='3'/>
   <general joint='x' dyntype='filter' dynprm='0.5' gainprm='7' biastype='none'/></actuator>
  <sensor><jointpos joint='x'/><actuatorfrc actuator='0'/></sensor></mujoco>";

#[test]
fn a_mass_on_a_spring_with_a_damper() {
    let model = Model::from_xml(
        &SPRING.replace("actuator='0'", "actuator='push'").replace("<motor ", "<motor name='push' "),
    )
    .unwrap();
    let mut data = Data::new(&model);
    let edit = data.edit();
    (edit.qpos[0], edit.qvel[0], edit.act[0]) = (0.3, -0.7, 0.4);
    (edit.ctrl[0], edit.ctrl[1]) = (0.2, -0.1);
    let (h, k, c, gear, gain, tau) = (0.01, 30.0, 4.0, 3.0, 7.0, 0.5);
    // (m + h c) (v⁺ - v) = h (-k x - c v + gear u₀ + gain w), x⁺ = x + h v⁺, w⁺ = w + h (u₁ - w)/τ.
    let m = 2.0 + h * c;
    let v = [-h * k / m, 1.0 - h * c / m, h * gain / m];
    let a = DMatrix::from_row_slice(
        3,
        3,
        &[1.0 + h * v[0], h * v[1], h * v[2], v[0], v[1], v[2], 0.0, 0.0, 1.0 - h / tau],
    );
    let b = DMatrix::from_row_slice(3, 2, &[h * h * gear / m, 0.0, h * gear / m, 0.0, 0.0, h / tau]);
    let all = FiniteDifferences { sensors: true, ..FiniteDifferences::default() };
    let computed = transition_fd(&model, &data, &all).unwrap();
    near(&computed.a, &a, 1e-9, "A");
    near(&computed.b, &b, 1e-9, "B");
    near(&computed.c, &DMatrix::from_row_slice(2, 3, &[1.0, 0.0, 0.0, 0.0, 0.0, 0.0]), 1e-9, "C");
    near(&computed.d, &DMatrix::from_row_slice(2, 2, &[0.0, 0.0, 1.0, 0.0]), 1e-9, "D");
    // The map is linear: the matrices give the next state.
    let state = |d: &Data| DVector::from_vec(vec![d.qpos[0], d.qvel[0], d.act[0]]);
    let expected = &computed.a * state(&data) + &computed.b * data.field_vector("ctrl").unwrap();
    core::step(&model, &mut data).unwrap();
    assert!(largest(&(expected - state(&data))) < 1e-9);
}

#[test]
fn a_pendulum() {
    let mut model = Model::from_xml(
        "<mujoco><option timestep='0.01'/><worldbody><body><joint axis='0 1 0'/>
         <inertial pos='0 0 -0.5' mass='2' diaginertia='.02 .03 .02'/></body></worldbody></mujoco>",
    )
    .unwrap();
    let (h, angle, rate) = (0.01, 0.8, 1.5);
    // I θ'' = -m g l sin θ.
    let stiffness = 2.0 * 9.81 * 0.5 / (2.0 * 0.25 + 0.03) * f64::cos(angle);
    let mut data = Data::new(&model);
    (data.edit().qpos[0], data.edit().qvel[0]) = (angle, rate);
    let euler = DMatrix::from_row_slice(2, 2, &[1.0 - h * h * stiffness, h, -h * stiffness, 1.0]);
    near(&transition_fd(&model, &data, &FiniteDifferences::default()).unwrap().a, &euler, 1e-9, "Euler");
    let forward = FiniteDifferences { centered: false, ..FiniteDifferences::default() };
    near(&transition_fd(&model, &data, &forward).unwrap().a, &euler, 1e-6, "Euler, forward");
    // At the bottom and at rest, a Runge–Kutta step is the matrix exponential up to the fourth power of h.
    model.set_integrator(Integrator::RK4);
    let rest = Data::new(&model);
    let flow = DMatrix::from_row_slice(2, 2, &[0.0, h, -h * 2.0 * 9.81 * 0.5 / 0.53, 0.0]);
    let (mut sum, mut term) = (DMatrix::identity(2, 2), DMatrix::identity(2, 2));
    for order in 1..=4 {
        term = &term * &flow / f64::from(order);
        sum += &term;
    }
    near(&transition_fd(&model, &rest, &FiniteDifferences::default()).unwrap().a, &sum, 1e-9, "RK4");
}

/// A ball that rotates without gravity: in its own axes, a difference of orientations rotates back by the angle of the step.
#[test]
fn a_spinning_ball_turns_its_tangent_space() {
    let model = Model::from_xml(
        "<mujoco><option timestep='0.02' gravity='0 0 0'/>
         <worldbody><body name='ball'><freejoint/><geom size='.1'/></body></worldbody></mujoco>",
    )
    .unwrap();
    let mut data = Data::new(&model);
    let spin = Vector3::new(3.0, -2.0, 5.0);
    data.edit().qvel[3..].copy_from_slice(spin.as_slice());
    let Transition { a, b, .. } = transition_fd(&model, &data, &FiniteDifferences::default()).unwrap();
    assert_eq!((a.shape(), b.shape()), ((12, 12), (12, 0)));
    let turn = Rotation3::from_scaled_axis(-0.02 * spin).into_inner();
    near(
        &DMatrix::from(a.view((3, 3), (3, 3))),
        &DMatrix::from_fn(3, 3, |r, c| turn[(r, c)]),
        1e-9,
        "rotation",
    );
    near(&DMatrix::from(a.view((0, 6), (3, 3))), &(DMatrix::identity(3, 3) * 0.02), 1e-9, "x by v");
    near(&DMatrix::from(a.view((6, 6), (6, 6))), &DMatrix::identity(6, 6), 1e-9, "velocity");
}

#[test]
fn controls_at_and_beyond_the_ends_of_their_ranges() {
    let text = SPRING
        .replace("gear='3'", "gear='3' ctrlrange='-1 1'")
        .replace("<sensor><jointpos joint='x'/><actuatorfrc actuator='0'/></sensor>", "");
    let model = Model::from_xml(&text).unwrap();
    let slope = 0.01 * 3.0 / 2.04;
    for (ctrl, expected) in
        [(0.0, slope), (1.0, slope), (-1.0, slope), (1.0 - 5e-7, slope), (1.5, 0.0), (-1.5, 0.0)]
    {
        for centered in [false, true] {
            let mut data = Data::new(&model);
            data.edit().ctrl[0] = ctrl;
            let how = FiniteDifferences { centered, ..FiniteDifferences::default() };
            let found = transition_fd(&model, &data, &how).unwrap().b[(1, 0)];
            assert!((found - expected).abs() < 1e-9, "{ctrl} {centered}: {found}");
        }
    }
    let wide = FiniteDifferences { eps: 3.0, ..FiniteDifferences::default() };
    let error = transition_fd(&model, &Data::new(&model), &wide).unwrap_err();
    assert!(error.to_string().contains("smaller than the range"), "{error}");
}

#[test]
fn the_mass_matrix_is_symmetric_and_positive() {
    let (model, data) = tree();
    let mass = algebra::full_m(&model, &data).unwrap();
    assert_eq!(mass, mass.transpose());
    assert_eq!(mass.transpose().as_slice(), core::full_m(&model, &data).unwrap());
    let lowest = mass.clone().symmetric_eigenvalues().min();
    assert!(lowest > 0.0, "{lowest}");
    let b = DVector::from_fn(model.nv, |k, _| (k as f64).cos());
    let x = algebra::solve_m(&model, &data, &b).unwrap();
    let direct = mass.clone().cholesky().unwrap().solve(&b);
    assert!(largest(&(&mass * &x - &b)) < 1e-12 && largest(&(&x - direct)) < 1e-10 * largest(&x));
    assert!(matches!(
        algebra::solve_m(&model, &data, &DVector::zeros(1)),
        Err(Error::Length { found: 1, .. })
    ));
    // The kinetic energy is ½ vᵀ M v.
    let v = data.field_vector("qvel").unwrap();
    let mut copy = data.clone();
    core::energy_vel(&model, &mut copy).unwrap();
    let energy = 0.5 * (v.transpose() * &mass * v)[0];
    assert!((energy - copy.energy[1]).abs() < 1e-12 * energy);
}

#[test]
fn jacobians_give_the_velocities_of_points() {
    let (model, data) = tree();
    let v = data.field_vector("qvel").unwrap();
    let check = |j: &algebra::PointJacobian, velocity: algebra::Velocity, what: &str| {
        assert_eq!(j.translation.shape(), (3, model.nv));
        let (linear, angular) = (&j.translation * v, &j.rotation * v);
        assert!(largest(&(linear - velocity.linear)) < 1e-12, "{what}");
        assert!(largest(&(angular - velocity.angular)) < 1e-12, "{what}");
    };
    for body in model.bodies() {
        let velocity = algebra::body_velocity(&model, &data, &body, false).unwrap();
        check(&algebra::jac_body(&model, &data, &body).unwrap(), velocity, "a body");
        let plain = core::object_velocity(&model, &data, core::Obj::XBody, body.index(), false).unwrap();
        assert_eq!(velocity.to_vector6().as_slice(), plain);
        // The same velocity in the axes of the body.
        let local = algebra::body_velocity(&model, &data, &body, true).unwrap();
        let pose = data.body_pose(&body).unwrap();
        assert!((pose.rotation * local.linear - velocity.linear).norm() < 1e-12);
        // A point of the body moves with v + ω × r.
        let point = pose * Point3::new(0.3, -0.2, 0.1);
        let of_point = algebra::jac(&model, &data, point, &body).unwrap();
        let arm = point - Point3::from(pose.translation.vector);
        let linear = velocity.linear + velocity.angular.cross(&arm);
        check(&of_point, algebra::Velocity { linear, ..velocity }, "a point");
        let centre = Point3::from(data.body_inertial_pose(&body).unwrap().translation.vector);
        let of_centre = algebra::jac_body_com(&model, &data, &body).unwrap();
        assert_eq!(of_centre, algebra::jac(&model, &data, centre, &body).unwrap());
    }
    let geom = algebra::geom_velocity(&model, &data, "box", false).unwrap();
    check(&algebra::jac_geom(&model, &data, "box").unwrap(), geom, "a geom");
    let site = algebra::site_velocity(&model, &data, "corner", false).unwrap();
    check(&algebra::jac_site(&model, &data, "corner").unwrap(), site, "a site");
    // Σ m J of the bodies is the total mass times the Jacobian of the centre of mass.
    let bodies = model.bodies().skip(1);
    let sum: DMatrix<f64> = bodies
        .map(|b| algebra::jac_body_com(&model, &data, &b).unwrap().translation * model.body_mass[b.index()])
        .sum();
    let mass: f64 = model.body_mass.iter().sum();
    let whole = algebra::jac_subtree_com(&model, &data, "world").unwrap();
    near(&(whole * mass), &sum, 1e-10, "subtree");
}

/// J̇ is the finite difference of two Jacobians that are separated by a short time.
#[test]
fn the_derivative_of_a_jacobian() {
    let (model, data) = tree();
    let local = Point3::new(0.3, -0.2, 0.1);
    let at = |time: f64| {
        let mut moved = data.clone();
        let mut qpos = data.qpos.clone();
        core::integrate_pos(&model, &mut qpos, &data.qvel, time).unwrap();
        moved.edit().qpos.copy_from_slice(&qpos);
        core::forward(&model, &mut moved).unwrap();
        let point = moved.body_pose("hand").unwrap() * local;
        algebra::jac(&model, &moved, point, "hand").unwrap().translation
    };
    let point = data.body_pose("hand").unwrap() * local;
    let dot = algebra::jac_dot(&model, &data, point, "hand").unwrap();
    near(&dot.translation, &((at(1e-5) - at(-1e-5)) / 2e-5), 1e-8, "J̇");
}

#[test]
fn poses_are_rotations_and_those_of_the_engine() {
    let (model, data) = tree();
    let matrix = |rows: [[f64; 3]; 3]| Matrix3::from_fn(|r, c| rows[r][c]);
    let check = |pose: nalgebra::Isometry3<f64>, at: [f64; 3], rows: [[f64; 3]; 3]| {
        assert_eq!(pose.translation.vector.as_slice(), at);
        let rotation = pose.rotation.to_rotation_matrix().into_inner();
        assert!((rotation - matrix(rows)).norm() < 1e-14);
        assert!((rotation * rotation.transpose() - Matrix3::identity()).norm() < 1e-14);
        assert!((rotation.determinant() - 1.0).abs() < 1e-14);
    };
    for id in model.bodies() {
        let body = data.body(&id).unwrap();
        check(data.body_pose(&id).unwrap(), body.xpos(), body.xmat());
        check(data.body_inertial_pose(&id).unwrap(), body.xipos(), body.ximat());
    }
    for id in model.geoms() {
        let geom = data.geom(&id).unwrap();
        check(data.geom_pose(&id).unwrap(), geom.xpos(), geom.xmat());
    }
    let site = data.site("corner").unwrap();
    check(data.site_pose("corner").unwrap(), site.xpos(), site.xmat());
    assert!(matches!(data.body_pose("fre"), Err(Error::NoName { .. })));
    let error = Data::new(&model).body_pose("free").unwrap_err();
    assert!(error.to_string().contains("call `forward`"), "{error}");
}

#[test]
fn fields_are_seen_without_a_copy() {
    let (model, data) = tree();
    let rows = data.field_matrix("xpos").unwrap();
    assert_eq!(rows.shape(), (model.nbody, 3));
    assert!(std::ptr::eq(&raw const rows[(0, 0)], &raw const data.xpos[0]));
    for body in model.bodies() {
        assert_eq!(
            rows.row(body.index()).iter().copied().collect::<Vec<_>>(),
            data.body(&body).unwrap().xpos()
        );
    }
    let qvel = data.field_vector("qvel").unwrap();
    assert!(std::ptr::eq(qvel.as_slice(), data.qvel.as_slice()));
    for field in reflect::fields().filter(|f| f.info().object == reflect::Object::Data) {
        let name = field.info().name;
        match data.field_matrix(name) {
            Ok(matrix) => assert_eq!(matrix.len(), data.field_vector(name).unwrap().len(), "{name}"),
            Err(e) => assert!(field.info().elem != reflect::Elem::F64, "{name}: {e}"),
        }
    }
    assert!(matches!(data.field_vector("xpo"), Err(Error::NoField(_))));
    let error = data.field_vector("ncon").unwrap_err();
    assert_eq!(error.to_string(), "ncon must be a field of floating-point numbers");
}

#[test]
fn omitted_fields_are_errors_and_kept_fields_are_equal() {
    let text = SPRING.replace("actuator='0'", "actuator='push'").replace("<motor ", "<motor name='push' ");
    let model = Model::from_xml(&text).unwrap();
    let mut access = AccessSet { reads: Default::default(), writes: Default::default() };
    access.reads.insert(reflect::field(reflect::Object::Data, "qpos").unwrap());
    let planned = Data::planned(&model, Plan::new(&model, &access));
    let assert_omitted = |e: Error| assert!(matches!(e, Error::LeftOut { .. }), "{e}");
    assert_omitted(planned.body_pose(&model.bodies().next().unwrap()).unwrap_err());
    assert_omitted(planned.field_matrix("xpos").unwrap_err());
    assert_omitted(algebra::full_m(&model, &planned).unwrap_err());
    assert_omitted(algebra::jac_body(&model, &planned, "world").unwrap_err());
    assert_omitted(algebra::body_velocity(&model, &planned, "world", false).unwrap_err());
    let all = FiniteDifferences { sensors: true, ..FiniteDifferences::default() };
    assert_omitted(transition_fd(&model, &planned, &all).unwrap_err());
    let how = FiniteDifferences::default();
    let full = transition_fd(&model, &Data::new(&model), &how).unwrap();
    assert_eq!(transition_fd(&model, &planned, &how).unwrap(), full);
}

#[test]
fn errors_of_a_linearization() {
    let (model, data) = tree();
    let error_of = |data: &Data, eps: f64| {
        let how = FiniteDifferences { eps, ..FiniteDifferences::default() };
        transition_fd(&model, data, &how).unwrap_err().to_string()
    };
    assert_eq!(error_of(&data, 0.0), "`eps` of finite differences must be above zero");
    assert_eq!(error_of(&data, f64::NAN), "`eps` of finite differences must be above zero");
    let mut bad = data.clone();
    bad.edit().qvel[2] = 1e11;
    assert!(error_of(&bad, 1e-6).contains("must be finite"));
    let mut spent = data.clone();
    core::limit(&mut spent, 1);
    assert!(error_of(&spent, 1e-6).contains("work limit"));
    let (other, _) = tree();
    assert!(matches!(transition_fd(&other, &data, &FiniteDifferences::default()), Err(Error::ForeignData)));
}

#[test]
fn a_tree_that_sleeps_is_not_linearized() {
    let model = Model::from_xml(
        "<mujoco><option gravity='0 0 0'><flag sleep='enable'/></option>
         <worldbody><body><joint type='slide' damping='1'/><geom size='.1'/></body></worldbody></mujoco>",
    )
    .unwrap();
    let mut data = Data::new(&model);
    (0..50).for_each(|_| core::step(&model, &mut data).unwrap());
    assert!(data.tree_asleep[0] >= 0);
    let error = transition_fd(&model, &data, &FiniteDifferences::default()).unwrap_err();
    assert!(error.to_string().contains("awake"), "{error}");
}

/// The example runs, and the guide contains its code and its output.
#[test]
fn the_example_of_the_guide() {
    upright::main().unwrap();
    let printed = upright::upright().unwrap();
    let guide = std::fs::read_to_string(workspace("docs/embedding.md")).unwrap();
    let code = std::fs::read_to_string(workspace("crates/core/examples/upright.rs")).unwrap();
    assert!(guide.contains(&format!("```rust\n{code}```")), "docs/embedding.md shows another upright.rs");
    assert!(
        guide.contains(&format!("```text\n{printed}```")),
        "docs/embedding.md shows another output:\n{printed}"
    );
}
