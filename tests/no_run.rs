//! `check --no-run`: what needs no run is checked as usual; what needs one is left out, counted, and never called true.

#![allow(clippy::unwrap_used)]

use crate::program::{run, run_in, snapshot, stdout_of};
use crate::support::workspace;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};

#[test]
fn omitted_claims_are_listed_and_counted() {
    assert_eq!(run(&["check", "clean.md", "--no-run"]).code, 3);
    snapshot("check-no-run", stdout_of(&["check", "clean.md", "fall.json", "--no-run"]));
    let report: Value =
        serde_json::from_str(&run(&["check", "clean.md", "--no-run", "--format", "json"]).stdout).unwrap();
    assert_eq!(report["summary"]["outcome"], "partial");
    let claims = &report["summary"]["claims"];
    for (subject, count) in [("lab", 2), ("answer", 1), ("quotedNumber", 1), ("run", 1), ("closedForm", 0)] {
        let left = &claims[subject];
        assert_eq!(left["leftOut"], count, "{subject}");
        let others =
            ["simulated", "computed", "false", "unchecked"].map(|state| left[state].as_u64().unwrap());
        assert_eq!(others, [0; 4], "{subject}");
    }
    assert_eq!(report["lessons"][0]["labs"].as_array().unwrap().len(), 0);
}

/// Wrong names are found without a run: in labs, and in all source texts of a `verify` object.
#[test]
fn a_wrong_name_is_found_without_a_run() {
    let report = run(&["check", "wrong.md", "--no-run", "--format", "json"]);
    assert_eq!(report.code, 1);
    let report: Value = serde_json::from_str(&report.stdout).unwrap();
    let codes: Vec<&str> =
        report["findings"].as_array().unwrap().iter().map(|f| f["code"].as_str().unwrap()).collect();
    // The wrong answer and the wrong number need a run.
    assert_eq!(codes, ["assign-derived", "unknown-field"]);

    let folder = crate::program::folder();
    let lesson = |from: &str, to: &str| {
        let text = std::fs::read_to_string(folder.path().join("clean.md")).unwrap();
        assert!(text.contains(from));
        std::fs::write(folder.path().join("a.md"), text.replace(from, to)).unwrap();
        let done = run_in(folder.path(), &["check", "a.md", "--no-run"]);
        assert_eq!(done.code, 1, "{to}");
        done.stdout
    };
    for (from, to, message) in [
        ("contact('heavy_geom')", "contact('heavy_gem')", "heavy_gem"),
        ("\"heavy > light\"", "\"heavy > ligth\"", "ligth"),
        ("[\"0.440 s\", \"heavy\"]", "[\"0.440 s\", \"haevy\"]", "haevy"),
    ] {
        let out = lesson(from, to);
        assert!(out.contains(message) && out.contains("did you mean"), "{out}");
    }
}

/// Nothing runs: a lab that would run for a long time and one that would fail are checked as fast as any, without
/// findings about their runs.
#[test]
fn nothing_is_run() {
    let folder = crate::program::folder();
    let lab = r#"{"model": "ball_drop", "stopAt": 1000, "setup": "data.qvel[2] = 1e11; for (let i = 0; i < 1e9; i++) { ctx.a = i }",
        "controls": [{"label": "mass", "set": "model.body_mass[1]", "min": 1, "max": 9, "value": 1}]}"#;
    std::fs::write(folder.path().join("slow.json"), lab).unwrap();
    let done = run_in(folder.path(), &["check", "slow.json", "--no-run"]);
    assert_eq!((done.code, done.stderr.as_str()), (3, ""), "{}", done.stdout);
    assert!(done.stdout.contains("1 lab left out"), "{}", done.stdout);
    // With a run, the result differs.
    assert_eq!(run_in(folder.path(), &["check", "slow.json"]).code, 1);
}

/// A folder in which nothing needs a run is checked completely: a model is loaded, and a quiz without a check claims nothing.
#[test]
fn without_claims_that_need_runs_nothing_is_omitted() {
    assert_eq!(run(&["check", "models/ball_drop.xml", "--no-run"]).code, 0);
    assert_eq!(run(&["check", "empty", "--no-run"]).code, 2);
}

/// For all lessons: a check without runs has no finding that the full check does not have, calls nothing true that needs a run,
/// and counts the same number of claims.
#[test]
fn a_check_without_runs_reports_a_subset() {
    let mut left = 0;
    for folder in ["specs/lessons", "tests/lessons"] {
        let of = |more: &[&str]| {
            let done = run_in(&workspace(), &[&["check", folder, "--format", "json"], more].concat());
            serde_json::from_str::<Value>(&done.stdout).unwrap()
        };
        let (full, without) = (of(&[]), of(&["--no-run"]));
        let messages = |report: &Value| -> BTreeSet<String> {
            let findings = report["findings"].as_array().unwrap();
            findings.iter().map(|f| format!("{} {} {}", f["file"], f["start"], f["message"])).collect()
        };
        let more: Vec<_> = messages(&without).difference(&messages(&full)).cloned().collect();
        assert_eq!(more, Vec::<String>::new(), "{folder}");
        let counted = |report: &Value| -> BTreeMap<(String, String), usize> {
            let mut counts = BTreeMap::new();
            for e in report["ledger"].as_array().unwrap().iter().filter(|e| e["subject"] != "file") {
                *counts.entry((e["subject"].to_string(), e["owner"].to_string())).or_default() += 1;
            }
            counts
        };
        for e in without["ledger"].as_array().unwrap().iter().filter(|e| e["subject"] != "file") {
            assert_ne!(e["state"], "true", "{e}");
            left += usize::from(e["state"] == "leftOut");
        }
        assert_eq!(counted(&without), counted(&full), "{folder}");
    }
    assert!(left > 20, "{left}");
}
