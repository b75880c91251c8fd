//! Labs that compare integrators, from the command line: checked, run, verified, shown and completed like any lab.

#![allow(clippy::unwrap_used)]

use crate::program::{Done, run_in};
use crate::support::workspace;
use serde_json::{Value, json};
use std::path::Path;

/// A lesson with one spring under all integrators. `KEYS` stands for further keys of the lab.
const LESSON: &str = r#"# A spring

With steps of 50 ms, the energy swings by up to 33.3 % with Euler. With RK4, 4.12 % is lost after 10 s.

```lab integrators
{
  "title": "One spring", "model": "spring", "key": 0, "stopAt": 10, "timestep": 0.05,KEYS
  "verify": {
    "measure": {"largest": "100 * max(Math.abs(shown('energy drift')))", "end": "100 * final(shown('energy drift'))", "h": "1000 * final(model.opt.timestep)", "lasts": "final(data.time)"},
    "says": [["50 ms", "Euler.h"], ["33.3 %", "Euler.largest"], ["4.12 %", "-RK4.end"], ["10 s", "RK4.lasts"]]
  }
}
```
"#;

/// The lesson with further keys, in a folder with its model.
fn folder(keys: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("models")).unwrap();
    let spring = std::fs::read_to_string(workspace().join("specs/models/spring.xml")).unwrap();
    std::fs::write(folder.path().join("models/spring.xml"), spring).unwrap();
    std::fs::write(folder.path().join("a.md"), LESSON.replace("KEYS", keys)).unwrap();
    folder
}

fn check(folder: &Path, arguments: &[&str]) -> Done {
    run_in(folder, &[&["check", "a.md"], arguments].concat())
}

fn lines_with<'t>(text: &'t str, part: &str) -> Vec<&'t str> {
    text.lines().filter(|line| line.contains(part)).collect()
}

#[test]
fn every_integrator_is_run_and_every_claim_is_verified() {
    let folder = folder("");
    let done = check(folder.path(), &[]);
    assert_eq!(done.code, 0, "{}{}", done.stdout, done.stderr);
    let report: Value = serde_json::from_str(&check(folder.path(), &["--format", "json"]).stdout).unwrap();
    let entries = report["ledger"].as_array().unwrap();
    let of_lab: Vec<_> = entries.iter().filter(|e| e["subject"] == "lab").collect();
    assert_eq!(of_lab.len(), 1, "{report:#}");
    assert!(entries.iter().all(|e| e["subject"] != "otherWidget"));
    // A number that no integrator gives is false.
    let text = std::fs::read_to_string(folder.path().join("a.md")).unwrap();
    std::fs::write(folder.path().join("a.md"), text.replace("4.12 %", "4.21 %")).unwrap();
    let done = check(folder.path(), &[]);
    assert_eq!(done.code, 1, "{}", done.stdout);
    assert!(done.stdout.contains("4.21 %"), "{}", done.stdout);
}

#[test]
fn a_run_prints_a_column_for_each_integrator() {
    let folder = folder(
        r#" "integrators": ["RK4", "Euler"], "readouts": [{"label": "time (s)", "expr": "data.time", "digits": 1}],"#,
    );
    let done = run_in(folder.path(), &["run", "a.md#1"]);
    assert_eq!(
        done.stdout,
        "One spring, after 10.000 s (201 samples)
                        RK4      Euler
  largest energy drift  0.0412   0.3333
  energy drift          -0.0412  -0.1926
  time (s)              10.0     10.0
",
        "{}",
        done.stderr
    );
    let csv = run_in(folder.path(), &["run", "a.md#1", "--format", "csv"]).stdout;
    let mut lines = csv.lines();
    assert_eq!(
        lines.next(),
        Some("time,plot/0/RK4,plot/0/Euler,\"readout/time (s), RK4\",\"readout/time (s), Euler\"")
    );
    assert_eq!(lines.count(), 201);
    let one = run_in(folder.path(), &["run", "a.md#1", "--set", "integrator=Euler"]);
    assert!(one.stdout.contains("  time (s)      10.0\n") && !one.stdout.contains("RK4"), "{}", one.stdout);
    let none = run_in(folder.path(), &["run", "a.md#1", "--set", "integrator=implicit"]);
    assert_eq!(none.code, 2);
    assert!(none.stderr.contains("is not an option of \"integrator\""), "{}", none.stderr);
    let svg = folder.path().join("drift.svg");
    run_in(folder.path(), &["run", "a.md#1", "--svg", svg.to_str().unwrap()]);
    let svg = std::fs::read_to_string(svg).unwrap();
    assert!(svg.contains("RK4") && svg.contains("Euler"));
}

#[test]
fn a_break_is_reported_once_with_the_integrators_that_have_it() {
    // Above twice the inverse of the timestep, Euler is unstable; RK4 is unstable above 2.83 times.
    let stiff = |k: f64| folder(&format!(r#" "setup": "model.jnt_stiffness[0] = {k}","#));
    let one = stiff(2000.0);
    let broken = check(one.path(), &[]).stdout;
    let lines = lines_with(&broken, "the simulation breaks");
    assert_eq!(lines.len(), 1, "{broken}");
    assert!(lines[0].contains("with the integrators Euler, implicit and implicitfast"), "{broken}");
    let all = stiff(5000.0);
    let broken = check(all.path(), &[]).stdout;
    assert!(broken.contains("with the integrators Euler, RK4, implicit and implicitfast"), "{broken}");
    let expected =
        check(folder(r#" "setup": "model.jnt_stiffness[0] = 2000", "expect": "breaks","#).path(), &[]);
    assert!(!expected.stdout.contains("the simulation breaks"), "{}", expected.stdout);
}

#[test]
fn a_run_named_after_an_integrator_that_is_not_compared_cannot_be_made() {
    let folder = folder(r#" "integrators": ["RK4", "Euler"],"#);
    let text = std::fs::read_to_string(folder.path().join("a.md")).unwrap();
    let runs = r#""verify": {"runs": {"RK4": {}, "Euler": {}, "implicit": {}},"#;
    std::fs::write(folder.path().join("a.md"), text.replace(r#""verify": {"#, runs)).unwrap();
    let done = check(folder.path(), &[]);
    assert_eq!(done.code, 1, "{}", done.stdout);
    let message =
        "the run `implicit` cannot be executed: the text \"implicit\" is not an option of \"integrator\"";
    assert!(done.stdout.contains(message), "{}", done.stdout);
}

#[test]
fn wrong_and_hostile_labs_have_findings() {
    let folder = folder("");
    for (lab, code, help) in [
        (r#"{"model": "spring", "integrators": ["rk4"]}"#, "integrators-list", "did you mean `RK4`?"),
        (r#"{"model": "spring", "integrators": ["leapfrog"]}"#, "integrators-list", "use one of: Euler, RK4"),
        (r#"{"model": "spring", "integrators": []}"#, "integrators-list", "delete the key"),
        (r#"{"model": "spring", "integrators": {"a": 1}}"#, "wrong-type", "write a list"),
        (r#"{"model": "spring", "timestep": "1"}"#, "wrong-type", "write 1 without the quotes"),
        (r#"{"integrators": ["RK4"]}"#, "one-model", "add \"model\""),
        (r#"{"model": "sprng"}"#, "unknown-model", "did you mean `spring`?"),
        (r#"{"model": "spring", "integrators": ["RK4""#, "json-syntax", "write `]` where it ends"),
        ("[1, 2]", "wrong-type", "write an object"),
        ("\"RK4\"", "wrong-type", "write an object"),
        ("", "json-syntax", "write one JSON object"),
        (r#"{"model": "spring", "timestep": 1e999}"#, "json-syntax", "use a number below"),
        (
            &format!("{{\"model\": \"spring\", \"integrators\": {}1", "[".repeat(2000)),
            "json-limit",
            "look for a bracket",
        ),
    ] {
        std::fs::write(folder.path().join("a.md"), format!("# A\n\n```lab integrators\n{lab}\n```\n"))
            .unwrap();
        let done = check(folder.path(), &[]);
        assert_eq!(done.code, 1, "{lab}: {}{}", done.stdout, done.stderr);
        let text = &done.stdout;
        assert!(text.contains(&format!("error[{code}]")) && text.contains(help), "{lab}: {text}");
        assert!(text.contains(" --> a.md:"), "{lab}: {text}");
    }
}

#[test]
fn a_control_of_the_integrator_is_a_finding() {
    for control in [
        r#"{"type": "select", "label": "method", "set": "model.opt.integrator", "options": [["Euler", 0], ["RK4", 1]], "value": 0, "reset": true}"#,
        r#"{"type": "button", "label": "RK4", "run": "model.opt.integrator = 1"}"#,
        r#"{"label": "integrator", "param": "k", "min": 0, "max": 1, "value": 0}"#,
    ] {
        let folder = folder(&format!(r#" "controls": [{control}],"#));
        let done = check(folder.path(), &["--no-run"]);
        assert!(done.stdout.contains("integrator-control"), "{}", done.stdout);
        assert!(!done.stdout.contains("duplicate-control"), "{}", done.stdout);
    }
}

#[test]
fn fixes_correct_names_and_keys() {
    let folder = folder(r#" "integratos": ["Euler", "rk4"],"#);
    let before = check(folder.path(), &["--no-run"]).stdout;
    assert!(before.contains("integratos"), "{before}");
    for _ in 0..2 {
        run_in(folder.path(), &["check", "a.md", "--no-run", "--fix", "--unsafe-fixes"]);
    }
    let text = std::fs::read_to_string(folder.path().join("a.md")).unwrap();
    assert!(text.contains(r#""integrators": ["Euler", "RK4"]"#), "{text}");
    // A misspelt fence is one of this kind.
    std::fs::write(folder.path().join("a.md"), text.replace("lab integrators", "lab integrator")).unwrap();
    let done = check(folder.path(), &["--no-run"]);
    assert!(done.stdout.contains("lab integrators"), "{}", done.stdout);
}

#[test]
fn the_formatter_changes_only_what_the_author_wrote() {
    let folder = folder(r#" "setup": "data.qpos[0]=0.1","#);
    let done = run_in(folder.path(), &["fmt", "a.md"]);
    assert_eq!(done.code, 0, "{}{}", done.stdout, done.stderr);
    let text = std::fs::read_to_string(folder.path().join("a.md")).unwrap();
    let expected = LESSON.replace("KEYS", r#" "setup": "data.qpos[0] = 0.1","#);
    let without_names = text.replace("data.joint('stretch').qpos[0]", "data.qpos[0]");
    // Long lines are broken.
    let words = |text: &str| text.split_whitespace().collect::<String>();
    assert_eq!(words(&without_names), words(&expected));
}

/// A servo and a spring that are too stiff for their timestep, with and without a select for the integrator. The attribute of the
/// model has no effect where a control sets the integrator, so nothing advises it.
#[test]
fn no_integrator_is_advised_where_a_control_sets_it() {
    let lab = |part: [&str; 2], start: &str, stop: f64, select: bool| {
        let [joint, actuator] = part;
        let xml = format!(
            "<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0' {joint}/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></worldbody><actuator>{actuator}</actuator></mujoco>"
        );
        let mut lab = json!({"title": "stiff", "xml": xml, "setup": start, "stopAt": stop, "readouts": [{"label": "shown", "expr": "data.qpos[0]"}]});
        if select {
            lab["controls"] = json!([{"type": "select", "label": "method", "set": "model.opt.integrator", "options": [["Euler", 0], ["implicit", 1]], "value": 0, "init": true}]);
        }
        lab.to_string()
    };
    let servo =
        (["", "<position name='servo' joint='hinge' kp='20000' kv='4000'/>"], "data.ctrl[0] = 0.1", 1.0);
    let spring = (["stiffness='1e6'", ""], "data.qpos[0] = 0.001", 0.004);
    let folder = tempfile::tempdir().unwrap();
    for (command, (part, start, stop)) in
        [("run", servo), ("check", servo), ("stability", servo), ("check", spring)]
    {
        let advised = |select: bool| {
            std::fs::write(folder.path().join("lab.json"), lab(part, start, stop, select)).unwrap();
            let done = run_in(folder.path(), &[command, "lab.json"]);
            assert_eq!(done.code, 1, "{command}: {}{}", done.stdout, done.stderr);
            assert!(done.stdout.contains("too stiff"), "{command}: {}", done.stdout);
            done.stdout.contains("integrator=")
        };
        assert!(advised(false), "{command} {part:?}");
        assert!(!advised(true), "{command} {part:?}");
    }
}
