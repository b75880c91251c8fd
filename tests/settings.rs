//! Settings that a student cannot make are refused, in the runs of a `verify` object and on the command line,
//! with the possible values.

#![allow(clippy::unwrap_used)]

use crate::support::{check_text, codes, compile};
use labspec::bind::Programs;
use labspec::check::Checked;
use labspec::lint::ModelFolder;
use labspec::lint::load_lesson;
use labspec::run::{self, RunOptions};
use labspec::source::SourceFile;
use labspec::spec::Lab;
use labspec_expr::Value;
use serde_json::{Value as Json, json};

const FALL: &str = "<mujoco><worldbody><body name='ball' pos='0 0 1'><freejoint/><geom size='0.05'/></body></worldbody></mujoco>";

/// A lab with a select, a slider and a button.
fn lab(verify: &Json) -> Json {
    json!({
        "xml": FALL,
        "controls": [
            {"type": "select", "label": "integrator", "set": "model.opt.integrator",
             "options": [["Euler", 0], ["discrete", 4]], "value": 0},
            {"label": "gravity", "set": "model.opt.gravity[2]", "min": -20, "max": 0, "step": 0.25, "value": -9.75},
            {"type": "button", "label": "Kick", "run": "data.qvel[2] = 3"}
        ],
        "readouts": [{"label": "height", "expr": "data.qpos[2]"}],
        "verify": verify
    })
}

/// The check of a lab with one run and two measures.
fn checked(run: &Json) -> (Checked, String) {
    let measure = json!({"kind": "final(model.opt.integrator)", "g": "final(model.opt.gravity[2])"});
    let text = lab(&json!({"runs": {"one": run}, "measure": measure, "says": []})).to_string();
    let mut checked = check_text("lab.json", &text);
    checked.findings.retain(|f| f.code != "verify-nothing");
    (checked, text)
}

fn measured(run: &Json, name: &str) -> f64 {
    let (checked, _) = checked(run);
    assert_eq!(codes(&checked), Vec::<&str>::new(), "{run}");
    checked.claims[0].judgement.measures.iter().find(|m| m.name.ends_with(name)).unwrap().value
}

/// The source text of the finding about a refused run, and its message.
fn refused(run: &Json) -> (String, String) {
    let (checked, text) = checked(run);
    // An unknown label is found without a run.
    let expected = |c: &str| c == "run-impossible" || c == "unknown-control";
    assert!(codes(&checked).into_iter().all(expected), "{run}: {:?}", checked.findings);
    assert!(checked.claims[0].judgement.unmade.is_some());
    let finding = checked.findings.iter().find(|f| expected(f.code)).unwrap();
    let help = finding.help.clone().unwrap_or_default();
    (text[finding.span.clone()].to_string(), format!("{}; {help}", finding.message))
}

#[test]
fn the_text_of_an_option_means_its_value_in_a_verified_run() {
    assert_eq!(measured(&json!({"set": {"integrator": "discrete"}, "until": 0.1}), "kind"), 4.0);
    assert_eq!(measured(&json!({"set": {"integrator": 4}, "until": 0.1}), "kind"), 4.0);
    assert_eq!(measured(&json!({"set": {"gravity": -4.75}, "until": 0.1}), "g"), -4.75);
}

#[test]
fn a_verified_run_with_a_setting_that_no_student_can_make_is_refused_at_its_value() {
    let cases = [
        (
            json!({"integrator": 3}),
            "3",
            "3 is not an option of \"integrator\"; its options are 0 (\"Euler\"), 4 (\"discrete\")",
        ),
        (json!({"integrator": "RK4"}), "RK4", "the text \"RK4\" is not an option"),
        (json!({"gravity": -25}), "-25", "\"gravity\" goes from -20 to 0: -25 cannot be chosen"),
        (json!({"gravity": -4.9}), "-4.9", "the nearest values are -5 and -4.75"),
        (json!({"gravity": "moon"}), "moon", "it needs a number from -20 to 0, not the text \"moon\""),
        (json!({"gravity": true}), "true", "it needs a number from -20 to 0, not true"),
        (json!({"Kick": 1}), "Kick", "press it instead of setting it"),
        (json!({"gravty": -5}), "gravty", "did you mean `gravity`?"),
    ];
    for (set, place, expected) in cases {
        let (at, message) = refused(&json!({"set": set, "until": 0.1}));
        assert_eq!(at, place, "{set}");
        assert!(message.contains(expected), "{message}");
    }
}

#[test]
fn a_press_that_never_happens_is_refused() {
    let (_, late) = refused(&json!({"press": [["Kick", 0.5]], "until": 0.1}));
    assert!(late.contains("\"Kick\" would be pressed at 0.5 s, but the run ends at 0.1 s"), "{late}");
    // The last step begins before it.
    let (_, end) = refused(&json!({"press": [["Kick", 0.1]], "until": 0.1}));
    assert!(end.contains("its last step begins at 0.098 s"), "{end}");
    let (_, before) = refused(&json!({"press": [["Kick", -1]], "until": 0.1}));
    assert!(before.contains("\"Kick\" cannot be pressed at -1 s"), "{before}");
    assert_eq!(measured(&json!({"press": [["Kick", 0.098]], "until": 0.1}), "kind"), 0.0);
}

/// Runs the same lab with the library, as `labspec run` does.
fn run_with(set: &[(&str, Value)], press: &[(&str, f64)]) -> Result<f64, String> {
    let lesson = load_lesson(
        // The initial value is between two steps of the slider.
        SourceFile::new("lab.json", lab(&json!({"says": []})).to_string().replace("-9.75", "-9.81")),
        &ModelFolder::unknown(),
    );
    let lab: &Lab = lesson.all_labs()[0];
    let model = compile(FALL);
    let programs = Programs::compile(lab, &model, &mut Vec::new());
    let options = RunOptions {
        until: Some(0.1),
        set: set.iter().map(|(l, v)| ((*l).into(), v.clone())).collect(),
        press: press.iter().map(|(l, t)| ((*l).into(), *t)).collect(),
        ..RunOptions::default()
    };
    let table = run::run(lab, &model, &programs, &options).map_err(|e| e.to_string())?;
    Ok(table.rows.last().unwrap()[1].number())
}

#[test]
fn a_run_accepts_only_settings_that_a_student_can_make() {
    let fell = run_with(&[], &[]).unwrap();
    assert_eq!(run_with(&[("gravity", Value::Number(-9.81))], &[]), Ok(fell), "the start is always possible");
    assert!(run_with(&[("integrator", "discrete".into())], &[]).is_ok());
    assert!(run_with(&[], &[("Kick", 0.05)]).unwrap() > fell);
    for (set, message) in [
        (("integrator", "Discrete".into()), "is not an option"),
        (("gravity", Value::Number(f64::NAN)), "cannot be chosen"),
        (("gravity", Value::Number(f64::NEG_INFINITY)), "cannot be chosen"),
        (("gravity", Value::Number(-9.8)), "the nearest values are -10 and -9.75"),
        (("gravity", "-5".into()), "it needs a number"),
    ] {
        let error = run_with(&[set], &[]).unwrap_err();
        assert!(error.contains(message), "{error}");
    }
    assert!(run_with(&[], &[("Kick", 0.2)]).unwrap_err().contains("the run ends at 0.1 s"));
    for time in [-0.1, f64::NAN, f64::INFINITY] {
        assert!(run_with(&[], &[("Kick", time)]).unwrap_err().contains("cannot be pressed"), "{time}");
    }
}

#[test]
fn the_command_line_knows_the_labels_and_options_of_the_lab() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("lab.json");
    let lab = json!({
        "xml": FALL,
        "controls": [
            {"type": "select", "label": "h = step", "set": "model.opt.timestep",
             "options": [["h = 2 ms", 0.002], ["10", 0.01]], "value": 0.002},
            {"type": "button", "label": "Kick @ rest", "run": "data.qvel[2] = 3"}
        ],
        "readouts": [{"label": "h", "expr": "model.opt.timestep"}]
    });
    std::fs::write(&file, lab.to_string()).unwrap();
    let run = |arguments: &[&str]| {
        let command = [&["run", file.to_str().unwrap()], arguments].concat();
        let done = crate::program::run(&command);
        (done.code, done.stdout + &done.stderr)
    };
    for (set, h) in [("h = step=0.01", "0.010"), ("h = step=10", "0.010"), ("h = step=h = 2 ms", "0.002")] {
        let (code, text) = run(&["--set", set]);
        assert!(code == 0 && text.contains(h), "{set}: {text}");
    }
    assert_eq!(run(&["--press", "Kick @ rest"]).0, 0);
    assert_eq!(run(&["--press", "Kick @ rest@0.5"]).0, 0);
    let (code, text) = run(&["--press", "Kick @ rest@2.5"]);
    assert!(code == 2 && text.contains("but the run ends at 2 s"), "{text}");
    let (code, text) = run(&["--set", "h = step=0.02"]);
    assert!(code == 2 && text.contains("0.002 (\"h = 2 ms\"), 0.01 (\"10\")"), "{text}");
}
