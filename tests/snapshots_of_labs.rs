//! The snapshots that `labspec snapshot` stores, and the findings of `check` when the output of a lab changes.

#![allow(clippy::unwrap_used)]

use crate::program::{program, run_in, snapshot};
use crate::support::workspace;
use serde_json::{Value, json};
use std::path::Path;
use tempfile::TempDir;

/// A swinging pendulum and a falling ball: two labs of one lesson.
fn lesson() -> String {
    let pendulum = json!({
        "title": "A pendulum", "stopAt": 2, "setup": "data.qpos[0] = 0.5",
        "xml": "<mujoco><option timestep='0.01'/><worldbody><body pos='0 0 1'><joint name='hinge' type='hinge' axis='0 1 0' damping='0.02'/>\
                <geom type='capsule' size='.02' fromto='0 0 0 0 0 -.5' mass='1'/></body></worldbody></mujoco>",
        "plots": [{"traces": [
            {"label": "angle", "expr": "data.qpos[0]"},
            {"label": "rate", "expr": "data.qvel[0]"}
        ]}],
    });
    let ball = json!({
        "title": "A ball", "stopAt": 0.4,
        "xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/>\
                <body pos='0 0 1'><freejoint/><geom name='ball' size='.1' mass='1'/></body></worldbody></mujoco>",
        "controls": [{"label": "gravity", "set": "model.opt.gravity[2]", "min": -20, "max": -1, "step": 0.01, "value": -9.81}],
        "plots": [{"traces": [{"label": "height", "expr": "data.qpos[2]"}]}],
        "readouts": [{"label": "height (m)", "expr": "data.qpos[2]", "digits": 2}],
    });
    format!("# Two labs\n\n```lab simlab\n{pendulum}\n```\n\n```lab simlab\n{ball}\n```\n")
}

fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), &lesson());
    folder
}

fn write(folder: &Path, text: &str) {
    std::fs::write(folder.join("two.md"), text).unwrap();
}

fn stored(folder: &Path) -> String {
    std::fs::read_to_string(folder.join("two.md.snap")).unwrap()
}

/// A folder with the lesson and its snapshot.
fn with_snapshot() -> TempDir {
    let folder = folder();
    let done = run_in(folder.path(), &["snapshot", "two.md"]);
    assert_eq!((done.code, done.stdout.as_str()), (0, "stored     two.md.snap: 2 labs\n"), "{}", done.stderr);
    folder
}

/// The state of the snapshot of each lab after a change of the lesson, with the exit code.
fn after(from: &str, to: &str) -> (i32, Value) {
    let folder = with_snapshot();
    assert!(lesson().contains(from), "{from}");
    write(folder.path(), &lesson().replace(from, to));
    let done = run_in(folder.path(), &["check", "two.md", "--format", "json"]);
    let report: Value = serde_json::from_str(&done.stdout).unwrap();
    (done.code, report["lessons"][0]["snapshots"].clone())
}

#[test]
fn a_snapshot_is_a_text_for_reviewers() {
    let folder = with_snapshot();
    snapshot("snapshot-file", stored(folder.path()));
}

/// The same lesson gives the same bytes and agrees with its snapshot, with any number of threads.
#[test]
fn unchanged_labs_equal_the_snapshot() {
    let folder = with_snapshot();
    let first = stored(folder.path());
    let again = run_in(folder.path(), &["snapshot", "two.md", "--accept"]);
    assert_eq!((again.code, again.stdout.as_str()), (0, "as stored  1 lesson\n"));
    assert_eq!(stored(folder.path()), first);
    std::fs::copy(folder.path().join("two.md"), folder.path().join("copy.md")).unwrap();
    assert_eq!(run_in(folder.path(), &["snapshot", "copy.md"]).code, 0);
    let check = |jobs: &str| run_in(folder.path(), &["check", ".", "--format", "json", "--jobs", jobs]);
    let (one, four) = (check("1"), check("4"));
    assert_eq!((one.code, &one.stdout), (0, &four.stdout));
    let report: Value = serde_json::from_str(&one.stdout).unwrap();
    assert_eq!(report["summary"]["claims"]["snapshot"]["simulated"], 4);
    assert!(run_in(folder.path(), &["check", "two.md"]).stdout.contains("2 snapshots as stored"));
}

/// Without a stored snapshot, nothing is claimed.
#[test]
fn without_a_snapshot_nothing_is_claimed() {
    let folder = folder();
    let report = run_in(folder.path(), &["check", "two.md", "--format", "json"]);
    let report: Value = serde_json::from_str(&report.stdout).unwrap();
    assert_eq!(report["lessons"][0]["snapshots"], json!([]));
    assert!(!run_in(folder.path(), &["check", "two.md"]).stdout.contains("snapshot"));
    let left = with_snapshot();
    let done = run_in(left.path(), &["check", "two.md", "--no-run"]);
    assert!(done.code == 3 && done.stdout.contains("2 snapshots left out"), "{}", done.stdout);
}

/// A number of the model, the sign of a trace, the integrator: each is reported at its first effect.
#[test]
fn the_first_divergence_has_its_lab_its_run_its_trace_and_its_time() {
    // A longer pendulum: the same start, another motion.
    let (code, all) = after("0 0 -.5' mass", "0 0 -.6' mass");
    assert_eq!(code, 1);
    assert_eq!((&all[0]["state"], &all[1]["state"]), (&json!("false"), &json!("true")));
    let first = &all[0]["divergence"];
    assert_eq!((&first["run"], &first["trace"]), (&json!("as it stands"), &json!("plot/0/angle")));
    assert_eq!(first["time"], 0.2);
    assert_eq!(all[0]["rows"], 2);

    // A trace with the opposite sign, from the start on.
    let (code, all) = after("\"height\",\"expr\":\"data.qpos[2]\"", "\"height\",\"expr\":\"-data.qpos[2]\"");
    let first = &all[1]["divergence"];
    assert_eq!((code, &first["trace"], &first["time"]), (1, &json!("plot/0/height"), &json!(0.0)));
    assert_eq!((&first["stored"], &first["now"]), (&json!("1.0000"), &json!("-1.00000")));
    assert_eq!((&all[0]["state"], &first["tolerance"]), (&json!("true"), &json!(0.5e-4)));

    // Another integrator: its name and its effects are reported.
    let (code, all) = after("timestep='0.01'", "timestep='0.01' integrator='RK4'");
    assert_eq!((code, &all[0]["changes"]), (1, &json!(["Euler is now RK4"])));
    let first = &all[0]["divergence"];
    assert!(
        first["time"].as_f64().unwrap() > 0.0 && first["trace"].as_str().unwrap().starts_with("plot/0/"),
        "{all}"
    );

    // Only with a slider at its end: the unchanged lab has the same output.
    let (code, all) = after("\"min\":-20", "\"min\":-19");
    assert_eq!(code, 1);
    let changes =
        json!(["the run with \"gravity\" at -20 no longer exists", "the run with \"gravity\" at -19 is new"]);
    assert_eq!((&all[1]["changes"], &all[1]["divergence"]), (&changes, &Value::Null));
}

/// The output on a terminal: the finding at the trace, the values, and both curves.
#[test]
fn a_change_is_drawn() {
    let folder = with_snapshot();
    write(folder.path(), &lesson().replace("0 0 -.5' mass", "0 0 -.6' mass"));
    let done = run_in(folder.path(), &["check", "two.md"]);
    // The lab itself is one long line, which is irrelevant here.
    let report: Vec<&str> =
        done.stdout.lines().filter(|line| !line.contains("simlab") && !line.starts_with("5 |")).collect();
    snapshot("snapshot-differs", report.join("\n"));
}

/// Traces, controls and labs that are added, removed or renamed.
#[test]
fn changes_of_a_lab_are_described() {
    let changes = |from: &str, to: &str| {
        let (code, all) = after(from, to);
        assert_eq!(code, 1, "{all}");
        let output = |lab: &Value| {
            lab["changes"]
                .as_array()
                .unwrap()
                .iter()
                .map(|c| c.as_str().unwrap().to_string())
                .collect::<Vec<_>>()
        };
        all.as_array().unwrap().iter().flat_map(output).collect::<Vec<String>>()
    };
    assert_eq!(
        changes("\"label\":\"rate\"", "\"label\":\"speed\""),
        ["\"plot/0/rate\" is now called \"plot/0/speed\""]
    );
    assert_eq!(
        changes("\"rate\",\"expr\":\"data.qvel[0]\"", "\"twice\",\"expr\":\"2 * data.qvel[0]\""),
        ["\"plot/0/rate\" is no longer shown", "\"plot/0/twice\" is new"]
    );
    assert_eq!(changes("\"stopAt\":0.4", "\"stopAt\":0.5"), ["0.4 s is now 0.5 s"]);
    assert_eq!(
        changes(
            "\"stopAt\":2,",
            "\"stopAt\":2,\"controls\":[{\"type\":\"button\",\"label\":\"Kick\",\"run\":\"data.qvel[0] = 1\"}],"
        ),
        ["the run after \"Kick\" is pressed is new"]
    );
    let (code, all) = {
        let folder = with_snapshot();
        let text = lesson();
        let first = text.find("```lab").unwrap();
        let second = text.rfind("```lab").unwrap();
        // Only the pendulum remains.
        write(folder.path(), &text[..second]);
        let gone = run_in(folder.path(), &["check", "two.md", "--format", "json"]);
        assert_eq!(gone.code, 1);
        // A third lab.
        write(folder.path(), &format!("{text}\n{}", &text[first..second]));
        let done = run_in(folder.path(), &["check", "two.md", "--format", "json"]);
        let both = json!(
            [gone.stdout, done.stdout]
                .map(|s| serde_json::from_str::<Value>(&s).unwrap()["lessons"][0]["snapshots"].clone())
        );
        (done.code, both)
    };
    assert_eq!((code, &all[0][1]["changes"]), (1, &json!(["the lab is no longer in the lesson"])));
    assert_eq!(all[1][2]["changes"], json!(["the lab is not in the snapshot"]));
}

/// A new snapshot is stored; an existing one is replaced only when the user accepts the change.
#[test]
fn only_accepted_labs_are_overwritten() {
    let folder = with_snapshot();
    let first = stored(folder.path());
    write(folder.path(), &lesson().replace("0 0 -.5' mass", "0 0 -.6' mass"));
    for arguments in [&["snapshot", "two.md"][..], &["snapshot", "two.md", "--review"]] {
        let done = run_in(folder.path(), arguments);
        assert_eq!(done.code, 1);
        assert!(
            done.stdout.contains(
                "differs    lab #1: \"plot/0/angle\" as it stands from t = 0.2 s on, and 1 more row"
            ),
            "{}",
            done.stdout
        );
        assert!(done.stdout.contains("--review shows each change and asks; --accept accepts all"));
        assert_eq!(stored(folder.path()), first);
    }
    let done = run_in(folder.path(), &["snapshot", ".", "--accept"]);
    assert_eq!((done.code, done.stdout.as_str()), (0, "stored     ./two.md.snap: 2 labs\n"));
    let second = stored(folder.path());
    let lines = |text: &str| text.lines().map(String::from).collect::<Vec<_>>();
    let [first, second] = [&first, &second].map(|text| lines(text));
    assert_eq!(first.len(), second.len());
    // A reviewer sees the two rows that changed, and nothing of the other lab.
    assert_eq!(first.iter().zip(&second).filter(|(a, b)| a != b).count(), 2);
    assert_eq!(run_in(folder.path(), &["check", "two.md"]).code, 0);
    std::fs::rename(folder.path().join("two.md"), folder.path().join("three.md")).unwrap();
    let done = run_in(folder.path(), &["check", "."]);
    assert!(done.code == 1 && done.stdout.contains("snapshot-without-lesson"), "{}", done.stdout);
    let done = run_in(folder.path(), &["snapshot", ".", "--accept"]);
    assert_eq!(
        done.stdout,
        "stored     ./three.md.snap: 2 labs\nremoved    ./two.md.snap: its lesson is gone\n"
    );
    assert_eq!(run_in(folder.path(), &["check", "."]).code, 0);
}

/// Cached results are not used if the snapshot has changed.
#[test]
fn the_cache_sees_another_snapshot() {
    let folder = with_snapshot();
    let check = || {
        let mut command = program(folder.path(), &["check", "two.md"]);
        let done = command
            .env("LABSPEC_CACHE", folder.path().join("cache").canonicalize().unwrap())
            .output()
            .unwrap();
        (done.status.code().unwrap(), String::from_utf8(done.stdout).unwrap())
    };
    std::fs::create_dir(folder.path().join("cache")).unwrap();
    let first = check();
    assert_eq!((first.0, check()), (0, first.clone()));
    let text = stored(folder.path());
    let row = text.lines().find(|line| line.contains("plot/0/angle")).unwrap();
    std::fs::write(folder.path().join("two.md.snap"), text.replace(row, &row.replace("0.50000", "0.51000")))
        .unwrap();
    let (code, output) = check();
    assert!(code == 1 && output.contains("two.md.snap has 0.51000"), "{output}");
    assert_eq!(check(), (code, output));
    std::fs::remove_file(folder.path().join("two.md.snap")).unwrap();
    let (code, output) = check();
    assert!(code == 0 && !output.contains("snapshot"), "{output}");
}

/// A truncated, edited, empty, huge or binary file, or a folder: a finding with its location, and claims
/// that could not be checked.
#[test]
fn a_file_that_is_no_snapshot_has_a_place() {
    let folder = with_snapshot();
    let (path, text) = (folder.path().join("two.md.snap"), stored(folder.path()));
    let row = text.lines().position(|line| line.contains("plot/0/angle")).unwrap() + 1;
    let half = &text[..text.find("lab \"#2\"").unwrap()];
    let huge = "1".repeat(5 << 20);
    for (bytes, output) in [
        (half.as_bytes(), "the file is incomplete: the line"),
        (
            text.replacen("0.50000", "0.5OOOO", 1).as_bytes(),
            &format!("two.md.snap:{row}:20: `0.5OOOO` is not a value")[..],
        ),
        (b"", "two.md.snap:1:1: the file is not a snapshot"),
        (
            text.replacen("snapshot 1", "snapshot 7", 1).as_bytes(),
            "two.md.snap:1:18: the snapshot has another version",
        ),
        (huge.as_bytes(), "larger than 4 MB, the limit for a snapshot"),
        (b"labspec snapshot 1\n\xff\xfe", "two.md.snap"),
        (
            text.replacen("0.50000", &"9".repeat(2000), 1).as_bytes(),
            "`999999999999999999999999…` is not a value",
        ),
        (
            text.replacen("\"plot/0/angle\"", "\"plot/0/angle", 1).as_bytes(),
            ": this quoted text is incomplete",
        ),
    ] {
        std::fs::write(&path, bytes).unwrap();
        let done = run_in(folder.path(), &["check", "two.md"]);
        assert_eq!(done.code, 1, "{output}");
        let found = done.stdout.contains("error[snapshot-unreadable]") && done.stdout.contains(output);
        assert!(found, "{output}:\n{}", done.stdout);
        assert!(done.stdout.contains("2 snapshots could not be checked"), "{}", done.stdout);
        let done = run_in(folder.path(), &["snapshot", "two.md", "--format", "json"]);
        let report: Value = serde_json::from_str(&done.stdout).unwrap();
        assert_eq!((done.code, &report["files"][0]["status"]), (1, &json!("unreadable")), "{output}");
    }
    assert_eq!(run_in(folder.path(), &["snapshot", "two.md", "--accept"]).code, 0);
    assert_eq!(stored(folder.path()), text);
    std::fs::remove_file(&path).unwrap();
    std::fs::create_dir(&path).unwrap();
    let done = run_in(folder.path(), &["check", "two.md"]);
    assert!(done.code == 1 && done.stdout.contains("it is a folder"), "{}", done.stdout);
}

/// The lessons of the repository agree with their stored snapshots.
#[test]
fn the_lessons_of_the_repository_are_as_stored() {
    let folder = tempfile::tempdir().unwrap();
    for (from, ending) in [("specs/lessons", "md"), ("specs/models", "xml")] {
        let to = folder.path().join(from.trim_start_matches("specs/"));
        std::fs::create_dir(&to).unwrap();
        for entry in std::fs::read_dir(workspace().join(from)).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_some_and(|e| e == ending) {
                std::fs::copy(&path, to.join(path.file_name().unwrap())).unwrap();
            }
        }
    }
    assert_eq!(run_in(folder.path(), &["snapshot", "lessons"]).code, 0);
    let done = run_in(folder.path(), &["check", "lessons"]);
    assert!(done.code == 0 && done.stdout.contains("36 snapshots as stored"), "{}", done.stdout);
}
