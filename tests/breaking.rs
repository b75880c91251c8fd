//! Reports about labs that fail, gain energy without a source, or are too stiff for their timestep: the lessons of
//! `tests/lessons/runs`. Labs without such faults are not reported: our own lessons and those next to the repository.

#![allow(clippy::unwrap_used)]

use crate::needs::needs;
use crate::program::{run_in, snapshot, stdout_in};
use crate::support::workspace;
use serde_json::Value;
use std::path::Path;

fn lessons() -> std::path::PathBuf {
    workspace().join("tests/lessons/runs")
}

#[test]
fn run_a_lab_that_breaks() {
    let stdout_of_lab = |lab: &str| stdout_in(&lessons(), &["run", lab]);
    snapshot("run-diverges", stdout_of_lab("diverges.md"));
    snapshot("run-grows", ["grows.md#1", "grows.md#2", "grows.md#3"].map(stdout_of_lab).join("\n"));
}

#[test]
fn run_a_lab_that_breaks_for_programs() {
    for (name, lab) in [("run-diverges-json", "diverges.md"), ("run-grows-json", "grows.md#3")] {
        let done = run_in(&lessons(), &["run", lab, "--every", "100000", "--format", "json"]);
        let mut table: Value = serde_json::from_str(&done.stdout).unwrap();
        table["version"] = Value::Null;
        snapshot(name, format!("exit {}\n{}", done.code, serde_json::to_string_pretty(&table).unwrap()));
    }
}

#[test]
fn check_labs_that_break() {
    for name in ["diverges", "grows", "stiff"] {
        snapshot(&format!("check-{name}"), stdout_in(&lessons(), &["check", &format!("{name}.md")]));
    }
}

/// The codes and messages of the findings of a check.
fn found(folder: &Path, arguments: &[&str]) -> Vec<(String, String)> {
    let done = run_in(folder, &[&["check", "--format", "json"], arguments].concat());
    let report: Value = serde_json::from_str(&done.stdout).unwrap();
    let text = |f: &Value, key: &str| f[key].as_str().unwrap_or_default().to_string();
    report["findings"].as_array().unwrap().iter().map(|f| (text(f, "code"), text(f, "message"))).collect()
}

#[test]
fn no_correct_lab_is_reported_to_break() {
    const SILENT: [&str; 6] =
        ["energy-grows", "damper-pushes", "past-limit", "passes-through", "sinks-in", "solver-stops-early"];
    let grows = |list: Vec<(String, String)>| {
        list.into_iter().filter(|(code, _)| SILENT.contains(&code.as_str())).collect::<Vec<_>>()
    };
    assert_eq!(grows(found(&lessons(), &["grows.md"])).len(), 3);
    assert_eq!(grows(found(&workspace(), &["specs/lessons", "--models", "specs/models"])), []);
    let shared = workspace().join("../shared");
    if !needs("../shared/corpus") {
        return;
    }
    for folder in ["corpus/labs", "corpus/quizzes", "lesson-0.1"] {
        let reported = grows(found(&shared, &[folder, "--models", "corpus/models"]));
        // Two balls at the lower end of the damping ratio: 0.625 J before they meet, 1.376 J after it, in the library as well
        // (`golden/stability_labs.json`, physics-lab_04).
        let is_expected = |message: &str| message.contains("\"contact damping ratio\" at 0.02");
        let other: Vec<_> = reported.iter().filter(|(_, message)| !is_expected(message)).collect();
        assert!(other.is_empty(), "{folder}: {other:?}");
        assert_eq!(reported.is_empty(), folder != "corpus/labs");
    }
}

#[test]
fn a_lab_that_displays_its_energy_is_monitored_too() {
    let link =
        "<body><joint axis='0 1 0'/><geom type='capsule' fromto='0 0 0 .4 0 0' size='.03' mass='.5'/></body>";
    let folder = tempfile::tempdir().unwrap();
    for (step, code) in [("1", 1), ("0.01", 0)] {
        let xml = format!("<mujoco><option timestep='{step}'/><worldbody>{link}</worldbody></mujoco>");
        let readouts = serde_json::json!([{"label": "energy (J)", "expr": "lib.energy().total"}]);
        let lab = serde_json::json!({"xml": xml, "stopAt": 60, "readouts": readouts});
        std::fs::write(folder.path().join("lab.json"), lab.to_string()).unwrap();
        let done = run_in(folder.path(), &["run", "lab.json"]);
        assert_eq!((done.code, done.stdout.contains("energy grows")), (code, code == 1), "{}", done.stdout);
    }
}
