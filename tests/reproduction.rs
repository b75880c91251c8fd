//! `labspec check --record FILE` writes the basis of every verdict; `--since FILE` reports changed results and their causes.

#![allow(clippy::unwrap_used)]

use crate::program::{run_in, snapshot};
use crate::support::schema::{problems, schemas};
use crate::support::{read_json, workspace};
use serde_json::{Value, json};
use std::path::Path;
use tempfile::TempDir;

const MODEL: &str = "<mujoco><option integrator='RK4' density='1.2'/><worldbody>\
    <geom name='floor' type='plane' size='1 1 1' friction='0.5 0.005 0.0001'/>\
    <body pos='0 0 1'><freejoint/><geom name='ball' size='.1' mass='1' solref='0.01 1' condim='4'/><geom size='.05' mass='1'/></body>\
    </worldbody></mujoco>";

/// A question about a fall, with a run at another timestep and one with a heavier ball.
fn lesson() -> String {
    let lab = json!({"title": "A fall", "model": "ball", "stopAt": 0.3,
        "controls": [{"label": "timestep h", "set": "model.opt.timestep", "min": 0.001, "max": 0.02, "step": 0.001, "value": 0.002}],
        "plots": [{"traces": [{"label": "height", "expr": "data.qpos[2]"}]}]});
    let quiz = json!({"id": "fall", "questions": [{
        "kind": "mcq", "q": "Where is the ball after 0.3 s?", "options": ["above 0.5 m", "below 0.5 m"], "answer": 0,
        "verify": {
            "lab": "#1",
            "runs": {"coarse": {"set": {"timestep h": 0.02}, "until": 0.3}, "heavy": {"setup": "model.body_mass[1] = 9; mj.mj_setConst(model, data)", "until": 0.3}},
            "measure": {"height": "final(data.qpos[2])", "never": "first(data.qpos[2] > 9)"},
            "options": ["coarse.height > 0.5 && heavy.height > 0.5", "coarse.height < 0.5"],
            "says": [["0.56 m", "heavy.height"]],
        },
    }]});
    format!("# A fall\n\nAfter 0.3 s it is at 0.56 m.\n\n```lab simlab\n{lab}\n```\n\n```quiz\n{quiz}\n```\n")
}

fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for part in ["models", "lessons", "records"] {
        std::fs::create_dir(folder.path().join(part)).unwrap();
    }
    std::fs::write(folder.path().join("models/ball.xml"), MODEL).unwrap();
    std::fs::write(folder.path().join("lessons/fall.md"), lesson()).unwrap();
    folder
}

fn record(folder: &Path, arguments: &[&str]) -> Value {
    let whole = [&["check", "lessons", "--record", "records/now.json"], arguments].concat();
    let done = run_in(folder, &whole);
    assert_eq!(done.stderr, "");
    read_json(&folder.join("records/now.json"))
}

/// The output of `--since` for programs, and the exit code.
fn since(folder: &Path) -> (i32, Value) {
    let done = run_in(folder, &["check", "lessons", "--since", "records/now.json", "--format", "json"]);
    let report: Value = serde_json::from_str(&done.stdout).unwrap();
    (done.code, report["since"].clone())
}

#[test]
fn a_record_states_the_basis_of_every_verdict() {
    let folder = folder();
    let record = record(folder.path(), &[]);
    let mut all = schemas();
    let schema = read_json(&workspace().join("docs/schema/reproduction.json"));
    all.insert("reproduction.json".into(), schema);
    assert_eq!(problems(&all, "reproduction.json", &record), Vec::<String>::new());
    let mut bad = record.clone();
    bad["lessons"][0]["claims"][0]["runs"][0]["settings"]["timestep"] = json!("0.02");
    assert_eq!(problems(&all, "reproduction.json", &bad).len(), 1);

    assert_eq!(record["engine"], "MuJoCo 3.14.0");
    assert_eq!(record["labspec"], env!("CARGO_PKG_VERSION"));
    let lesson = &record["lessons"][0];
    assert_eq!(lesson["file"], "../lessons/fall.md");
    let claim = &lesson["claims"][0];
    let [coarse, heavy] = [0, 1].map(|i| &claim["runs"][i]["settings"]);
    let lab = &lesson["labs"][0]["settings"];
    assert_eq!((&coarse["timestep"], &heavy["timestep"]), (&json!(0.02), &json!(0.002)));
    assert_eq!(
        (&coarse["integrator"], &coarse["solver"], &coarse["cone"]),
        (&json!("RK4"), &json!("Newton"), &json!("pyramidal"))
    );
    assert_eq!((&coarse["iterations"], &coarse["tolerance"]), (&json!(100), &json!(1e-8)));
    assert_eq!(coarse["options"], json!({"density": [1.2]}));
    assert_eq!(
        coarse["contacts"],
        json!({"ball": {"condim": [4.0], "solref": [0.01, 1.0]}, "floor": {"friction": [0.5, 0.005, 0.0001]}})
    );
    // The runs change the model in different ways; the unchanged lab changes nothing.
    assert!(coarse["model"] != heavy["model"] && heavy["model"] != lab["model"]);
    assert_eq!(lesson["labs"][0]["model"], claim["model"]);
    assert_eq!(
        claim["measures"]["coarse.never"],
        json!({"value": null, "halved": null, "nonfinite": {"value": "NaN", "halved": "NaN"}})
    );
    let state = |subject: &str| {
        let mut all = lesson["verdicts"].as_array().unwrap().iter();
        all.find(|v| v["subject"] == subject).map(|v| v["word"].clone()).unwrap()
    };
    assert_eq!((state("answer"), state("quotedNumber")), (json!("verified"), json!("verified")));
}

/// The record has the same bytes with one thread and with four, with a cached and with a new result, and in any folder.
#[test]
fn a_record_is_the_same_everywhere() {
    let text = |arguments: &[&str]| {
        let folder = folder();
        for i in 0..4 {
            std::fs::write(
                folder.path().join(format!("lessons/fall-{i}.md")),
                lesson().replace("\"fall\"", &format!("\"fall-{i}\"")),
            )
            .unwrap();
        }
        record(folder.path(), arguments);
        std::fs::read_to_string(folder.path().join("records/now.json")).unwrap()
    };
    let one = text(&["--jobs", "1"]);
    assert_eq!(one, text(&["--jobs", "4"]));
    assert!(one.ends_with("}\n") && !one.contains("/tmp"));
}

#[test]
fn nothing_has_changed_since_the_same_check() {
    let folder = folder();
    record(folder.path(), &[]);
    assert_eq!(since(folder.path()), (0, json!([])));
    let done = run_in(folder.path(), &["check", "lessons", "--since", "records/now.json"]);
    assert!(done.stdout.contains("nothing has changed since records/now.json"), "{}", done.stdout);
}

/// A changed setting of a run, and its effects: the difference of the value, and the verdict.
#[test]
fn a_changed_setting_is_reported_with_its_effects() {
    let folder = folder();
    record(folder.path(), &[]);
    let path = folder.path().join("lessons/fall.md");
    std::fs::write(&path, lesson().replace("\"timestep h\":0.02", "\"timestep h\":0.01")).unwrap();
    let (code, all) = since(folder.path());
    assert_eq!(code, 0);
    let [change] = all.as_array().unwrap().as_slice() else { panic!("{all}") };
    assert_eq!(
        (&change["file"], &change["owner"]),
        (&json!("../lessons/fall.md"), &json!("quiz fall, question 1"))
    );
    let cause = change["causes"]
        .as_array()
        .unwrap()
        .iter()
        .find(|c| c["what"] == "timestep of the run coarse")
        .unwrap();
    assert_eq!(
        (&cause["before"], &cause["now"], &cause["difference"]),
        (&json!(0.02), &json!(0.01), &json!(-0.01))
    );
    assert!(change["causes"].as_array().unwrap().iter().any(|c| c["what"] == "the text"));
    // The verdict has not changed.
    assert!(!change["effects"].as_array().unwrap().iter().any(|e| e["what"] == "answer"), "{change}");
}

/// A changed model: the changed verdicts, and the differences of numbers.
#[test]
fn a_changed_model_is_reported_with_its_effects() {
    let folder = folder();
    record(folder.path(), &[]);
    let model = MODEL.replace("pos='0 0 1'", "pos='0 0 0.9'").replace("friction='0.5", "friction='0.6");
    std::fs::write(folder.path().join("models/ball.xml"), model).unwrap();
    let (code, all) = since(folder.path());
    assert_eq!(code, 1);
    let question = all.as_array().unwrap().iter().find(|c| c["owner"] == "quiz fall, question 1").unwrap();
    let step = |list: &str, what: &str| {
        let found = question[list].as_array().unwrap().iter().find(|s| s["what"] == what);
        found.unwrap_or_else(|| panic!("{what}: {question:#}")).clone()
    };
    let answer = step("effects", "answer");
    assert_eq!((&answer["before"], &answer["now"]), (&json!("verified"), &json!("refuted")));
    let height = step("effects", "heavy.height");
    assert!((height["difference"].as_f64().unwrap() + 0.1).abs() < 1e-3, "{height}");
    step("causes", "the model");
    let friction = step("causes", "friction of the geom \"floor\" of the run heavy");
    assert_eq!((&friction["before"][0], &friction["now"][0]), (&json!(0.5), &json!(0.6)));
    let done = run_in(folder.path(), &["check", "lessons", "--since", "records/now.json"]);
    let comparison: Vec<&str> = done.stdout.lines().skip_while(|l| !l.starts_with("since ")).collect();
    snapshot("since-model", comparison.join("\n"));
}

/// A file that is not a record is refused with advice, and no input is overwritten.
#[test]
fn a_file_that_is_no_record_is_refused() {
    let folder = folder();
    for text in [
        "",
        "{}",
        "[1",
        "{\"report\": \"reproduction\", \"schemaVersion\": 1}",
        "{\"report\": \"baseline\", \"schemaVersion\": 1}",
    ] {
        std::fs::write(folder.path().join("records/bad.json"), text).unwrap();
        let done = run_in(folder.path(), &["check", "lessons", "--since", "records/bad.json"]);
        assert!(
            done.code == 2 && done.stderr.contains("labspec check --record writes one"),
            "{text}: {}",
            done.stderr
        );
    }
    // After the head, every key must have its type; otherwise the file is refused, without a panic.
    let good = record(folder.path(), &[]);
    for lessons in [
        json!([1, null, {"file": 7}]),
        json!([{"file": "../lessons/fall.md", "labs": 3, "claims": [{"name": "x", "runs": {}}], "verdicts": [null]}]),
        json!([{"file": "\u{1b}[2J".repeat(200), "labs": "\u{1b}[2J".repeat(200)}]),
    ] {
        let mut odd = good.clone();
        odd["lessons"] = lessons;
        std::fs::write(folder.path().join("records/odd.json"), odd.to_string()).unwrap();
        let done = run_in(folder.path(), &["check", "lessons", "--since", "records/odd.json"]);
        assert_eq!(done.code, 2);
        assert!(
            done.stderr.contains("odd.json is not a record of a check: invalid type: "),
            "{}",
            done.stderr
        );
        assert!(done.stderr.len() < 500 && !done.stderr.contains('\u{1b}'), "{}", done.stderr);
    }
    let before = lesson();
    let done = run_in(folder.path(), &["check", "lessons", "--record", "lessons/fall.md"]);
    assert_eq!(
        (done.code, std::fs::read_to_string(folder.path().join("lessons/fall.md")).unwrap()),
        (2, before)
    );
}
