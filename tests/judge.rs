//! `--judge-request FILE` and `--judge FILE`: comparison with the real library. `tests/golden/judge.json` was recorded from
//! MuJoCo 3.14.0 by `tests/judge/record.mjs`.

#![allow(clippy::unwrap_used)]

use crate::needs::needs;
use crate::program::run_in;
use crate::support::{read_json, recording, workspace};
use serde_json::{Value, json};
use std::path::Path;
use tempfile::TempDir;

const BALL: &str = "<mujoco><include file='floor.xml'/><worldbody>\
    <body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.1' mass='1'/></body></worldbody></mujoco>";
const FLOOR: &str = "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/></worldbody></mujoco>";

/// A question with a run of the unchanged lab, one with a changed model, and a sweep.
fn lesson() -> String {
    let lab = json!({"title": "A fall", "model": "ball", "stopAt": 0.3,
        "controls": [{"label": "gravity", "apply": "model.opt.gravity[2] = -value", "min": 1, "max": 20, "step": 1, "value": 10, "reset": true}],
        "plots": [{"traces": [{"label": "height", "expr": "data.qpos[2]"}]}]});
    let quiz = json!({"id": "fall", "questions": [{
        "kind": "mcq", "q": "Where is the ball after 0.3 s?", "options": ["above 0.5 m", "below 0.5 m"], "answer": 0,
        "verify": {
            "lab": "#1",
            "runs": {"plain": {}, "high": {"model": {"body ball pos": "0 0 2"}}, "many": {"sweep": {"gravity": [5, 10]}}},
            "measure": {"height": "final(data.qpos[2])", "never": "first(contact('ball', 'floor'))"},
            "options": ["plain.height > 0.5 && high.height > 1.5", "plain.height < 0.5"],
            "says": [["0.55 m", "plain.height"]],
        },
    }]});
    format!("# A fall\n\nAfter 0.3 s it is at 0.55 m.\n\n```lab simlab\n{lab}\n```\n\n```quiz\n{quiz}\n```\n")
}

fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("models")).unwrap();
    for (name, text) in [("models/ball.xml", BALL), ("models/floor.xml", FLOOR), ("fall.md", &lesson())] {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    folder
}

/// The request for the lesson, and a recording with exactly our results.
fn asked(folder: &Path) -> (Value, Value) {
    let done = run_in(folder, &["verify", "fall.md", "--judge-request", "request.json", "--format", "json"]);
    assert_eq!((done.code, done.stderr.as_str()), (0, ""), "{}", done.stdout);
    let report: Value = serde_json::from_str(&done.stdout).unwrap();
    let value = |claim: &Value, run: &str| {
        let claims = report["lessons"][0]["claims"].as_array().unwrap();
        let measures = &claims.iter().find(|c| c["name"] == *claim).unwrap()["measures"];
        let name = match run.split_once('[') {
            Some((sweep, at)) => format!("{sweep}.height[{at}"),
            None => format!("{run}.height"),
        };
        // The measure of the only run has no prefix.
        measures.get(name.as_str()).unwrap_or(&measures["height"])["value"].clone()
    };
    let request = read_json(&folder.join("request.json"));
    let run = |r: &Value| {
        json!({"file": r["file"], "claim": r["claim"], "run": r["run"], "hash": r["hash"],
            "values": {"height": value(&r["claim"], r["run"].as_str().unwrap()), "never": "NaN"}})
    };
    let runs: Vec<Value> = request["runs"].as_array().unwrap().iter().map(run).collect();
    (request, json!({"recording": "judge", "version": 1, "engine": "MuJoCo 3.14.0", "runs": runs}))
}

/// The exit code, the report, and the output for people, with this recording.
fn judged(folder: &Path, recording: &Value) -> (i32, Value, String) {
    std::fs::write(folder.join("judge.json"), recording.to_string()).unwrap();
    let [machine, human] = [&["--format", "json"][..], &[]]
        .map(|more| run_in(folder, &[&["verify", "fall.md", "--judge", "judge.json"], more].concat()));
    assert_eq!(machine.code, human.code);
    (machine.code, serde_json::from_str(&machine.stdout).unwrap(), human.stdout)
}

#[test]
fn every_measure_of_the_course_agrees_with_mujoco() {
    let recorded = recording("judge");
    let runs = recorded["runs"].as_array().unwrap();
    let count: usize = runs.iter().map(|r| r["values"].as_object().unwrap().len()).sum();
    assert!(runs.len() >= 147 && count >= 815, "{} runs, {count} measures", runs.len());
    let arguments = ["verify", "specs/lessons", "--judge", "tests/golden/judge.json", "--format", "json"];
    let done = run_in(&workspace(), &arguments);
    let report: Value = serde_json::from_str(&done.stdout).unwrap();
    let judge = &report["judge"];
    assert_eq!(judge["engine"], "MuJoCo 3.14.0");
    assert_eq!((&judge["differing"], &judge["unjudged"]), (&json!([]), &json!([])));
    assert_eq!((&judge["compared"], &judge["turned"]), (&json!(count), &json!(0)));
    // Closed forms are not compared with the recording, and the report counts them.
    let forms = report["ledger"].as_array().unwrap().iter();
    let forms = forms.filter(|claim| claim["subject"] == "closedForm").count();
    assert!(forms > 0);
    assert_eq!(judge["notJudged"], json!({"searches": 0, "ranges": 0, "closedForms": forms}));
    assert!(judge["verdicts"].as_u64() >= Some(373), "{}", judge["verdicts"]);
    assert_eq!(done.code, 0);
}

#[test]
fn a_request_holds_the_models_as_the_runs_have_them() {
    let folder = folder();
    let (request, _) = asked(folder.path());
    let runs = request["runs"].as_array().unwrap();
    let names: Vec<&str> = runs.iter().map(|r| r["run"].as_str().unwrap()).collect();
    assert_eq!(names, ["plain", "high", "many[0]", "many[1]"]);
    let xml = |i: usize| runs[i]["task"]["xml"].as_str().unwrap();
    assert!(xml(0).contains("name=\"floor\"") && !xml(0).contains("include"), "{}", xml(0));
    assert!(xml(0).contains("pos=\"0 0 1\"") && xml(1).contains("pos=\"0 0 2\""));
    assert_eq!(
        (&runs[2]["task"]["set"], &runs[2]["task"]["until"], &runs[2]["task"]["stopAt"]),
        (&json!([["gravity", 5.0]]), &json!(0.3), &json!(0.3))
    );
    assert_eq!(runs[0]["task"]["measures"][0], json!(["height", "final(data.qpos[2])"]));
}

#[test]
fn a_recording_that_agrees_changes_no_verdict() {
    let folder = folder();
    let (_, recording) = asked(folder.path());
    let (code, report, stdout) = judged(folder.path(), &recording);
    assert_eq!((code, &report["findings"]), (0, &json!([])));
    assert_eq!((&report["judge"]["compared"], &report["judge"]["turned"]), (&json!(8), &json!(0)));
    assert!(
        stdout.contains("judge.json: agrees with MuJoCo 3.14.0: 8 of 8 measures, all 2 verdicts\n"),
        "{stdout}"
    );
}

/// Claims that depend on runs that are not recorded are counted, and "all" then refers to the rest only.
#[test]
fn unjudged_claims_are_counted() {
    let folder = folder();
    let verify = json!({"runs": {"plain": {}}, "measure": {"height": "final(data.qpos[2])"},
        "find": {"limit": {"largest": "gravity", "from": 5, "to": 15, "run": "plain", "while": "height > 0.5", "tol": 0.01}},
        "says": [["11.0 m/s^2", "limit"]],
        "exact": {"height": "1 - 0.5 * 10 * data.time * data.time"}});
    let text = lesson()
        .replace("at 0.55 m.", "at 0.55 m. Above 0.5 m it is up to 11.0 m/s^2.")
        .replace("\"says\":", "\"over\":{\"gravity\":[9,10]},\"says\":")
        .replace("\"stopAt\":", &format!("\"verify\":{verify},\"stopAt\":"));
    std::fs::write(folder.path().join("fall.md"), text).unwrap();
    let (request, recording) = asked(folder.path());
    assert_eq!(request["runs"].as_array().unwrap().len(), 5);
    let (code, report, stdout) = judged(folder.path(), &recording);
    assert_eq!((code, &report["judge"]["unjudged"]), (0, &json!([])), "{stdout}");
    assert_eq!(report["judge"]["notJudged"], json!({"searches": 1, "ranges": 1, "closedForms": 1}));
    assert!(
        stdout.contains(
            "9 of 9 measures, all 3 judged verdicts; not judged: 1 search, 1 range, 1 closed form\n"
        ),
        "{stdout}"
    );
}

#[test]
fn a_changed_verdict_is_reported() {
    let folder = folder();
    let (_, mut recording) = asked(folder.path());
    recording["runs"][0]["values"]["height"] = json!(0.46);
    let (code, report, stdout) = judged(folder.path(), &recording);
    assert_eq!(code, 1);
    let found: Vec<(&str, &str)> = report["findings"]
        .as_array()
        .unwrap()
        .iter()
        .map(|f| (f["code"].as_str().unwrap(), f["message"].as_str().unwrap()))
        .collect();
    assert_eq!(
        found,
        [
            (
                "engine-dependent",
                "this answer depends on the engine: verified with labspec, but refuted with MuJoCo 3.14.0"
            ),
            (
                "engine-dependent",
                "\"0.55 m\" depends on the engine: verified with labspec, but refuted with MuJoCo 3.14.0"
            ),
        ]
    );
    assert_eq!(report["judge"]["differing"][0]["theirs"], json!(0.46));
    assert!(stdout.contains("differs from MuJoCo 3.14.0: 7 of 8 measures, 0 of 2 verdicts"), "{stdout}");
    assert!(stdout.contains("`plain.height` is"), "{stdout}");

    // A different number that changes no verdict is reported, and is not a failure.
    let (_, mut recording) = asked(folder.path());
    recording["runs"][2]["values"]["height"] = json!(0.7);
    let (code, report, stdout) = judged(folder.path(), &recording);
    assert_eq!((code, &report["findings"], &report["judge"]["turned"]), (0, &json!([]), &json!(0)));
    assert!(
        stdout.contains("7 of 8 measures, all 2 verdicts") && stdout.contains("`many[0].height` is"),
        "{stdout}"
    );

    // A run that fails only in the recording is not evidence there.
    let (_, mut recording) = asked(folder.path());
    recording["runs"][0]["broke"] = json!("badqacc at t = 0.1 s");
    assert_eq!(judged(folder.path(), &recording).0, 1);
}

#[test]
fn a_measure_without_a_value_there_is_explained() {
    let folder = folder();
    let (_, mut recording) = asked(folder.path());
    recording["runs"][0]["values"]["height"] = json!("NaN");
    recording["runs"][0]["nan"] = json!({"height": "in `first(x > 1)`, the condition never holds"});
    let (code, report, stdout) = judged(folder.path(), &recording);
    assert_eq!(code, 1);
    let why = "in `first(x > 1)`, the condition never holds there";
    assert_eq!(report["judge"]["differing"][0]["reason"], json!(why));
    assert!(stdout.contains(&format!("but NaN in the recording: {why}")), "{stdout}");
    // A value that only we lack is explained as well.
    let (_, mut recording) = asked(folder.path());
    recording["runs"][0]["values"]["never"] = json!(0.1);
    let (_, _, stdout) = judged(folder.path(), &recording);
    let why = "in `first(contact('ball', 'floor'))`, the condition never holds here";
    assert!(stdout.contains(&format!("but 0.1 in the recording: {why}")), "{stdout}");
}

/// The recording program states why a measure is NaN.
#[test]
fn the_recording_program_explains_nan() {
    if !needs("node") {
        return;
    }
    let program = "import { measure } from './measures.mjs';
        const m = measure('2 * first(x > 1)', ['x']), n = measure('final(x)', ['x']), o = measure('at(y > first(x > 1), x)', ['x', 'y']);
        for (const [t, x] of [[0, 0.5], [1, NaN]]) { m.sample([x], t); n.sample([x], t); o.sample([x, 1], t); }
        console.log(m.absent()); console.log(n.absent()); console.log(o.absent());";
    let file = workspace().join("tests/judge");
    let done = std::process::Command::new("node")
        .args(["--input-type=module", "-e", program])
        .current_dir(file)
        .output()
        .unwrap();
    let lines = String::from_utf8_lossy(&done.stdout).into_owned();
    let expected = "in `first(x > 1)`, the condition never holds\nin `final(x)`, a sample has no number\nin `first(x > 1)`, the condition never holds\n";
    assert_eq!(lines, expected, "{}", String::from_utf8_lossy(&done.stderr));
}

#[test]
fn a_recording_of_another_text_is_reported_and_not_used() {
    let folder = folder();
    let (_, mut recording) = asked(folder.path());
    recording["runs"][0]["values"]["height"] = json!(0.46);
    let text = lesson().replace("\"value\":10", "\"value\":11").replace("0.55 m", "0.50 m");
    std::fs::write(folder.path().join("fall.md"), text).unwrap();
    let (code, report, stdout) = judged(folder.path(), &recording);
    assert_eq!((&report["judge"]["staleRuns"], &report["judge"]["compared"]), (&json!(4), &json!(0)));
    assert!(report["findings"].as_array().unwrap().iter().all(|f| f["code"] != "engine-dependent"));
    assert_eq!(code, 3, "{stdout}");
    assert!(stdout.contains("not judged 8 measures: the lesson or its model has changed"), "{stdout}");

    // Runs that are not recorded, and measures that the recorder could not evaluate.
    let (_, mut recording) = asked(folder.path());
    recording["runs"].as_array_mut().unwrap().truncate(1);
    recording["runs"][0]["values"].as_object_mut().unwrap().remove("never");
    recording["runs"][0]["refused"] = json!({"never": "first is not known"});
    let (code, report, stdout) = judged(folder.path(), &recording);
    assert_eq!((code, &report["judge"]["missingRuns"]), (3, &json!(3)));
    assert!(stdout.contains("not judged 1 measure: first is not known"), "{stdout}");
    assert!(stdout.contains("not judged 6 measures: its run is not recorded"), "{stdout}");
}

#[test]
fn invalid_recordings_are_refused() {
    let folder = folder();
    let (_, good) = asked(folder.path());
    let with = |change: &dyn Fn(&mut Value)| {
        let mut bad = good.clone();
        change(&mut bad);
        bad.to_string()
    };
    let twice = with(&|r| {
        let mut again = r["runs"][0].clone();
        again["values"]["height"] = json!(7);
        r["runs"].as_array_mut().unwrap().push(again);
    });
    let cases = [
        ("{", "EOF"),
        ("[]", "its version is missing"),
        ("{\"recording\": \"judge\", \"version\": 2}", "its version is missing or unsupported"),
        (&with(&|r| r["engine"] = json!("")), "does not name its engine"),
        (&with(&|r| r["runs"] = json!(5)), "has no runs"),
        (&with(&|r| r["runs"][0]["hash"] = json!(5)), "run 0 has no \"hash\""),
        (
            &with(&|r| r["runs"][1]["values"]["height"] = json!("high")),
            "the value of \"height\" is not a number",
        ),
        (&with(&|r| r["runs"][0]["warnings"] = json!(-1)), "\"warnings\""),
        (&twice, "recorded twice"),
    ];
    for (text, why) in cases {
        std::fs::write(folder.path().join("judge.json"), text).unwrap();
        let done = run_in(folder.path(), &["check", "fall.md", "--judge", "judge.json"]);
        assert_eq!(done.code, 2, "{text}");
        assert!(
            done.stderr.contains("judge.json is not a recording of a cross-check")
                && done.stderr.contains(why),
            "{}",
            done.stderr
        );
    }
    let done = run_in(folder.path(), &["check", "fall.md", "--judge", "nothing.json"]);
    assert_eq!(done.code, 2);
}
