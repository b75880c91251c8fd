//! The stages that a plan keeps are computed and measured, those that it leaves out compute nothing, and each has a reason.

#![allow(clippy::unwrap_used)]

use crate::plan::{data_fields, field, reading};
use crate::support::{compile, model, model_text};
use labspec_core::reflect::{FieldId, Object, Stage, View};
use labspec_core::{self as core, Data, Model, Plan, Planned, enable};
use std::fmt::Write;
use std::sync::atomic::{AtomicU64, Ordering};

/// A clock between the stages records exactly the stages that the plan keeps, in every pass, including those within a
/// Runge–Kutta step. The work that it finds equals that of the engine, except for a constant per pass.
#[test]
fn a_clock_measures_the_stages_of_the_plan() {
    fn tick() -> u64 {
        static NOW: AtomicU64 = AtomicU64::new(0);
        NOW.fetch_add(1, Ordering::Relaxed)
    }
    for (name, passes) in [("ball_drop", 1), ("pendulum", 1), ("everything", 1), ("double_pendulum", 4)] {
        let mut m = model(name);
        if passes == 4 {
            *m.edit().opt.integrator = core::integrator::RK4;
        }
        let mut d = Data::planned(&m, Plan::new(&m, &reading(&["qpos", "sensordata"])));
        core::clock(&mut d, tick);
        let before = core::cost(&d);
        for _ in 0..10 {
            core::step(&m, &mut d).unwrap();
        }
        let (mut work, stage_times) = (0, core::stage_times(&mut d));
        for decision in d.plan().decisions() {
            let stage_time = stage_times.stage_time(decision.stage);
            work += stage_time.work;
            // Sensor stages are not evaluated in passes within a step.
            let displayed = matches!(decision.stage, Stage::Sensors | Stage::SubtreeVel | Stage::RnePost);
            let least = if displayed { 10 } else { 10 * passes };
            assert_eq!(
                decision.keep,
                stage_time.runs >= least,
                "{name}: {:?} ran {} times",
                decision.stage,
                stage_time.runs
            );
            assert!(
                stage_time.time >= stage_time.runs && (decision.keep || stage_time.runs == 0),
                "{name}: {:?}",
                decision.stage
            );
        }
        assert!(
            stage_times.nothing.runs >= 20 * passes
                && stage_times.between.runs + 1 == stage_times.nothing.runs,
            "{stage_times:?}"
        );
        assert_eq!(core::stage_times(&mut d), core::StageTimes::default());
        assert_eq!(core::cost(&d) - before, work + 10 * passes * core::cost_of_pass(&d), "{name}");
    }
}

/// A sensor that is not read is not evaluated, nor are the stages that only it needs; reading it is an error.
#[test]
fn sensors_that_nobody_reads_are_left_out() {
    let m = compile(
        "<mujoco><worldbody><body><joint axis='0 1 0'/><geom size='.1' pos='1 0 0'/><site name='s' pos='1 0 0'/></body></worldbody>
         <sensor><clock name='clock'/><accelerometer name='pulled' site='s'/></sensor></mujoco>",
    );
    let (data, name) = (field(Object::Data, "sensordata"), |name: &str| m.sensor(name).unwrap());
    for (read, left, stage) in [("clock", "pulled", false), ("pulled", "clock", true)] {
        let mut access = reading(&[]);
        let places = name(read).values(&m);
        access.reads.insert_elements(data, places.start, Some(places.len()));
        let plan = Plan::new(&m, &access);
        assert!(plan.evaluates(&m, name(read)) && !plan.evaluates(&m, name(left)));
        assert_eq!(plan.keeps(Stage::RnePost), stage);
        let mut d = Data::planned(&m, plan);
        core::step(&m, &mut d).unwrap();
        core::step(&m, &mut d).unwrap();
        let value = |of: &str| name(of).values(&m).map(|i| core::element(&m, &d, data, i).unwrap().abs());
        assert!(value(read).sum::<f64>() > 0.0 && value(left).sum::<f64>() == 0.0, "{read}");
        assert!(d.get("sensordata").is_err());
    }
    let plan = Plan::new(&m, &reading(&["sensordata"]));
    assert!(plan.evaluates(&m, name("clock")) && plan.evaluates(&m, name("pulled")));
}

/// Fields of a stage that is left out keep the values of the last reset.
fn keeps_reset_value(f: FieldId, d: &Data<Planned>, m: &Model, before: &Data<Planned>) -> bool {
    assert!(d.read(f).is_err(), "{} was left out, and can be read", f.info().name);
    let n = core::length(m, d, f);
    let element = |d, i| core::element(m, d, f, i).map(f64::to_bits);
    n == core::length(m, before, f) && (0..n).all(|i| element(d, i) == element(before, i))
}

#[test]
fn omitted_stages_are_not_computed() {
    let fixed = [
        ("free_fall", &["qpos"][..]),
        ("ball_drop", &["qpos"]),
        ("pendulum", &["qpos"]),
        ("double_pendulum", &["qpos"]),
        ("spin", &["qvel"]),
        ("stack", &["ncon"]),
        ("everything", &["qpos"]),
    ];
    let mut omitted = 0;
    for (name, reads) in fixed {
        let m = model(name);
        let plan = Plan::new(&m, &reading(reads));
        let mut d = Data::planned(&m, plan.clone());
        let before = d.clone();
        for _ in 0..20 {
            core::step(&m, &mut d).unwrap();
        }
        for decision in plan.decisions().iter().filter(|x| !x.keep) {
            omitted += 1;
            assert!(!plan.keeps(decision.stage));
            for f in data_fields().into_iter().filter(|f| f.info().stage == decision.stage) {
                // Without constraints, the acceleration is set although the solver does not run.
                if f.info().name != "qacc" {
                    assert!(
                        keeps_reset_value(f, &d, &m, &before),
                        "{name}: {:?} wrote {}",
                        decision.stage,
                        f.info().name
                    );
                }
            }
        }
    }
    // Free fall alone leaves out everything except the sum of forces.
    assert!(omitted > 30, "{omitted}");
}

#[test]
fn the_full_plan_keeps_everything() {
    let plan = Plan::full();
    assert!(plan.decisions().iter().all(|d| d.keep && plan.keeps(d.stage)));
    assert!(!plan.keeps(Stage::Compile) && !plan.keeps(Stage::User));
}

/// Enabling energy during a run requires the poses on which it depends.
#[test]
fn a_plan_keeps_the_stages_that_a_written_flag_may_enable() {
    let m = compile(&model_text("free_fall"));
    let mut access = reading(&["energy", "qpos"]);
    assert!(!Plan::new(&m, &access).keeps(Stage::Energy));
    access.writes.insert(field(Object::Option, "enableflags"));
    let any = Plan::for_any_value(&m, &access);
    assert!(any.keeps(Stage::Energy) && any.keeps(Stage::Kinematics));
    let plan = Plan::new(&m, &access);
    assert!(!plan.keeps(Stage::Energy));
    let mut d = Data::planned(&m, plan);
    let mut m = m;
    m.set_enabled(enable::ENERGY, true);
    core::forward(&m, &mut d).unwrap();
    assert!(d.plan().keeps(Stage::Energy) && d.plan().keeps(Stage::Kinematics));
    let f = field(Object::Data, "energy");
    assert!(matches!(core::view(&m, &d, f), Ok(View::F64(&[p, k])) if (p - 9.81).abs() < 1e-12 && k == 0.0));
}

#[test]
fn decisions_read_as_reasons() {
    let mut output = String::new();
    for (name, reads) in [
        ("free_fall", &["qpos"][..]),
        ("free_fall", &["qpos", "xpos"]),
        ("ball_drop", &["qpos", "ncon"]),
        ("ball_drop", &["sensordata"]),
        ("pendulum", &["qpos", "energy"]),
        ("mocap", &["xpos"]),
    ] {
        let _ = writeln!(output, "{name}, reading {}", reads.join(", "));
        for d in Plan::new(&model(name), &reading(reads)).decisions() {
            let verb = if d.keep { "keep" } else { "leave" };
            let _ = writeln!(output, "  {verb:<5} {:<12} {}", format!("{:?}", d.stage), d.reason);
        }
        output.push('\n');
    }
    insta::with_settings!({prepend_module_to_snapshot => false, omit_expression => true}, {
        insta::assert_snapshot!("plan-decisions", output);
    });
}
