//! Sensors compared with MuJoCo 3.14.0, recorded by `golden/record.py`.

use crate::math::rows;
use crate::mjcf;
use crate::model::reflect::{self, Object, View, ViewMut};
use crate::model::{Fields, Model};
use crate::step::forward::forward;
use crate::step::workspace::Workspace;

/// A recorded line: a name and its numbers.
fn parse(line: &str) -> (&str, Vec<f64>) {
    let mut words = line.split_ascii_whitespace();
    (words.next().unwrap_or(""), words.map(|w| w.parse().unwrap()).collect())
}

fn compile(xml: &str) -> Model {
    mjcf::compile_only(xml, &crate::source::files::NoFiles).unwrap_or_else(|list| {
        panic!("{}", list.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))
    })
}

fn numbers(m: &Model, d: &Fields, object: Object, name: &str) -> Vec<f64> {
    let view: View = reflect::view(m, d, reflect::field(object, name).unwrap());
    (0..view.len()).filter_map(|i| view.get(i)).collect()
}

/// The largest difference, relative to the largest magnitude (at least 1), with its index.
fn difference(got: &[f64], expected: &[f64]) -> (f64, usize) {
    let scale = expected.iter().fold(1.0_f64, |s, x| s.max(x.abs()));
    let scaled_error = |(i, (a, b)): (usize, (&f64, &f64))| ((a - b).abs() / scale, i);
    got.iter()
        .zip(expected)
        .enumerate()
        .map(scaled_error)
        .fold((0.0, 0), |a, b| if b.0 > a.0 { b } else { a })
}

/// The name and index of the sensor that a value belongs to.
fn sensor(m: &Model, value: usize) -> String {
    let s = (0..m.nsensor).rfind(|&s| m.sensor_adr[s] as usize <= value && m.sensor_dim[s] > 0).unwrap();
    format!("{} {s}", crate::sensor::for_sensor(m, s).name)
}

/// Constants of cameras and lights, which are written to the model here; tests of the compiler compare them.
const OPTICS: [&str; 15] = [
    "cam_mode",
    "cam_bodyid",
    "cam_targetbodyid",
    "cam_pos",
    "cam_quat",
    "cam_projection",
    "cam_fovy",
    "cam_resolution",
    "cam_sensorsize",
    "cam_intrinsic",
    "light_mode",
    "light_bodyid",
    "light_targetbodyid",
    "light_pos",
    "light_dir",
];

/// Compares all recorded constants and states of a model with a tolerance. Recorded inputs are written instead.
fn check_recorded(xml: &str, recorded: &str, tolerance: f64) {
    let mut m = compile(xml);
    let Workspace { fields: mut d, scratch: mut s } = Workspace::new(&m);
    let mut wrong = Vec::new();
    let (mut state, mut computed, mut stepped) = (-1, false, false);
    for line in recorded.lines() {
        let (name, mut expected) = parse(line);
        if name == "step" {
            crate::step::step(&m, &mut d, &mut s);
            stepped = true;
            continue;
        }
        if name == "state" {
            crate::step::reset::reset_data(&m, &mut d, &mut s);
            (state, computed, stepped) = (state + 1, false, false);
            continue;
        }
        let (object, field) = name.split_once('.').map_or((Object::Data, name), |(_, f)| (Object::Model, f));
        let id = reflect::field(object, field).unwrap();
        let input = id.info().kind != reflect::Kind::Derived && object == Object::Data && !stepped;
        if input {
            match reflect::view_data_mut(&mut d, id) {
                ViewMut::F64(v) => v.copy_from_slice(&expected),
                _ => panic!("{name} has no real numbers"),
            }
            continue;
        }
        if object == Object::Data && !computed {
            forward(&m, &mut d, &mut s);
            computed = true;
        }
        if OPTICS.contains(&field) {
            match reflect::view_model_mut(&mut m, id) {
                ViewMut::F64(v) => v.copy_from_slice(&expected),
                ViewMut::I32(v) => expected.iter().enumerate().for_each(|(i, &x)| v[i] = x as i32),
                _ => panic!("{name} has no numbers"),
            }
            crate::setup::setconst::set_const(&mut m, &mut d, &mut s);
            continue;
        }
        let got = numbers(&m, &d, object, field);
        assert_eq!(got.len(), expected.len(), "{name}: {got:?}");
        if name == "sensordata" {
            with_principal_points(&m, &mut expected);
        }
        let (error, index) = difference(&got, &expected);
        if error > tolerance {
            let sensor_name = if name == "sensordata" { sensor(&m, index) } else { String::new() };
            wrong.push(format!(
                "state {state} {name}[{index}] {sensor_name}: {} instead of {}",
                got[index], expected[index]
            ));
        }
    }
    assert_eq!(state, 7);
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Adds what MuJoCo ignores in projections: the image is shifted by the principal point of its camera, pixels.
fn with_principal_points(m: &Model, expected: &mut [f64]) {
    for s in 0..m.nsensor {
        let address = m.sensor_adr[s] as usize;
        if sensor(m, address).starts_with("camprojection") {
            let camera = m.sensor_refid[s] as usize;
            for axis in 0..2 {
                let size = m.cam_sensorsize[2 * camera + axis] as f32;
                let length = m.cam_intrinsic[4 * camera + 2 + axis] as f32;
                let pixels = m.cam_resolution[2 * camera + axis] as f32;
                expected[address + axis] -= if size == 0.0 { 0.0 } else { f64::from(length / size * pixels) };
            }
        }
    }
}

macro_rules! golden {
    ($($name:ident $tolerance:literal;)*) => { $(
        #[test]
        fn $name() {
            check_recorded(
                include_str!(concat!("golden/", stringify!($name), ".xml")),
                include_str!(concat!("golden/", stringify!($name), ".txt")),
                $tolerance,
            );
        }
    )* };
}
golden! {
    cameras 1e-12;
    frames 1e-12;
    limits 1e-10;
    tendons 1e-12;
    contacts 1e-9;
    delays 1e-12;
    delays_rk4 1e-12;
}

/// Forces of constraints on bodies. The rows, with their types and forces, are written to the data, so that the test
/// does not depend on the solver.
#[test]
fn equality_constraints_act_where_they_hold() {
    let m = compile(include_str!("golden/equality.xml"));
    let Workspace { fields: mut d, scratch: mut s } = Workspace::new(&m);
    let mut wrong = Vec::new();
    let mut rows = 0;
    for line in include_str!("golden/equality.txt").lines() {
        let (name, expected) = parse(line);
        let int = || expected.iter().map(|&x| x as i32).collect::<Vec<_>>();
        match name {
            "state" => crate::step::reset::reset_data(&m, &mut d, &mut s),
            "rows.qacc" => {
                forward(&m, &mut d, &mut s);
                d.qacc.copy_from_slice(&expected);
            }
            "rows.efc_type" => (d.efc_type, d.nefc) = (int(), expected.len()),
            "rows.efc_id" => d.efc_id = int(),
            "rows.efc_force" => {
                d.efc_force = expected;
                rows += d.nefc;
                crate::sensor::body_force::rne_post_constraint(&m, &mut d);
                crate::sensor::evaluate(&m, &mut d, &mut s.sensor, crate::sensor::SensorStage::Acceleration);
            }
            "sensordata" | "cacc" | "cfrc_int" | "cfrc_ext" => {
                let got = numbers(&m, &d, Object::Data, name);
                let (error, index) = difference(&got, &expected);
                if error > 1e-12 {
                    wrong.push(format!("{name}[{index}]: {} instead of {}", got[index], expected[index]));
                }
            }
            _ if name.starts_with("model.") => {}
            _ => match reflect::view_data_mut(&mut d, reflect::field(Object::Data, name).unwrap()) {
                ViewMut::F64(v) => v.copy_from_slice(&expected),
                _ => panic!("{name} has no real numbers"),
            },
        }
    }
    assert!(rows > 8 * 25 && wrong.is_empty(), "{rows}\n{}", wrong.join("\n"));
}

#[test]
fn switched_off_sensors_keep_their_values() {
    let mut m = compile(
        "<mujoco><worldbody><body><freejoint/><geom size='1'/></body></worldbody><sensor><clock/><framelinacc objtype='body' objname='world'/></sensor></mujoco>",
    );
    let Workspace { fields: mut d, scratch: mut s } = Workspace::new(&m);
    d.time = 2.0;
    forward(&m, &mut d, &mut s);
    m.opt.disableflags |= crate::kinds::disable::SENSOR;
    d.time = 3.0;
    d.cacc.fill(5.0);
    forward(&m, &mut d, &mut s);
    assert_eq!(d.sensordata[0], 2.0);
    assert_eq!(rows::<6>(&d.cacc)[1], [5.0; 6]);
}
