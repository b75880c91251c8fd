//! A run ends at the first sample whose time has reached the `stopAt` of its lab, whatever changes time on the way.

#![allow(clippy::unwrap_used)]

use crate::support::{check_text, codes};
use labspec::bind::scene::Models;
use labspec::check;
use labspec::lint::{ModelFolder, load_lesson};
use labspec::run::{self, RunOptions, Table};
use labspec::source::SourceFile;
use labspec::verify::QuoteState;
use serde_json::{Value, json};

/// A ball in free fall that stops at 1 s, with these keys.
fn fall(more: &Value) -> Value {
    let mut lab = json!({"title": "A fall", "stopAt": 1,
        "xml": "<mujoco><worldbody><body name='ball' pos='0 0 1'><freejoint/><geom size='.1'/></body></worldbody>\
            <keyframe><key time='0.5' qpos='0 0 1 1 0 0 0'/></keyframe></mujoco>",
        "controls": [{"type": "button", "label": "coarse", "run": "model.opt.timestep = 0.01"},
            {"type": "button", "label": "fine", "run": "model.opt.timestep = 0.0005"},
            {"type": "button", "label": "again", "run": "sim.reset()"}],
        "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}]});
    more.as_object().unwrap().iter().for_each(|(key, value)| lab[key] = value.clone());
    lab
}

/// The table of a run with these buttons pressed.
fn table(lab: &Value, press: &[(&str, f64)]) -> Table {
    let models = Models::new(ModelFolder::unknown());
    let lesson = load_lesson(SourceFile::new("lab.json", lab.to_string()), models.folder());
    let lab = lesson.all_labs().into_iter().next().unwrap();
    let (model, programs, _) = check::bind(lab, &models, &mut Vec::new()).unwrap();
    let press = press.iter().map(|(label, time)| (label.to_string(), *time)).collect();
    run::run(lab, &model, &programs, &RunOptions { press, ..RunOptions::default() }).unwrap()
}

fn end(table: &Table) -> f64 {
    table.rows.last().unwrap()[0].number()
}

#[test]
fn a_run_ends_when_its_time_reaches_the_stop_time() {
    for (more, press, rows) in [
        (json!({}), vec![], 501),
        (json!({"key": 0}), vec![], 251),
        (json!({"controller": "mj.mj_step(model, data)"}), vec![], 251),
        (json!({}), vec![("coarse", 0.0)], 101),
        (json!({}), vec![("fine", 0.5)], 1251),
        (json!({}), vec![("again", 0.5)], 751),
    ] {
        let table = table(&fall(&more), &press);
        assert!((end(&table) - 1.0).abs() < 1e-9, "{more} {press:?} ends at {}", end(&table));
        assert_eq!(table.rows.len(), rows, "{more} {press:?}");
        assert_eq!(table.errors, [""; 0]);
    }
}

/// The rounding error of a sum of timesteps adds no step, and a time between two samples ends at the later one.
#[test]
fn a_stop_time_on_a_sample_needs_no_further_step() {
    let lab = |timestep: f64, stop: f64| {
        let xml = format!(
            "<mujoco><option timestep='{timestep}'/><worldbody><body><freejoint/><geom size='.1'/></body></worldbody></mujoco>"
        );
        json!({"xml": xml, "stopAt": stop, "readouts": []})
    };
    for (timestep, steps) in
        [(0.001, 1400), (0.002, 1000), (0.003, 7), (1.0 / 240.0, 480), (0.01, 3333), (0.07, 90)]
    {
        let stop = timestep * f64::from(steps);
        assert_eq!(table(&lab(timestep, stop), &[]).rows.len(), steps as usize + 1, "{timestep} {stop}");
    }
    let between = table(&lab(0.3, 1.0), &[]);
    assert!((end(&between) - 1.2).abs() < 1e-9, "{}", end(&between));
}

#[test]
fn quotes_of_the_end_of_a_run_are_those_at_the_stop_time() {
    let quoted = |more: Value, run: Value, quote: &str| {
        let mut lab = fall(&more);
        lab["note"] = json!(quote);
        lab["verify"] =
            json!({"runs": {"r": run}, "measure": {"z": "final(data.qpos[2])"}, "says": [[quote, "z"]]});
        check_text("lab.json", &lab.to_string()).claims[0].judgement.quotes[0].state
    };
    for (more, run, right, wrong) in [
        (json!({"key": 0}), json!({}), "-0.23 m", "-3.9 m"),
        (json!({"controller": "mj.mj_step(model, data)"}), json!({}), "-3.91 m", "-18.6 m"),
        (json!({}), json!({"press": [["again", 0.5]]}), "-3.91 m", "-0.23 m"),
    ] {
        assert_eq!(quoted(more.clone(), run.clone(), right), QuoteState::Right, "{more} {run}");
        assert_eq!(quoted(more.clone(), run.clone(), wrong), QuoteState::Wrong, "{more} {run}");
    }
}

/// A lab that resets itself in every step ends after a limited number of steps, which is reported, and proves nothing.
#[test]
fn a_run_that_never_reaches_its_stop_time_is_reported() {
    for controller in ["sim.reset()", "if (data.time > 0.3) { sim.reset() }"] {
        let mut lab = fall(&json!({"controller": controller, "note": "It is at 1.00 m."}));
        let table = table(&lab, &[]);
        let [error] = table.errors.as_slice() else { panic!("{:?}", table.errors) };
        assert!(
            error.contains("does not reach the `stopAt` of 1 s: after 10000 steps, the limit"),
            "{error}"
        );
        let checked = check_text("lab.json", &lab.to_string());
        assert!(codes(&checked).contains(&"stop-unreached"), "{:?}", codes(&checked));
        lab["verify"] = json!({"measure": {"z": "max(data.qpos[2])"}, "says": [["1.00 m", "z"]]});
        let checked = check_text("lab.json", &lab.to_string());
        assert_eq!(checked.claims[0].judgement.quotes[0].state, QuoteState::Unclear);
        let breaks = checked.findings.iter().find(|f| f.code == "run-breaks").unwrap();
        assert!(breaks.message.contains("does not reach the `stopAt` of 1 s"), "{}", breaks.message);
    }
}
