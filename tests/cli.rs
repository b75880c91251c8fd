//! The program itself: exit codes, what it prints to people and to programs, and what it says when it cannot run.

#![allow(clippy::unwrap_used)]

use crate::needs::needs;
use crate::program::{folder, json_of, keys, program, run, run_in, shown, snapshot};
use crate::support::workspace;
use serde_json::{Value, json};
use std::io::Read;
use std::process::Stdio;

#[test]
fn check_a_clean_lesson() {
    assert_eq!(run(&["check", "clean.md"]).code, 0);
    snapshot("check-clean", shown(&["check", "clean.md"]));
}

#[test]
fn check_a_wrong_lesson() {
    assert_eq!(run(&["check", "wrong.md"]).code, 1);
    snapshot("check-wrong", shown(&["check", "wrong.md"]));
}

#[test]
fn check_a_folder() {
    let done = run(&["check", "course", "--models", "models"]);
    // Other people's JSON is passed over.
    assert_eq!((done.code, done.stderr.as_str()), (0, ""), "{}", done.stdout);
    assert!(done.stdout.contains("course/a.md") && !done.stdout.contains("package.json"), "{}", done.stdout);
    // Named itself, it is ours to complain about.
    assert_eq!(run(&["check", "course/package.json"]).code, 1);
}

/// The lesson that this program was first written for, where it lies beside the repository.
#[test]
fn check_the_real_lesson() {
    let shared = workspace().join("../shared");
    if !needs("../shared/lesson-0.1") {
        return;
    }
    let arguments = ["check", "lesson-0.1/lesson-0.1.md", "--models", "corpus/models", "--format", "json"];
    let report: Value = serde_json::from_str(&run_in(&shared, &arguments).stdout).unwrap();
    let findings = report["findings"].as_array().unwrap();
    let codes: Vec<&str> = findings.iter().filter_map(|f| f["code"].as_str()).collect();
    // `<option>` in the text and in an explanation, which a browser swallows; `mj_setConst` in mid-run, which makes the scene jump;
    // what is not claimed, and where the right option is the longest.
    let all = [
        "numbers-unclaimed",
        "unescaped-element",
        "setconst-jumps",
        "prediction-unchecked",
        "unescaped-element",
        "long-answer",
        "long-answer",
    ];
    assert_eq!(codes, all);
    let labs = report["lessons"][0]["labs"].as_array().unwrap();
    let ran: Vec<_> = labs.iter().map(|l| (l["address"].as_str().unwrap(), l["ran"] == true)).collect();
    assert_eq!(ran, [("#1", true), ("#2", true), ("#0.1-predict.1", true), ("#0.1-predict.2", true)]);
}

#[test]
fn check_a_lesson_with_a_broken_model() {
    snapshot("check-broken-model", shown(&["check", "broken/lesson.md"]));
}

#[test]
fn check_for_programs() {
    let report = run(&["check", "wrong.md", "--format", "json"]);
    assert_eq!(report.code, 1);
    let report: Value = serde_json::from_str(&report.stdout).unwrap();
    assert_eq!(
        keys(&report),
        ["schemaVersion", "report", "findings", "summary", "aside", "lessons", "ledger", "since", "judge"]
    );
    let lesson = &report["lessons"][0];
    assert_eq!(keys(lesson), ["file", "labs", "claims", "snapshots"]);
    let lab = ["address", "title", "runs", "ran", "broke", "seconds", "covered", "skipped", "ended"];
    assert_eq!(keys(&lesson["labs"][0]), lab);
    let claim = &lesson["claims"][0];
    assert_eq!(
        keys(claim),
        [
            "name",
            "file",
            "start",
            "end",
            "line",
            "column",
            "endLine",
            "endColumn",
            "range",
            "answer",
            "quotes",
            "closedForms",
            "runs",
            "measures"
        ]
    );
    assert_eq!(claim["answer"]["verdict"], "refuted");
    assert_eq!(claim["quotes"][0]["verdict"], "refuted");
    assert_eq!(report["summary"]["outcome"], "findings");
    let findings = report["findings"].as_array().unwrap();
    let codes: Vec<&str> = findings.iter().filter_map(|f| f["code"].as_str()).collect();
    for code in ["unknown-field", "answer-refuted", "quote-wrong"] {
        assert!(codes.contains(&code), "{code} is not in {codes:?}");
    }
    let clean = json_of(&["check", "clean.md", "--format", "json"]);
    assert_eq!(clean["findings"], json!([]));
}

#[test]
fn verify_shows_every_measure() {
    snapshot("verify", shown(&["verify", "clean.md"]));
}

#[test]
fn what_cannot_run_says_why() {
    let mut all = String::new();
    for arguments in [
        &["check", "nowhere.md"][..],
        &["check", "empty"],
        &["check", "clean.md", "--models", "nowhere"],
        &["run", "clean.md#7"],
        &["run", "clean.md#lab"],
        &["run", "clean.md"],
        &["run", "wrong.md#1"],
        &["run", "broken/models/ball_drop.xml"],
        &["run", "clean.md#1", "--set", "gravty=-5"],
        &["run", "clean.md#1", "--set", "gravity"],
        &["run", "clean.md#1", "--set", "Kick=1"],
        &["run", "clean.md#1", "--press", "Kik@0.2"],
        &["run", "clean.md#1", "--press", "Kick@soon"],
        &["run", "clean.md#1", "--press", "gravity@1"],
        &["run", "clean.md#1", "--until", "1e9"],
        &["run", "models/ball_drop.xml", "--svg", "plot.svg"],
        &["run", "clean.md#1", "--csv", "nowhere/table.csv"],
        &["explain", "answer-refutd"],
        &["record", "models/ball_drop.xml", "--states", "nowhere.json"],
        &["record", "models/ball_drop.xml", "--states", "clean.md"],
        &["precision", "models/ball_drop.xml"],
    ] {
        let text = shown(arguments);
        assert!(text.contains("\nexit 2\n"), "{text}");
        all.push_str(&text);
        all.push('\n');
    }
    // The system's own words for a missing file differ between systems.
    snapshot(
        "failures",
        all.replace("The system cannot find the file specified.", "No such file or directory"),
    );
}

#[test]
fn help_and_version_are_no_errors() {
    assert_eq!(run(&["--help"]).code, 0);
    assert_eq!(run(&["run", "--help"]).code, 0);
    assert_eq!(run(&["--version"]).stdout, format!("labspec {}\n", env!("CARGO_PKG_VERSION")));
    assert_eq!((run(&[]).code, run(&["chekc"]).code, run(&["check"]).code), (2, 2, 2));
}

/// Two runs print the same bytes.
#[test]
fn output_is_deterministic() {
    let once = || run(&["run", "clean.md#1", "--format", "json", "--until", "0.6"]).stdout;
    assert_eq!(once(), once());
    let check = || run(&["check", "wrong.md", "clean.md", "fall.json", "--format", "json"]).stdout;
    assert_eq!(check(), check());
}

#[test]
fn explain_knows_every_code() {
    let list = run(&["explain"]);
    assert_eq!(list.code, 0);
    let codes: Vec<&str> = list.stdout.lines().filter_map(|l| l.split_whitespace().next()).collect();
    assert!(codes.len() > 60, "{}", codes.len());
    // A few of each kind; running all would take as many processes.
    for code in ["answer-fragile", "unknown-key", "unknown-field", codes[0], codes[codes.len() - 1]] {
        let done = run(&["explain", code]);
        assert_eq!(done.code, 0, "{code}: {}", done.stderr);
        assert!(done.stdout.starts_with(&format!("# {code}")), "{}", done.stdout);
    }
}

/// `labspec … | head`: a reader that goes away ends the program quietly.
#[test]
fn a_pipe_that_is_closed_early() {
    let folder = folder();
    for arguments in [
        &["run", "clean.md#1", "--until", "60", "--format", "csv"][..],
        &["run", "clean.md#1", "--until", "60", "--format", "json"],
        &["explain"],
        &["check", "wrong.md"],
    ] {
        let mut child =
            program(folder.path(), arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        let mut first = [0; 8];
        child.stdout.take().unwrap().read_exact(&mut first).unwrap();
        let output = child.wait_with_output().unwrap();
        let errors = String::from_utf8(output.stderr).unwrap();
        assert_eq!(errors, "", "{arguments:?}");
        assert!(matches!(output.status.code(), Some(0 | 1)), "{arguments:?}: {:?}", output.status);
    }
}
