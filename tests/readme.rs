//! The output in the README and the guides is the output of the program.

#![allow(clippy::unwrap_used)]

use crate::support::report::hold;
use crate::support::workspace;
use std::process::Command;

fn run(arguments: &[&str]) -> String {
    let program = env!("CARGO_BIN_EXE_labspec");
    let done = Command::new(program)
        .args(arguments)
        .env("LABSPEC_CACHE", "")
        .current_dir(workspace())
        .output()
        .unwrap();
    let output = String::from_utf8(done.stdout).unwrap();
    hold(&output);
    output
}

fn file(name: &str) -> String {
    std::fs::read_to_string(workspace().join(name)).unwrap()
}

#[test]
fn the_example_lessons_print_the_output_of_the_readme() {
    let output = run(&["check", "specs/lessons"]);
    let output = output.trim();
    assert!(output.contains("no problems found"), "{output}");
    assert!(file("README.md").contains(output), "the README shows something else than\n{output}");
}

/// The lesson for the three findings in the README: the third is found in a run, once the others are corrected.
const WRONG: &str = r#"```lab simlab
{"model": "drop",
 "controls": [{"label": "mass", "apply": "model.body_mass[2] = value", "min": 1, "max": 5, "value": 2}],
 "plots": [{"ylabel": "height (m)", "traces": [{"label": "cork", "expr": "data.joint('crok').qpos[2]"}]}],
 "readouts": [{"label": "speed", "expr": "data.qvel[14]"}]}
```
"#;

#[test]
fn the_findings_of_the_readme_are_real() {
    let corrected = WRONG.replace("crok", "cork").replace("qvel[14]", "qvel[8]");
    for lesson in [WRONG, &corrected] {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("wrong.md"), lesson).unwrap();
        let done = Command::new(env!("CARGO_BIN_EXE_labspec"))
            .args(["check", "wrong.md", "--models"])
            .env("LABSPEC_CACHE", "")
            .arg(workspace().join("specs/models"))
            .current_dir(folder.path())
            .output()
            .unwrap();
        assert_eq!(done.status.code(), Some(1));
        let output = String::from_utf8(done.stdout).unwrap();
        let findings = output.split("\n\nwrong.md\n").next().unwrap().trim();
        assert!(file("README.md").contains(findings), "the README shows something else than\n{findings}");
    }
}

#[test]
fn the_picture_of_the_readme_is_of_the_lesson() {
    let folder = tempfile::tempdir().unwrap();
    let picture = folder.path().join("bounce.svg");
    run(&[
        "run",
        "specs/lessons/02-bounce-and-swing.md#1",
        "--until",
        "1.5",
        "--svg",
        picture.to_str().unwrap(),
    ]);
    assert!(
        std::fs::read_to_string(picture).unwrap() == file("docs/pictures/bounce.svg"),
        "see the README for its command"
    );
}

/// The table contains all commands that are not for engineers only.
#[test]
fn the_readme_names_every_command() {
    let help = run(&["--help"]);
    let commands = help.split("Commands:\n").nth(1).unwrap().split("\n\n").next().unwrap();
    let readme = file("README.md");
    let mut count = 0;
    for line in commands.lines().filter(|l| !l.contains("For engineers")) {
        let name = line.split_whitespace().next().unwrap();
        if line.starts_with("   ") || name == "help" {
            continue;
        }
        assert!(readme.contains(&format!("| `labspec {name} ")), "{name} is not in the README");
        count += 1;
    }
    assert!(count > 7, "{help}");
}

/// The rows of the first table of a page: the scene, and its numbers.
fn rows(page: &str) -> Vec<Vec<String>> {
    let table = page.lines().skip_while(|l| !l.starts_with("| scene |")).skip(2);
    let cells = |l: &str| l.split('|').map(|c| c.trim().to_string()).filter(|c| !c.is_empty()).collect();
    table.take_while(|l| l.starts_with('|')).map(cells).collect()
}

/// The README contains some columns of the measurement without changes.
#[test]
fn the_speeds_of_the_readme_are_those_that_were_measured() {
    let (documented, measured) = (rows(&file("README.md")), rows(&file("docs/measured/speed.md")));
    assert!(documented.len() > 8 && documented.len() == measured.len());
    for (documented, measured) in documented.iter().zip(&measured) {
        let columns = [0, 1, 2, 3, 4, 5, 7, 8, 10].map(|i| measured[i].clone());
        assert_eq!(*documented, columns);
    }
}
