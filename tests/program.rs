//! Runs the program in a separate folder, for the tests of the command line.
//!
//! Every command runs there with relative paths, so that snapshots do not depend on the machine.

#![allow(clippy::unwrap_used)]

use crate::support::model_text;
use crate::support::report::check_command_outputs;
use serde_json::Value;
use std::path::Path;
use std::process::{Command, Stdio};

/// A lesson in which everything is right.
pub(crate) const CLEAN: &str = r##"# A drop

The ball is in the air for 0.440 s.

```lab simlab
{
  "title": "A drop",
  "model": "ball_drop",
  "setup": "data.qpos[2] = 1",
  "controls": [
    {"label": "gravity", "unit": "m/s^2", "set": "model.opt.gravity[2]", "min": -20, "max": -1, "step": 0.01, "value": -9.81, "reset": true},
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
pub(crate) fn wrong() -> String {
    CLEAN
        .replace("data.ncon", "data.ncno")
        .replace("\"answer\": 2", "\"answer\": 0")
        .replace("0.440 s.", "0.450 s.")
        .replace("[\"0.440 s\"", "[\"0.450 s\"")
        .replace("model.opt.gravity[2]", "data.xpos[5]")
}

/// A free fall with its closed form.
pub(crate) const FALL: &str = r#"{
  "title": "A fall",
  "model": "free_fall",
  "stopAt": 0.4,
  "controls": [{"label": "timestep", "set": "model.opt.timestep", "min": 0.001, "max": 0.01, "value": 0.002}],
  "plots": [{"ylabel": "height (m)", "traces": [{"label": "height", "expr": "data.qpos[2]"}]}],
  "verify": {"exact": {"height": "1 - 0.5 * 9.81 * data.time * data.time"}}
}"#;

/// A folder with lessons and models.
pub(crate) fn folder() -> tempfile::TempDir {
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

/// The result of a command.
pub(crate) struct Done {
    pub(crate) code: i32,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

pub(crate) fn program(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_labspec"));
    command.current_dir(folder).args(arguments).env_remove("CLICOLOR_FORCE").stdin(Stdio::null());
    // Nothing is cached, and nothing in the home folder of the user is read.
    command.env("LABSPEC_CACHE", "");
    command
}

/// Runs a command. Output for programs is validated against its schema, in every test.
pub(crate) fn run_in(folder: &Path, arguments: &[&str]) -> Done {
    let output = program(folder, arguments).output().unwrap();
    finished(folder, arguments, output)
}

/// The same with standard input.
pub(crate) fn run_with_input(folder: &Path, arguments: &[&str], input: &str) -> Done {
    use std::io::Write;
    let mut command = program(folder, arguments);
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    child.stdin.take().unwrap().write_all(input.as_bytes()).unwrap();
    finished(folder, arguments, child.wait_with_output().unwrap())
}

fn finished(folder: &Path, arguments: &[&str], output: std::process::Output) -> Done {
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    let done = Done {
        code: output.status.code().unwrap(),
        stdout: text(output.stdout),
        stderr: text(output.stderr),
    };
    check_command_outputs(folder, arguments, done.code, &done.stdout);
    done
}

pub(crate) fn run(arguments: &[&str]) -> Done {
    run_in(folder().path(), arguments)
}

/// Runs a command that must succeed and print JSON.
pub(crate) fn json_of(arguments: &[&str]) -> Value {
    let done = run(arguments);
    assert_eq!((done.code, done.stderr.as_str()), (0, ""), "{arguments:?}");
    serde_json::from_str(&done.stdout).unwrap()
}

/// The command, the exit code and all output.
pub(crate) fn stdout_of(arguments: &[&str]) -> String {
    stdout_in(folder().path(), arguments)
}

pub(crate) fn stdout_in(folder: &Path, arguments: &[&str]) -> String {
    let done = run_in(folder, arguments);
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

pub(crate) fn snapshot(name: &str, text: String) {
    insta::with_settings!({prepend_module_to_snapshot => false, omit_expression => true}, {
        insta::assert_snapshot!(format!("cli-{name}"), text);
    });
}

pub(crate) fn keys(value: &Value) -> Vec<&str> {
    value.as_object().unwrap().keys().map(String::as_str).collect()
}
