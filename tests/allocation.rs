//! The step loop does not allocate after warm-up, and neither do numeric programs.
//!
//! Warm-up is one run of the same kind: vectors of contacts and constraint rows grow to the size that the scene needs, and keep
//! their capacity over a reset.

#![allow(clippy::unwrap_used)]

use crate::support::{compile, model, model_text, workspace};
use crate::zoo::animals;
use allocation_counter::measure;
use labspec::bind::{ControlProgram, Programs};
use labspec::lint::ModelFolder;
use labspec::lint::load_lesson;
use labspec::run::{Cell, Samples, Session, Start};
use labspec::source::SourceFile;
use labspec_core::reflect::{FieldSet, Object, field};
use labspec_core::{self as core, AccessSet, Data, Model, Plan, Planned, integrator};
use labspec_expr::Value;
use serde_json::json;
use std::fmt::Write;

/// An access set that reads only the coordinates.
fn coordinates() -> AccessSet {
    let mut access = AccessSet { reads: FieldSet::EMPTY, writes: FieldSet::EMPTY };
    access.reads.insert(field(Object::Data, "qpos").unwrap());
    access
}

/// Steps a model from its start, once to warm up and once to count allocations: with the full pipeline, with a plan for any
/// access, and with a plan for the coordinates.
fn check_allocations(name: &str, m: &Model, steps: usize) {
    for plan in [Plan::full(), Plan::new(m, &AccessSet::ANY), Plan::new(m, &coordinates())] {
        let mut d = Data::planned(m, plan);
        let mut contacts = 0;
        let start = |d: &mut Data<Planned>| match m.keys().next() {
            Some(key) => core::reset_data_keyframe(m, d, key).unwrap(),
            None => core::reset_data(m, d).unwrap(),
        };
        let mut run = |d: &mut Data<Planned>| {
            for _ in 0..steps {
                core::step(m, d).unwrap();
                contacts = contacts.max(d.fields().nefc);
            }
            core::forward(m, d).unwrap();
        };
        start(&mut d);
        run(&mut d);
        start(&mut d);
        let count = measure(|| run(&mut d));
        assert_eq!((count.count_total, count.bytes_total), (0, 0), "{name}, {contacts} rows at most");
    }
}

/// Models with every kind of sensor.
#[test]
fn sensors() {
    for name in ["frames", "contacts", "cameras", "limits", "delays", "delays_rk4"] {
        let file = workspace().join(format!("crates/core/src/api/golden/{name}.xml"));
        check_allocations(name, &compile(&std::fs::read_to_string(file).unwrap()), 100);
    }
}

#[test]
fn flight() {
    check_allocations("free fall", &model("free_fall"), 500);
    check_allocations("tumbling", &model("spin"), 500);
}

/// In flight, at the impact, and at rest.
#[test]
fn drop_onto_a_floor() {
    check_allocations("ball drop", &model("ball_drop"), 1500);
}

/// The first impact of a scene may allocate; later steps may not.
#[test]
fn rest_after_the_first_impact() {
    let m = model("ball_drop");
    let mut d = Data::new(&m);
    while d.nefc == 0 {
        core::step(&m, &mut d).unwrap();
    }
    let count = measure(|| (0..1000).for_each(|_| core::step(&m, &mut d).unwrap()));
    assert_eq!(count.count_total, 0);
}

#[test]
fn limits() {
    check_allocations("limits", &model("limits"), 800);
    let limited = model_text("double_pendulum").replace("type=\"hinge\"", "type=\"hinge\" range=\"-40 40\"");
    check_allocations("double pendulum with limits", &compile(&limited), 800);
}

#[test]
fn thirty_spheres_on_a_plane() {
    let mut xml = String::from("<mujoco><worldbody><geom type='plane' size='2 2 1'/>");
    for i in 0..30 {
        // Leaning columns of three spheres in contact, which fall over and roll into each other.
        let (x, y, z) = (f64::from(i / 3 % 5), f64::from(i / 15), f64::from(i % 3));
        let [x, y, z] = [0.079 * x, 0.079 * y + 0.01 * z, 0.04 + 0.079 * z];
        let _ = write!(
            xml,
            "<body pos='{x} {y} {z}'><freejoint/><geom size='0.04' mass='0.2' friction='0.6'/></body>"
        );
    }
    xml.push_str("</worldbody></mujoco>");
    let m = compile(&xml);
    let mut d = Data::new(&m);
    let most = (0..300).map(|_| {
        core::step(&m, &mut d).unwrap();
        d.ncon
    });
    assert!(most.max().unwrap() >= 40, "the pile is meant to touch");
    check_allocations("thirty spheres", &m, 300);
}

#[test]
fn trees_that_fall_asleep_and_wake() {
    for name in ["sleep", "sleep_pile", "sleep_ties"] {
        check_allocations(name, &model(name), 300);
    }
}

/// Boxes that do not touch each other: four times as many need four times the memory, not sixteen times.
#[test]
fn memory_of_a_thousand_boxes() {
    let bytes = |n: usize| {
        let mut xml = String::from("<mujoco><worldbody><geom type='plane' size='2 2 1'/>");
        for i in 0..n {
            let (x, y) = (0.5 * (i % 32) as f64, 0.5 * (i / 32) as f64);
            let _ = write!(
                xml,
                "<body pos='{x} {y} 0.0995'><freejoint/><geom type='box' size='0.1 0.1 0.1'/></body>"
            );
        }
        let m = compile(&(xml + "</worldbody></mujoco>"));
        let count = measure(|| {
            let mut d = Data::planned(&m, Plan::new(&m, &coordinates()));
            core::step(&m, &mut d).unwrap();
            core::step(&m, &mut d).unwrap();
            assert_eq!(d.fields().nisland, n);
        });
        count.bytes_max
    };
    let (few, many) = (bytes(250), bytes(1000));
    assert!(many < 5 * few && many < 20 << 20, "{few} and {many} bytes");
}

#[test]
fn runge_kutta() {
    for name in ["double_pendulum", "tree", "stack", "mocap"] {
        let mut m = model(name);
        *m.edit().opt.integrator = integrator::RK4;
        check_allocations(name, &m, 300);
    }
}

#[test]
fn every_integrator_with_everything_in_the_zoo() {
    for (name, m, _) in animals() {
        for id in integrator::EULER..=integrator::DISCRETE {
            let mut m = m.clone();
            *m.edit().opt.integrator = id;
            check_allocations(&format!("{name}, integrator {id}"), &m, 5);
        }
    }
}

/// As `reflect::allocate_data` promises, memory is allocated only the first time.
#[test]
fn reset() {
    let m = model("ball_drop");
    let mut d = Data::new(&m);
    assert_eq!(measure(|| core::reset_data(&m, &mut d).unwrap()).count_total, 0);
}

/// A non-finite number resets the data during a step.
#[test]
fn automatic_reset() {
    let mut m = model("ball_drop");
    m.edit().opt.gravity[2] = -1e12;
    check_allocations("a simulation that breaks", &m, 50);
}

#[test]
fn programs_of_numbers() {
    let lab = json!({
        "xml": model_text("ball_drop"),
        "controller": "data.xfrc_applied[8] = 0.1 * Math.sin(3 * data.time) - 0.2 * data.joint('heavy_free').qvel[2]; ctx.peak = Math.max(ctx.peak || 0, data.qpos[2])",
        "controls": [{"label": "push", "set": "data.qfrc_applied[2]", "min": -1, "max": 1, "value": 0}],
        "plots": [{"traces": [
            {"label": "height", "expr": "1000 * (data.qpos[2] - (1 - 0.5 * 9.81 * data.time ** 2))"},
            {"label": "peak", "expr": "ctx.peak > 0.5 ? ctx.peak : data.body('heavy').xpos[2]"},
            {"label": "touching", "expr": "data.ncon > 0 && data.qpos[9] < 0.06"}
        ]}],
        "readouts": [{"label": "force", "expr": "lib.normalForce('floor')"}]
    });
    let lesson = load_lesson(SourceFile::new("lab.json", lab.to_string()), &ModelFolder::unknown());
    let lab = lesson.all_labs()[0];
    let m = compile(&lab.xml.as_ref().unwrap().value);
    let mut findings = Vec::new();
    let programs = Programs::compile(lab, &m, &mut findings);
    assert_eq!(findings, []);
    let mut session = Session::start(&programs, &m, Start::default());
    let run = |session: &mut Session<'_>| {
        for _ in 0..600 {
            session.step();
        }
    };
    run(&mut session);
    session.reset();
    // Monitoring of energy growth, in a lab whose programs only read.
    let still =
        json!({"xml": model_text("ball_drop"), "readouts": [{"label": "height", "expr": "data.qpos[2]"}]});
    let quiet = load_lesson(SourceFile::new("still.json", still.to_string()), &ModelFolder::unknown());
    let quiet = Programs::compile(quiet.all_labs()[0], &m, &mut findings);
    let mut watched = Session::start(&quiet, &m, Start::default());
    watched.watch();
    run(&mut watched);
    assert_eq!(measure(|| run(&mut watched)).count_total, 0, "a step of a run that is watched");
    // The controller and the step.
    assert_eq!(measure(|| run(&mut session)).count_total, 0, "a step with a controller");
    // Each trace and readout separately.
    for probe in &programs.probes {
        let bound = probe.bound.as_ref().unwrap();
        session.evaluate(&bound.program, &bound.text);
        let mut value = None;
        let count = measure(|| value = session.evaluate(&bound.program, &bound.text));
        assert!(value.is_some(), "{}", probe.name);
        assert_eq!(count.count_total, 0, "{}", probe.name);
    }
    // All of them, sampled as in a run: by columns of the elements that they read, if they depend only on these.
    let mut samples = Samples::new(&programs, 20);
    assert_eq!(
        samples.columns(),
        (2, 4),
        "the height and whether they touch, of time, ncon and two coordinates"
    );
    let count = measure(|| (0..20).for_each(|_| samples.take(&mut session).unwrap()));
    assert_eq!(count.count_total, 0, "samples");
    let rows = samples.rows();
    for (i, probe) in programs.probes.iter().enumerate() {
        let bound = probe.bound.as_ref().unwrap();
        let value = session.evaluate(&bound.program, &bound.text).unwrap();
        assert_eq!(rows[19][i + 1], Cell::from(value), "{}", probe.name);
    }
    // The assignment of a slider.
    let (_, ControlProgram::Change(..)) = &programs.controls[0] else { panic!("a slider changes something") };
    let count = measure(|| session.set_control(0, Value::Number(0.5)));
    assert_eq!(count.count_total, 0, "a slider");
}
