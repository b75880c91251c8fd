//! The program itself: exit codes, what it prints to people and to programs, and what it says when it cannot run.
//!
//! Every command runs in a folder of its own with relative paths, so that snapshots hold no place of this machine;
//! run times are cut out.

#![allow(clippy::unwrap_used)]

use crate::support::{model_text, workspace};
use serde_json::{Value, json};
use std::io::Read;
use std::path::Path;
use std::process::{Command, Stdio};

/// A lesson in which everything is right.
const CLEAN: &str = r##"# A drop

The ball is in the air for 0.440 s.

```lab simlab
{
  "title": "A drop",
  "model": "ball_drop",
  "setup": "data.qpos[2] = 1",
  "controls": [
    {"label": "gravity", "unit": "m/s^2", "set": "model.opt.gravity[2]", "min": -20, "max": -1, "step": 0.1, "value": -9.81, "reset": true},
    {"type": "button", "label": "Kick", "run": "data.qvel[2] = 2"}
  ],
  "plots": [
    {"ylabel": "height (m)", "traces": [{"label": "heavy", "expr": "data.qpos[2]"}, {"label": "light, say", "expr": "data.qpos[9]", "dash": true}]},
    {"ylabel": "contacts", "traces": [{"label": "contacts", "expr": "data.ncon"}]}
  ],
  "readouts": [{"label": "time (s)", "expr": "data.time"}, {"label": "height (m)", "expr": "data.qpos[2]", "digits": 4}]
}
```

```quiz
{
  "id": "drop",
  "questions": [{
    "kind": "predict",
    "q": "Which ball lands first?",
    "options": ["the heavy one", "the light one", "both land together"],
    "answer": 2,
    "sim": {"model": "ball_drop"},
    "verify": {
      "runs": {"drop": {"until": 1}},
      "measure": {"heavy": "before(contact('heavy_geom'), data.time)", "light": "before(contact('light_geom'), data.time)"},
      "options": ["heavy < light", "heavy > light", "heavy === light"],
      "says": [["0.440 s", "heavy"]]
    }
  }]
}
```
"##;

/// The same with a misspelt field, a wrong answer, a wrong number and a control without effect.
fn wrong() -> String {
    CLEAN
        .replace("data.ncon", "data.ncno")
        .replace("\"answer\": 2", "\"answer\": 0")
        .replace("0.440 s.", "0.450 s.")
        .replace("[\"0.440 s\"", "[\"0.450 s\"")
        .replace("model.opt.gravity[2]", "data.xpos[5]")
}

/// A free fall with its closed form.
const FALL: &str = r#"{
  "title": "A fall",
  "model": "free_fall",
  "stopAt": 0.4,
  "controls": [{"label": "timestep", "set": "model.opt.timestep", "min": 0.001, "max": 0.01, "value": 0.002}],
  "plots": [{"ylabel": "error (mm)", "traces": [{"label": "height", "expr": "data.qpos[2]"}]}],
  "verify": {"exact": {"height": "1 - 0.5 * 9.81 * data.time * data.time"}}
}"#;

/// A folder with lessons and models.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    };
    write("clean.md", CLEAN);
    write("wrong.md", &wrong());
    write("fall.json", FALL);
    write("models/free_fall.xml", &model_text("free_fall"));
    write("models/ball_drop.xml", &model_text("ball_drop"));
    write(
        "broken/models/ball_drop.xml",
        "<mujoco><worldbody><body><goem size='1'/></body></worldbody></mujoco>",
    );
    write("broken/lesson.md", CLEAN);
    write("empty/notes.txt", "no lessons here");
    write("course/a.md", CLEAN);
    write("course/package.json", "{\"name\": \"not ours\"}");
    folder
}

/// What a command came to.
struct Done {
    code: i32,
    stdout: String,
    stderr: String,
}

fn program(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_labspec"));
    command.current_dir(folder).args(arguments).env_remove("CLICOLOR_FORCE").stdin(Stdio::null());
    command
}

fn run_in(folder: &Path, arguments: &[&str]) -> Done {
    let output = program(folder, arguments).output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    Done { code: output.status.code().unwrap(), stdout: text(output.stdout), stderr: text(output.stderr) }
}

fn run(arguments: &[&str]) -> Done {
    run_in(folder().path(), arguments)
}

/// Runs a command that must succeed and print JSON.
fn json_of(arguments: &[&str]) -> Value {
    let done = run(arguments);
    assert_eq!((done.code, done.stderr.as_str()), (0, ""), "{arguments:?}");
    serde_json::from_str(&done.stdout).unwrap()
}

/// Command, exit code and everything printed.
fn shown(arguments: &[&str]) -> String {
    let done = run(arguments);
    let part = |name: &str, text: &str| match text {
        "" => String::new(),
        text => format!("--- {name}\n{text}"),
    };
    format!(
        "labspec {}\nexit {}\n{}{}",
        arguments.join(" "),
        done.code,
        part("stdout", &done.stdout),
        part("stderr", &done.stderr)
    )
}

fn snapshot(name: &str, text: String) {
    insta::with_settings!({prepend_module_to_snapshot => false, omit_expression => true}, {
        insta::assert_snapshot!(format!("cli-{name}"), text);
    });
}

fn keys(value: &Value) -> Vec<&str> {
    value.as_object().unwrap().keys().map(String::as_str).collect()
}

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
    if !shared.exists() {
        println!("skipped: {} is not there", shared.display());
        return;
    }
    let arguments = ["check", "lesson-0.1/lesson-0.1.md", "--models", "corpus/models", "--format", "json"];
    let report: Value = serde_json::from_str(&run_in(&shared, &arguments).stdout).unwrap();
    let findings = report["findings"].as_array().unwrap();
    let codes: Vec<&str> = findings.iter().filter_map(|f| f["code"].as_str()).collect();
    // `<option>` in the text and in an explanation, which a browser swallows; nothing else.
    assert_eq!(codes, ["unescaped-element"; 2]);
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
    assert!(keys(&report).ends_with(&["lessons"]), "{:?}", keys(&report));
    let lesson = &report["lessons"][0];
    assert_eq!(keys(lesson), ["file", "labs", "claims"]);
    assert_eq!(keys(&lesson["labs"][0]), ["address", "title", "runs", "ran"]);
    assert_eq!(keys(&lesson["claims"][0]), ["name", "line", "verdict", "measures", "quotes"]);
    assert_eq!(lesson["claims"][0]["verdict"], "refuted");
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

#[test]
fn run_for_people() {
    snapshot("run", shown(&["run", "clean.md#1", "--until", "1"]));
    snapshot("run-set", shown(&["run", "clean.md#1", "--set", "gravity=-1.6", "--press", "Kick@0.5"]));
    // A question's sim, and a model alone.
    snapshot("run-sim", shown(&["run", "clean.md#drop.1", "--steps", "3"]));
}

#[test]
fn run_for_programs() {
    let table = json_of(&["run", "clean.md#1", "--steps", "500", "--every", "100", "--format", "json"]);
    assert_eq!(keys(&table), ["version", "timestep", "columns", "rows", "warnings", "errors"]);
    let columns = [
        "time",
        "plot/0/heavy",
        "plot/0/light, say",
        "plot/1/contacts",
        "readout/time (s)",
        "readout/height (m)",
    ];
    assert_eq!(table["columns"], json!(columns));
    let rows = table["rows"].as_array().unwrap();
    assert_eq!(rows.len(), 6);
    assert_eq!(rows[0], json!([0.0, 1.0, 1.0, 0.0, 0.0, 1.0]));
    assert_eq!((&rows[5][3], &table["warnings"], &table["errors"]), (&json!(2.0), &json!({}), &json!([])));

    let csv = run(&["run", "clean.md#1", "--steps", "500", "--every", "250", "--format", "csv"]);
    let lines: Vec<&str> = csv.stdout.lines().collect();
    assert_eq!(
        lines[0],
        "time,plot/0/heavy,\"plot/0/light, say\",plot/1/contacts,readout/time (s),readout/height (m)"
    );
    assert_eq!((lines.len(), lines[1]), (4, "0,1,1,0,0,1"));
    // Both say the same, to the last bit.
    let last: Vec<f64> = lines[3].split(',').map(|x| x.parse().unwrap()).collect();
    let whole = run(&["run", "clean.md#1", "--steps", "500", "--every", "500", "--format", "json"]).stdout;
    let row = format!("{last:?}").replace(' ', "");
    assert!(whole.contains(&row), "{row} is not in {whole}");
}

#[test]
fn run_writes_files() {
    let folder = folder();
    let arguments =
        ["run", "clean.md#1", "--until", "1", "--csv", "a.csv", "--json", "a.json", "--svg", "a.svg"];
    assert_eq!(run_in(folder.path(), &arguments).code, 0);
    let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
    assert_eq!(read("a.csv").lines().count(), 502);
    assert_eq!(
        serde_json::from_str::<Value>(&read("a.json")).unwrap()["rows"].as_array().unwrap().len(),
        501
    );
    for (name, label) in [("a.svg", "heavy"), ("a-2.svg", "contacts")] {
        let svg = read(name);
        assert!(
            svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>") && svg.contains(label),
            "{name}"
        );
    }
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
fn a_run_that_breaks_is_a_finding() {
    let folder = folder();
    let lab = json!({"model": "free_fall", "setup": "data.qvel[2] = 1e11"});
    std::fs::write(folder.path().join("breaks.json"), lab.to_string()).unwrap();
    let done = run_in(folder.path(), &["run", "breaks.json", "--steps", "2"]);
    assert_eq!(done.code, 1);
    assert!(done.stdout.contains("warning: badqvel"), "{}", done.stdout);
    assert_eq!(run_in(folder.path(), &["check", "breaks.json"]).code, 1);
}

#[test]
fn plan_gives_reasons() {
    snapshot("plan", shown(&["plan", "fall.json"]));
    let plan = json_of(&["plan", "clean.md#1", "--format", "json"]);
    assert_eq!(keys(&plan), ["reads", "writes", "stages"]);
    assert_eq!(plan["reads"], json!(["time", "qpos", "ncon"]));
    assert_eq!(keys(&plan["stages"][0]), ["stage", "keep", "reason"]);
}

#[test]
fn precision_against_the_closed_form() {
    let table = shown(&["precision", "fall.json"]);
    // The last column is run time, which is this machine's.
    let stripped: Vec<String> = table
        .lines()
        .map(|line| match line.trim_start() {
            l if l.starts_with("Euler") || l.starts_with("RK4") => {
                line.trim_end().trim_end_matches(|c: char| c.is_ascii_digit()).trim_end().to_string()
            }
            _ => line.to_string(),
        })
        .collect();
    snapshot("precision", stripped.join("\n"));
    let report = json_of(&["precision", "fall.json", "--format", "json", "--until", "0.2"]);
    assert_eq!(keys(&report), ["traces", "truth", "uncertainty", "length", "rows"]);
    assert_eq!(report["truth"], json!(["closed form"]));
    assert_eq!(
        keys(&report["rows"][0]),
        ["integrator", "timestep", "errors", "orders", "us_per_second", "diverged"]
    );
    // Euler is of first order: the error is g h t / 2.
    let error = report["rows"][2]["errors"][0].as_f64().unwrap();
    assert!((error - 9.81 * 0.002 * 0.2 / 2.0).abs() < 1e-12, "{error}");

    let folder = folder();
    assert_eq!(run_in(folder.path(), &["precision", "fall.json", "--svg", "p.svg"]).code, 0);
    assert!(std::fs::read_to_string(folder.path().join("p.svg")).unwrap().starts_with("<svg"));
}

#[test]
fn record_repeats_the_states_of_a_recording() {
    let folder = folder();
    let state = |z: f64| {
        json!({
            "qpos": [-0.2, 0.0, z, 1.0, 0.0, 0.0, 0.0, 0.2, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0], "qvel": vec![0.0; 12],
            "act": [], "ctrl": [], "mocap_pos": [], "mocap_quat": [], "ncon": 0, "contact": [], "xpos": [], "M": []
        })
    };
    let oracle = json!({
        "sizes": {"nq": 0, "nv": 0}, "model": {"body_mass": [], "no_such_field": []}, "forward": [state(1.0), state(0.04)]
    });
    std::fs::write(folder.path().join("states.json"), oracle.to_string()).unwrap();
    let arguments =
        ["record", "models/ball_drop.xml", "--states", "states.json", "--steps", "300", "--every", "50"];
    let done = run_in(folder.path(), &[&arguments[..], &["--tight", "--option", "timestep=0.001"]].concat());
    assert_eq!((done.code, done.stderr.as_str()), (0, ""));
    let ours: Value = serde_json::from_str(&done.stdout).unwrap();
    assert_eq!(keys(&ours), ["version", "sizes", "names", "model", "forward", "trajectory", "warnings"]);
    assert_eq!(ours["sizes"], json!({"nq": 14, "nv": 12}));
    assert_eq!(ours["model"], json!({"body_mass": [0.0, 2.0, 0.1]}));
    let counts: Vec<&Value> = ours["forward"].as_array().unwrap().iter().map(|f| &f["ncon"]).collect();
    assert_eq!(counts, [&json!(0), &json!(1)]);
    let contact = &ours["forward"][1]["contact"][0];
    assert_eq!(
        keys(contact),
        ["geom1", "geom2", "dist", "pos", "frame", "friction", "dim", "solref", "solimp"]
    );
    assert!((contact["dist"].as_f64().unwrap() + 0.01).abs() < 1e-15);
    let rows = ours["trajectory"].as_array().unwrap();
    assert_eq!(rows.len(), 7);
    assert!((rows[6]["time"].as_f64().unwrap() - 0.3).abs() < 1e-12);
    for (option, why) in
        [("timestp=1", "no field"), ("timestep=fast", "not a number"), ("timestep", "NAME=VALUE")]
    {
        let done = run_in(folder.path(), &[&arguments[..], &["--option", option]].concat());
        assert!(done.code == 2 && done.stderr.contains(why), "{}", done.stderr);
    }
}

/// The bits of a state survive the way through JSON: a reader that is off by one in the last place would show as
/// a difference between engines that there is not.
#[test]
fn record_keeps_every_bit() {
    let folder = folder();
    // A number that takes 17 digits, and correct rounding when it is read.
    let z = 0.800_837_999_999_999_9_f64;
    let mut worst = Vec::new();
    for i in 0..200 {
        let z = z + f64::from(i) * 1.234_567_890_123_4e-3;
        let state = json!({
            "qpos": [0.0, 0.0, z, 1.0, 0.0, 0.0, 0.0], "qvel": vec![0.0; 6],
            "act": [], "ctrl": [], "mocap_pos": [], "mocap_quat": [], "xpos": []
        });
        worst.push((z, state));
    }
    let states: Vec<&Value> = worst.iter().map(|(_, s)| s).collect();
    std::fs::write(folder.path().join("s.json"), json!({"forward": states}).to_string()).unwrap();
    let done =
        run_in(folder.path(), &["record", "models/free_fall.xml", "--states", "s.json", "--steps", "0"]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    // Words, not numbers: this test's own reader must not round either.
    for (z, _) in worst {
        assert!(done.stdout.contains(&format!("\"xpos\":[0.0,0.0,0.0,0.0,0.0,{z:?}]")), "{z:?}");
    }
}

/// The numbers of a lab, too, are read to the last bit.
#[test]
fn labs_keep_every_bit() {
    let folder = folder();
    for z in [0.900_837_999_099_995_3_f64, 0.1, 2.2250738585072014e-308, 123_456_789.123_456_79] {
        let lab = format!(
            r#"{{"model": "free_fall", "readouts": [{{"label": "p", "expr": "ctx.p"}}, {{"label": "e", "expr": "{z:?}"}}],
            "controls": [{{"label": "p", "param": "p", "min": 0, "max": 1e9, "value": {z:?}}}]}}"#
        );
        std::fs::write(folder.path().join("p.json"), lab).unwrap();
        let done = run_in(folder.path(), &["run", "p.json", "--steps", "0", "--format", "csv"]);
        let read: Vec<f64> =
            done.stdout.lines().nth(1).unwrap().split(',').map(|x| x.parse().unwrap()).collect();
        assert_eq!(read, [0.0, z, z]);
    }
}

#[test]
fn bench_prints_json() {
    for target in ["models/ball_drop.xml", "clean.md#1"] {
        let bench = json_of(&["bench", target, "--steps", "200", "--warm", "10", "--repeat", "3"]);
        assert_eq!(keys(&bench), ["min_ns", "median_ns", "steps", "nv", "ncon", "nefc", "time"]);
        assert_eq!((&bench["steps"], &bench["nv"]), (&json!(200), &json!(12)));
        assert!(bench["min_ns"].as_f64().unwrap() <= bench["median_ns"].as_f64().unwrap());
    }
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
