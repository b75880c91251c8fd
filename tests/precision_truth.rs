//! `precision` compared with truths from other sources: events and final values of labs of twenty kinds from equations derived
//! by hand (`tests/golden/precision.py`), and tests of its recommendations, costs and orders.

#![allow(clippy::unwrap_used, clippy::panic)]

use crate::support::{for_each, read_json, workspace};
use labspec::bind::Programs;
use labspec::bind::scene::Models;
use labspec::lint::{ModelFolder, load_lesson};
use labspec::run::Integrator;
use labspec::run::{self, Cell, RunOptions, rounded};
use labspec::source::SourceFile;
use labspec::spec::{Lab, Lesson};
use labspec_core::{Model, integrator};
use labspec_numerics::precision::{
    AdviceKind, PrecisionOptions, PrecisionResults, PrecisionRow, RunStatus, compare,
};
use labspec_numerics::stability;
use serde_json::Value;
use std::path::PathBuf;
use std::sync::OnceLock;

fn kinds() -> PathBuf {
    workspace().join("tests/precision/kinds.md")
}

/// A lab in a separate lesson.
fn written(lab: &Value) -> Lesson {
    let text = format!("```lab simlab\n{lab}\n```\n");
    load_lesson(SourceFile::new("lab.md", text), &ModelFolder::unknown())
}

fn one(lesson: &Lesson) -> &Lab {
    lesson.addressed()[0].1
}

fn model(lab: &Lab) -> std::sync::Arc<Model> {
    Models::new(ModelFolder::unknown()).model_of_lab(lab, &mut Vec::new()).unwrap()
}

fn report(lab: &Lab, options: &PrecisionOptions) -> PrecisionResults {
    let model = model(lab);
    let mut findings = Vec::new();
    let programs = Programs::compile(lab, &model, &mut findings);
    compare(lab, &model, &programs, options, &mut findings, &mut |_| ()).unwrap()
}

/// The labs of `precision/kinds.md`, and the report of each with the default options: several tests read them.
fn reports_of_kinds() -> &'static (Lesson, Vec<PrecisionResults>) {
    static REPORTS: OnceLock<(Lesson, Vec<PrecisionResults>)> = OnceLock::new();
    REPORTS.get_or_init(|| {
        let lesson = load_lesson(SourceFile::read(&kinds()).unwrap(), &ModelFolder::unknown());
        let labs = lesson.addressed();
        let reports = for_each(labs.len(), |i| report(labs[i].1, &PrecisionOptions::default()));
        (lesson, reports)
    })
}

/// Each lab of `precision/kinds.md` with its report.
fn kinds_with_reports() -> Vec<(&'static Lab, &'static PrecisionResults)> {
    let (lesson, reports) = reports_of_kinds();
    lesson.addressed().into_iter().map(|(_, lab)| lab).zip(reports).collect()
}

/// The values of a trace or readout in a run with some numerics.
fn column(lab: &Lab, (id, timestep): (i32, f64), length: f64, label: &str) -> Vec<f64> {
    let mut model = Model::clone(&model(lab));
    (*model.edit().opt.timestep, *model.edit().opt.integrator) = (timestep, id);
    let programs = Programs::compile(lab, &model, &mut Vec::new());
    let options = RunOptions { until: Some(length), every: 1, ..RunOptions::default() };
    let table = run::run(lab, &model, &programs, &options).unwrap();
    let at = table.columns.iter().position(|c| c.ends_with(&format!("/{label}"))).unwrap();
    table.rows.iter().map(|row| if let Cell::Number(x) = row[at] { x } else { f64::NAN }).collect()
}

fn lab_row(report: &PrecisionResults) -> &PrecisionRow {
    report.rows.iter().find(|r| r.is_own).unwrap()
}

fn right(report: &PrecisionResults) -> &PrecisionRow {
    let advice = report.advice.iter().find(|a| a.kind == AdviceKind::Right).unwrap();
    &report.rows[advice.row]
}

/// A mass on a line, with additional options, joint attributes and actuators.
fn slider(options: &str, joint: &str, more: &str) -> String {
    format!(
        "<mujoco><option {options}/><worldbody><body><joint name='j' type='slide' axis='1 0 0' {joint}/>\
         <inertial pos='0 0 0' mass='1' diaginertia='1e-6 1e-6 1e-6'/></body></worldbody>{more}</mujoco>"
    )
}

fn trace(expression: &str) -> Value {
    serde_json::json!([{"traces": [{"label": "x (m)", "expr": expression}]}])
}

#[test]
fn events_and_ends_are_those_of_equations_by_hand() {
    let truth: Value = serde_json::from_str(include_str!("golden/precision.json")).unwrap();
    let labs = kinds_with_reports();
    assert_eq!(labs.len(), truth.as_object().unwrap().len());
    let (mut times, mut ends) = (0, 0);
    for (lab, report) in labs {
        let title = lab.title();
        let expected = &truth[title];
        assert!(!expected.is_null(), "{title}");
        for (name, time) in expected["events"].as_object().unwrap() {
            let time = time.as_f64().unwrap();
            let event = report.events.iter().find(|e| e.name == *name && e.time.is_finite());
            let Some(event) = event else { panic!("{title}: {name} at {time} is not found") };
            let off = (event.time - time).abs();
            assert!(off <= event.uncertain, "{title}: {name}: {off:e} off, ± {:e}", event.uncertain);
            assert!(event.uncertain < 1e-6, "{title}: {name}: ± {:e}", event.uncertain);
            times += 1;
        }
        // The reported error of the lab's own run at the end is its distance from the truth.
        let lab_run = lab_row(report);
        for (label, end) in expected["end"].as_object().unwrap() {
            let i = report.targets.iter().position(|t| t.label == *label).unwrap();
            if lab_run.status != RunStatus::Good {
                continue;
            }
            let setting = (lab_run.setting.integrator.id, lab_run.setting.timestep);
            let last = column(lab, setting, report.length, label).pop().unwrap();
            let off = (last - end.as_f64().unwrap()).abs();
            let (estimated, doubt) = (lab_run.errors[i].end, report.targets[i].uncertain);
            assert!(
                (off - estimated).abs() <= doubt,
                "{title}: {label}: {off:e} off, said {estimated:e} ± {doubt:e}"
            );
            ends += 1;
        }
        // No error is reported below its uncertainty.
        for row in &report.rows {
            for (off, event) in row.events.iter().zip(&report.events) {
                assert!(off.is_nan() || *off >= event.uncertain, "{title}: {}: {off:e}", event.name);
            }
        }
    }
    assert!(times >= 50 && ends >= 20, "{times} times, {ends} ends");
}

/// The growth of small differences by `stability`, with timesteps small enough to have no visible error, compared with the
/// derivative of the flow from the equations (`tests/golden/divergence.py`): the same directions grow by the same factors.
#[test]
fn small_differences_grow_as_by_equations_by_hand() {
    let golden = read_json(&workspace().join("tests/golden/divergence.json"));
    let lesson = load_lesson(
        SourceFile::new("kinds.md", std::fs::read_to_string(kinds()).unwrap()),
        &ModelFolder::unknown(),
    );
    let labs = lesson.all_labs();
    let far = |i: usize| -> Option<String> {
        let mut lab = labs[i].clone();
        let title = lab.title.as_ref().unwrap().value.clone();
        let (truth, until) = (&golden[&title], golden[&title]["until"].as_f64().unwrap());
        lab.stop_at.iter_mut().for_each(|stop| stop.value = until);
        let mut model = Model::clone(&model(&lab));
        (*model.edit().opt.timestep, *model.edit().opt.integrator) = (0.0002, integrator::RK4);
        let programs = Programs::compile(&lab, &model, &mut Vec::new());
        let options = stability::StressOptions { until: Some(until), ..Default::default() };
        let report = stability::probe(&lab, &model, &programs, &options, &mut |_| ()).unwrap();
        let found = report.sensitivity.divergence.unwrap();
        let off = |x: f64, key: &str| (x / truth[key].as_f64().unwrap() - 1.0).abs();
        println!("{title}: {:e} {:e}", off(found.low, "low"), off(found.high, "high"));
        (off(found.low, "low").max(off(found.high, "high")) > 1e-3 || report.sensitivity.exponent.is_some())
            .then(|| format!("{title}: {:?}, {truth}", report.sensitivity))
    };
    let wrong: Vec<String> = for_each(labs.len(), far).into_iter().flatten().collect();
    assert!(labs.len() == 21 && wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn a_dip_after_the_start_is_no_passage() {
    // A body at rest up to rounding, which is pushed later: it sinks by 1e-9 first, and crosses no value.
    let lab = serde_json::json!({
        "xml": slider("gravity='0 0 0'", "damping='2000'", "<actuator><motor joint='j'/></actuator>"),
        "setup": "data.qvel[0] = -1e-6", "controller": "data.ctrl[0] = data.time > 0.1 ? 20000 : 0",
        "stopAt": 0.4, "plots": trace("data.qpos[0]"),
    });
    let lesson = written(&lab);
    let report = report(one(&lesson), &PrecisionOptions::default());
    assert!(report.events.iter().all(|e| e.time.is_nan()), "{:?}", report.events);
}

#[test]
fn longer_steps_are_tried_until_something_changes() {
    let lesson = load_lesson(SourceFile::read(&kinds()).unwrap(), &ModelFolder::unknown());
    let labs = lesson.addressed();
    for (title, longest) in [("A mass ratio of a thousand", 0.032), ("The intermediate axis", 0.128)] {
        let lab = labs.iter().find(|(_, l)| l.title() == title).unwrap().1;
        let report = report(lab, &PrecisionOptions::default());
        let best = right(&report);
        assert_eq!(
            (best.setting.integrator.id, best.setting.timestep),
            (integrator::RK4, longest),
            "{title}"
        );
        // Another doubling of the timestep is visible.
        let next = report
            .rows
            .iter()
            .find(|r| r.setting.integrator.id == integrator::RK4 && r.setting.timestep == 2.0 * longest);
        assert!(next.is_some_and(|r| r.score > 1.0), "{title}");
    }
}

#[test]
fn a_run_that_breaks_is_no_measure_of_a_plot() {
    let lesson = load_lesson(SourceFile::read(&kinds()).unwrap(), &ModelFolder::unknown());
    let labs = lesson.addressed();
    // With the lab's own setting, the gyroscope's axis turns over, with arbitrarily large numbers.
    let lab = labs.iter().find(|(_, l)| l.title() == "A gyroscope").unwrap().1;
    let report = report(lab, &PrecisionOptions::default());
    assert_ne!(lab_row(&report).status, RunStatus::Good);
    // Its transverse speed stays within 11 rad/s, half a pixel of which is small.
    assert!(report.targets[1].invisible_error < 0.06, "{}", report.targets[1].invisible_error);
    let best = right(&report);
    let setting = (best.setting.integrator.id, best.setting.timestep);
    let seen = column(lab, setting, report.length, "across (rad/s)");
    let fine = column(lab, (integrator::RKMK8, best.setting.timestep / 2.0), report.length, "across (rad/s)");
    let worst = seen.iter().zip(fine.iter().step_by(2)).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(worst <= 1.1 * report.targets[1].invisible_error, "{worst}");
}

#[test]
fn every_sample_of_a_readout_counts() {
    // A spring that oscillates ten times and comes to rest: at the end, all settings are right.
    let lab = serde_json::json!({
        "xml": slider("gravity='0 0 0' integrator='RK4'", "stiffness='100' damping='3'", ""), "setup": "data.qpos[0] = 1",
        "stopAt": 6.4, "readouts": [{"label": "place", "expr": "10 * data.qpos[0]", "digits": 1}],
    });
    let lesson = written(&lab);
    let lab = one(&lesson);
    let report = report(lab, &PrecisionOptions::default());
    let euler = report.rows.iter().find(|r| r.setting.integrator.id == integrator::EULER);
    let euler = euler.unwrap();
    assert!(euler.errors[0].end < 0.05 && euler.errors[0].wrong > 10 && euler.score > 1.0);
    // The recommended setting displays the digits of a much more accurate run at every sample.
    let best = right(&report).setting;
    let seen = column(lab, (best.integrator.id, best.timestep), report.length, "place");
    let fine = column(lab, (integrator::RKMK8, best.timestep / 2.0), report.length, "place");
    for (k, (a, b)) in seen.iter().zip(fine.iter().step_by(2)).enumerate() {
        assert_eq!(rounded(*a, 1), rounded(*b, 1), "sample {k}: {a} {b}");
    }
}

#[test]
fn late_contacts_count() {
    // It falls for one second and then lies on the ground for one second.
    let lab = serde_json::json!({
        "xml": "<mujoco><worldbody><geom type='plane' size='5 5 1'/><body pos='0 0 4.905'><freejoint/>\
                <geom type='box' size='0.1 0.1 0.1'/></body></worldbody></mujoco>",
        "stopAt": 2, "plots": trace("data.qpos[2]"),
    });
    let lesson = written(&lab);
    let work = |until: f64| {
        let integrators = vec![Integrator::named("Euler").unwrap()];
        let options = PrecisionOptions { until: Some(until), integrators, ..PrecisionOptions::default() };
        lab_row(&report(one(&lesson), &options)).cost.work
    };
    let (air, whole) = (work(0.8), work(2.0));
    assert!(whole > 1.8 * air, "{air} {whole}");
}

#[test]
fn work_decides_and_is_the_same_again() {
    let lesson = load_lesson(SourceFile::read(&kinds()).unwrap(), &ModelFolder::unknown());
    let labs = lesson.addressed();
    let lab = labs.iter().find(|(_, l)| l.title() == "Gears with elastic teeth").unwrap().1;
    let [one, two] = [0; 2].map(|_| report(lab, &PrecisionOptions::default()));
    let numbers = |r: &PrecisionResults| -> Vec<f64> { r.rows.iter().map(|row| row.cost.work).collect() };
    assert_eq!(numbers(&one), numbers(&two));
    assert_eq!((&one.front, &one.advice), (&two.front, &two.advice));
    // An integrator that solves with derivatives costs more than one that does not.
    let of = |id: i32| {
        let row = one.rows.iter().find(|r| r.setting.integrator.id == id && r.setting.timestep == 0.002);
        row.unwrap().cost.work
    };
    assert!(of(integrator::IMPLICIT) > 3.0 * of(integrator::EULER));
}

#[test]
fn orders_are_printed_where_they_exist() {
    for (lab, report) in kinds_with_reports() {
        let touched = ["A fast ball between walls", "Dry friction", "A slam", "A pinball", "A stack"];
        let orders = report.rows.iter().flat_map(|r| r.errors.iter().filter_map(|e| e.order));
        let orders: Vec<f64> = orders.collect();
        if touched.contains(&lab.title()) {
            assert!(orders.is_empty(), "{}: {orders:?}", lab.title());
        }
        assert!(orders.iter().all(|o| (0.5..9.0).contains(o)), "{}: {orders:?}", lab.title());
    }
}

#[test]
fn nothing_is_compared_beyond_the_horizon_of_chaos() {
    let xml = "<mujoco><worldbody><body pos='0 0 2'><joint axis='0 1 0'/><inertial pos='0 0 -1' mass='1' \
               diaginertia='1e-6 1e-6 1e-6'/><body pos='0 0 -1'><joint axis='0 1 0'/><inertial pos='0 0 -1' mass='1' \
               diaginertia='1e-6 1e-6 1e-6'/></body></body></worldbody></mujoco>";
    let lab = serde_json::json!({
        "xml": xml, "setup": "data.qpos[0] = 3; data.qpos[1] = 0.5", "stopAt": 80, "plots": trace("data.qpos[1]"),
    });
    let lesson = written(&lab);
    let integrators = vec![Integrator::named("Euler").unwrap()];
    let report = report(one(&lesson), &PrecisionOptions { integrators, ..PrecisionOptions::default() });
    let until = report.targets[0].until.unwrap();
    assert!(until > 5.0 && until < 79.0, "{until}");
    assert!(report.events.iter().all(|e| e.time.is_nan() || e.time + e.uncertain <= until));
    for row in &report.rows {
        assert!(row.errors[0].time.is_nan() || row.errors[0].time <= until);
        assert_eq!((row.errors[0].order, row.penetration.is_nan()), (None, true));
    }
}

#[test]
fn controllers_of_time_have_a_reference_as_good_as_others() {
    for (lab, report) in kinds_with_reports() {
        if !["A driven oscillator", "A square wave", "Drag", "Van der Pol"].contains(&lab.title()) {
            continue;
        }
        let target = &report.targets[0];
        assert!(target.uncertain <= 1e-9 * target.range, "{}: {:e}", lab.title(), target.uncertain);
    }
}

#[test]
fn no_cost_of_a_plan_is_negative() {
    use labspec_numerics::profile::{PlanOptions, plan};
    let lesson = load_lesson(SourceFile::read(&kinds()).unwrap(), &ModelFolder::unknown());
    let mut measured = 0;
    for (_, lab) in lesson.addressed().into_iter().take(8) {
        let model = model(lab);
        let programs = Programs::compile(lab, &model, &mut Vec::new());
        // Fields that are read already require no further stage: their cost is noise of the clock around zero.
        let read = vec!["data.qpos".to_string(), "data.qvel".to_string(), "data.time".to_string()];
        let report = plan(lab, &model, &programs, &PlanOptions { read, run: true }).unwrap();
        let stages =
            report.rows.iter().flat_map(|r| [r.forced, r.cost.map(|c| c.ns), r.cost.map(|c| c.share)]);
        let costs: Vec<f64> = stages.chain(report.readers.iter().map(|r| r.cost)).flatten().collect();
        assert!(costs.iter().all(|c| *c >= 0.0), "{}: {costs:?}", lab.title());
        measured += costs.len();
    }
    assert!(measured > 100, "{measured}");
}

#[test]
fn small_values_are_not_printed_as_zero() {
    // A pendulum whose plot is compared with a reference, and a stack whose contacts a page displays one step late.
    for (lab, report) in kinds_with_reports() {
        for row in report.rows.iter().filter(|r| r.status == RunStatus::Good) {
            for (e, target) in row.errors.iter().zip(&report.targets).filter(|(_, t)| t.is_compared()) {
                assert!(e.largest > target.uncertain || e.below, "{}: {:?} {e:?}", lab.title(), row.setting);
            }
            assert!(row.events.iter().all(|off| *off != 0.0), "{}: {:?}", lab.title(), row.setting);
        }
    }
}

#[test]
fn units_are_printed_where_known() {
    let lesson = load_lesson(SourceFile::read(&kinds()).unwrap(), &ModelFolder::unknown());
    let mut with_unit = 0;
    for (_, lab) in lesson.addressed() {
        let integrators = vec![Integrator::named("RK4").unwrap()];
        let report =
            report(lab, &PrecisionOptions { integrators, until: Some(0.04), ..PrecisionOptions::default() });
        for target in report.targets {
            let stated = target.label.contains('(');
            assert!(!stated || target.unit.as_ref().is_some_and(|u| target.label.contains(u.as_str())));
            with_unit += usize::from(target.unit.is_some());
        }
    }
    assert!(with_unit >= 25, "{with_unit}");
}
