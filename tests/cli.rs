//! The program: exit codes, its output for people and for programs, and its messages when it cannot run.

#![allow(clippy::panic, clippy::unwrap_used)]

use crate::needs::needs;
use crate::program::{CLEAN, Done, FALL, folder, json_of, keys, program, run, run_in, snapshot, stdout_of};
use crate::support::workspace;
use serde_json::{Value, json};
use std::io::Read;
use std::path::Path;
use std::process::Stdio;

#[test]
fn check_a_clean_lesson() {
    assert_eq!(run(&["check", "clean.md"]).code, 0);
    snapshot("check-clean", stdout_of(&["check", "clean.md"]));
}

#[test]
fn check_a_wrong_lesson() {
    assert_eq!(run(&["check", "wrong.md"]).code, 1);
    snapshot("check-wrong", stdout_of(&["check", "wrong.md"]));
}

#[test]
fn check_a_folder() {
    let done = run(&["check", "course", "--models", "models"]);
    // JSON files of other programs are skipped.
    assert_eq!((done.code, done.stderr.as_str()), (0, ""), "{}", done.stdout);
    assert!(done.stdout.contains("course/a.md") && !done.stdout.contains("package.json"), "{}", done.stdout);
    // A file that is named directly is always checked.
    assert_eq!(run(&["check", "course/package.json"]).code, 1);
}

/// The lesson for which this program was first written, if it is next to the repository.
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
    // `<option>` in the text and in an explanation, which a browser does not display; `mj_setConst` during a run, which makes
    // the scene jump; missing claims; and a question whose right option is the longest.
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
    snapshot("check-broken-model", stdout_of(&["check", "broken/lesson.md"]));
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
    snapshot("verify", stdout_of(&["verify", "clean.md"]));
}

#[test]
fn a_run_that_is_not_possible_states_the_reason() {
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
        let text = stdout_of(arguments);
        assert!(text.contains("\nexit 2\n"), "{text}");
        all.push_str(&text);
        all.push('\n');
    }
    // The message of the operating system for a missing file differs between systems.
    snapshot(
        "failures",
        all.replace("The system cannot find the file specified.", "No such file or directory"),
    );
}

#[test]
fn help_and_version_are_no_errors() {
    assert_eq!(run(&["--help"]).code, 0);
    assert_eq!(run(&["run", "--help"]).code, 0);
    let version = format!("labspec {}\n", env!("CARGO_PKG_VERSION"));
    assert_eq!(run(&["-V"]).stdout, version);
    let long = run(&["--version"]).stdout;
    assert!(long.starts_with(&format!("{version}build: ")), "{long}");
    assert!(long.ends_with("\nsemantics: MuJoCo 3.14.0\n"), "{long}");
    assert_eq!((run(&[]).code, run(&["chekc"]).code, run(&["run"]).code), (2, 2, 2));
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
    // Only a few of each kind; all of them would need as many processes.
    for code in ["answer-fragile", "unknown-key", "unknown-field", codes[0], codes[codes.len() - 1]] {
        let done = run(&["explain", code]);
        assert_eq!(done.code, 0, "{code}: {}", done.stderr);
        assert!(done.stdout.starts_with(&format!("# {code}")), "{}", done.stdout);
    }
}

/// `labspec … | head`: if the reader closes the pipe, the program ends quietly.
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

/// A running program whose output is read line by line until it is stopped.
#[cfg(unix)]
struct Watched {
    child: std::process::Child,
    lines: std::sync::mpsc::Receiver<String>,
}

#[cfg(unix)]
impl Watched {
    fn start(folder: &Path, arguments: &[&str]) -> Watched {
        use std::io::{BufRead, BufReader};
        let mut command = program(folder, arguments);
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        let (sender, lines) = std::sync::mpsc::channel();
        let streams: [Box<dyn Read + Send>; 2] =
            [Box::new(child.stdout.take().unwrap()), Box::new(child.stderr.take().unwrap())];
        for stream in streams {
            let sender = sender.clone();
            std::thread::spawn(move || {
                for line in BufReader::new(stream).lines().map_while(Result::ok) {
                    let _ = sender.send(line);
                }
            });
        }
        Watched { child, lines }
    }

    fn wait_for(&self, what: &str) {
        let mut seen = Vec::new();
        loop {
            match self.lines.recv_timeout(std::time::Duration::from_secs(60)) {
                Ok(line) if line.contains(what) => return,
                Ok(line) => seen.push(line),
                Err(e) => panic!("{what}: {e}\n{}", seen.join("\n")),
            }
        }
    }

    /// Sends Ctrl-C and returns the exit code.
    fn interrupt(mut self) -> i32 {
        let id = self.child.id().to_string();
        assert!(std::process::Command::new("kill").args(["-INT", &id]).status().unwrap().success());
        self.child.wait().unwrap().code().unwrap()
    }
}

#[cfg(unix)]
impl Drop for Watched {
    fn drop(&mut self) {
        let _ = self.child.kill();
    }
}

/// Settings, the snapshot and a lesson with a used lab are watched from the moment at which they are created.
#[cfg(unix)]
#[test]
fn watching_sees_settings_snapshots_and_neighbours() {
    let folder = crate::ledger::with_neighbours();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write("clean.md", CLEAN);
    let watched = Watched::start(folder.path(), &["check", "clean.md", "reader.md", "--watch"]);
    watched.wait_for("error[quote-wrong]");
    write("labspec.toml", "ignore = [\"quote-wrongg\"]\n");
    watched.wait_for("quote-wrongg");
    write("labspec.toml", "ignore = [\"duplicate-readout\"]\n");
    watched.wait_for("1 warning ignored");
    std::fs::remove_file(folder.path().join("labspec.toml")).unwrap();
    watched.wait_for("warning[duplicate-readout]");
    write("clean.md.snap", "a text of somebody\n");
    watched.wait_for("snapshot");
    std::fs::remove_file(folder.path().join("labs.md")).unwrap();
    watched.wait_for("error[unknown-lab]");
    assert_eq!(watched.interrupt(), 130);
}

/// The rows of the table in docs/verify.md: an exit code and its condition.
fn exit_codes() -> Vec<(i32, String)> {
    let text = std::fs::read_to_string(workspace().join("docs/verify.md")).unwrap();
    let section = text.split("\n## Exit codes\n").nth(1).unwrap().split("\n## ").next().unwrap();
    let row = |line: &str| {
        let (code, when) = line.strip_prefix("| ")?.strip_suffix(" |")?.split_once(" | ")?;
        Some((code.parse().ok()?, when.to_string()))
    };
    section.lines().filter_map(row).collect()
}

/// A check of a lesson for a row of the table, and its result.
fn done_for(when: &str, folder: &Path) -> Option<Done> {
    let write = |name: &str, text: &str| std::fs::write(folder.join(name), text).unwrap();
    let check = |arguments: &[&str]| Some(run_in(folder, &[&["check"], arguments].concat()));
    let lab = |more: &str| {
        format!(
            "{{\"title\": \"A fall\", \"model\": \"free_fall\", \"stopAt\": 0.1, \"readouts\": [{{\"label\": \"z\", \"expr\": \"data.qpos[2]\"}}]{more}}}"
        )
    };
    let twice = lab("").replace("}]", "}, {\"label\": \"z\", \"expr\": \"data.qvel[2]\"}]");
    let false_claim = CLEAN.replace("\"answer\": 2", "\"answer\": 0");
    let breaks = FALL.replace("\"stopAt\": 0.4", "\"stopAt\": 0.4, \"setup\": \"data.qvel[2] = 1e11\"");
    match when {
        "every claim is true" => check(&["clean.md"]),
        "there are no claims, and every lab runs" => {
            write("a.json", &lab(""));
            check(&["a.json"])
        }
        "there are only notes" => {
            write(
                "a.md",
                &format!(
                    "# A fall\n\nIt touches the floor after 0.442 s, at 4.43 m/s, and falls 1 m.\n\n```lab simlab\n{}\n```\n",
                    lab("")
                ),
            );
            let done = check(&["a.md", "--format", "json"])?;
            let summary = &serde_json::from_str::<Value>(&done.stdout).unwrap()["summary"];
            let counts = ["errors", "warnings"].map(|key| summary[key].as_u64().unwrap());
            assert!(counts == [0, 0] && summary["notes"].as_u64().unwrap() > 0, "{summary}");
            Some(done)
        }
        "the lessons suppress every finding: the last line counts them, and they do not change the exit code" =>
        {
            let lint = ", \"lint\": {\"allow\": [\"duplicate-readout\"], \"why\": \"both are read aloud\"}}";
            let text = twice.strip_suffix('}').unwrap().to_string() + lint;
            write("a.json", &text);
            let done = check(&["a.json"])?;
            assert!(done.stdout.contains("(1 finding suppressed by the lessons)"), "{}", done.stdout);
            Some(done)
        }
        "the baseline contains every finding and every claim that is not true, unchanged: the last line counts them" =>
        {
            write("a.md", &false_claim);
            check(&["a.md", "--baseline", "known.json", "--update-baseline"])?;
            let done = check(&["a.md", "--baseline", "known.json"])?;
            assert!(done.stdout.contains("in the baseline)"), "{}", done.stdout);
            Some(done)
        }
        "there is an error or a warning" => {
            write("a.json", &twice);
            write("b.json", &lab("").replace("data.qpos", "data.qops"));
            assert_eq!(check(&["b.json"])?.code, 1);
            check(&["a.json"])
        }
        "a claim is false" => {
            write("a.md", &false_claim);
            check(&["a.md"])
        }
        "a claim could not be checked: a run breaks" => {
            let broken = "\"runs\": {\"drop\": {\"until\": 1, \"setup\": \"data.qvel[2] = 1e11\"}}";
            write("a.md", &CLEAN.replace("\"runs\": {\"drop\": {\"until\": 1}}", broken));
            check(&["a.md"])
        }
        "a lab does not run in full" => {
            write("a.json", &breaks);
            check(&["a.json"])
        }
        "a claim in the baseline has another key, or another value" => {
            write("a.md", &false_claim);
            check(&["a.md", "--baseline", "known.json", "--update-baseline"])?;
            write("a.md", &CLEAN.replace("\"answer\": 2", "\"answer\": 1"));
            check(&["a.md", "--baseline", "known.json"])
        }
        "an option or a path is wrong" => {
            assert_eq!(check(&["nowhere.md"])?.code, 2);
            check(&["clean.md", "--no-such-option"])
        }
        "there is nothing to check" => {
            assert_eq!(check(&["empty"])?.code, 2);
            write("a.md", "# Only prose\n");
            check(&["a.md"])
        }
        "the result could not be written" => check(&["fall.json", "--record", "clean.md"]),
        "a block of an unknown widget was left out" => {
            write("a.md", &format!("{CLEAN}\n```lab playground\n{{}}\n```\n"));
            check(&["a.md"])
        }
        "an error is ignored by a setting" => {
            write("a.json", &lab(", \"titel\": \"A fall\""));
            assert_eq!(check(&["a.json"])?.code, 1);
            let done = check(&["a.json", "--ignore", "all"])?;
            assert!(done.stdout.contains(" ignored)"), "{}", done.stdout);
            Some(done)
        }
        "a part was skipped on request: `--no-run`" => check(&["clean.md", "--no-run"]),
        #[cfg(unix)]
        "a link in a folder leads out of it" => {
            std::os::unix::fs::symlink("../clean.md", folder.join("course/out.md")).unwrap();
            check(&["course"])
        }
        "a second judge has not judged every claim" => {
            let recording = json!({"recording": "judge", "version": 1, "engine": "somebody", "runs": []});
            write("judge.json", &recording.to_string());
            check(&["clean.md", "--judge", "judge.json"])
        }
        #[cfg(unix)]
        "Ctrl-C, after what was finished has been printed" => {
            let watched = Watched::start(folder, &["check", "clean.md", "--watch"]);
            watched.wait_for("no problems found");
            let (stdout, stderr) = Default::default();
            Some(Done { code: watched.interrupt(), stdout, stderr })
        }
        _ => None,
    }
}

#[test]
fn the_table_of_exit_codes_is_so() {
    let rows = exit_codes();
    assert_eq!(rows.len(), 19);
    for (code, when) in rows {
        if cfg!(not(unix)) && (when.starts_with("a link") || when.starts_with("Ctrl-C")) {
            continue;
        }
        let folder = folder();
        let done =
            done_for(&when, folder.path()).unwrap_or_else(|| panic!("no lesson is written for: {when}"));
        assert_eq!(done.code, code, "{when}: {}{}", done.stdout, done.stderr);
    }
}
