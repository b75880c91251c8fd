//! Output to a terminal: control characters of a lesson, a model or a file name are escaped. Also the behaviour without a
//! terminal, with a full device, and on Ctrl-C.

#![allow(clippy::unwrap_used)]

use crate::program::{folder, json_of, program, run_in};
use crate::support::report::hold;
use serde_json::json;
use std::path::Path;

/// Characters that control a terminal, change the direction of text, or are invisible.
const HOSTILE: &str = "\u{1b}[2K\r\u{9b}31m\u{202e}\u{2066}\u{200f}\u{61c}\u{2028}\u{200b}\u{feff}\u{7f}\n";

/// Whether the output contains only text and its own line breaks.
fn is_safe(output: &str) -> bool {
    let hidden = HOSTILE.chars().filter(|&c| c != '\n' && (c.is_control() || !c.is_ascii()));
    let hidden: Vec<char> = hidden.collect();
    !output.contains(&hidden[..])
}

/// A lab with control characters in all its texts, with a program that fails, a displayed string and a failing run.
fn hostile_lab() -> String {
    let bad = |name: &str| format!("{name}{HOSTILE}verified");
    json!({
        "title": bad("title"),
        "model": "free_fall",
        "stopAt": 0.01,
        "controls": [{"label": bad("slider"), "set": "data.qvel[2]", "min": 0, "max": 1, "value": 0}],
        "plots": [{"ylabel": bad("axis"), "traces": [{"label": bad("trace"), "expr": "data.qpos[2]"}]}],
        "readouts": [
            {"label": bad("readout"), "expr": format!("'{}' + data.time", "text\\u{1b}]0;x\\u{7}\\u{202e}\\r")},
            {"label": bad("throws"), "expr": format!("data.body('{}' + data.time).xpos[0]", "b\\u{1b}[2K\\u{202e}\\r")},
        ],
    })
    .to_string()
}

/// A lesson with control characters in ids, labels, keys and names of models, and a false claim.
fn hostile_lesson() -> String {
    let bad = |name: &str| format!("{name}{HOSTILE}verified   question 1");
    let quiz = json!({
        "id": bad("id"),
        bad("key"): 1,
        "questions": [{
            "kind": "predict", "q": bad("question"), "options": [bad("a"), bad("b")], "answer": 0,
            "sim": {"model": "free_fall"},
            "verify": {
                "runs": {"r": {"until": 0.1}},
                "measure": {"m": "final(data.time)"},
                "options": ["m > 1", "m < 1"],
            },
        }],
    });
    let lab = json!({"title": bad("t"), "model": bad("model"), "plots": [{"traces": [{"label": "x", "expr": bad("y")}]}]});
    format!("raw {HOSTILE} text\n\n```quiz\n{quiz}\n```\n\n```lab simlab\n{lab}\n```\n")
}

/// File names are untrusted in every report format: no name adds a line, a command or a key.
#[test]
fn names_of_files_are_escaped_in_every_format() {
    let folder = folder();
    let names = [
        "esc\u{1b}[2K\u{9b}31m.md",
        "bidi\u{202e}\u{2066}\u{200f}.md",
        "line\n::error file=x::verified.md",
        "percent%0A::warning::verified,b.md",
        "return\r::set-output name=a::verified.md",
    ];
    let text = "```lab simlab\n{\"model\": \"free_fall\", \"titel\": \"x\"}\n```\n";
    for name in names {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    for format in ["human", "json", "concise", "jsonl", "github", "gitlab", "sarif", "junit"] {
        for command in ["check", "verify"] {
            let mut arguments = vec![command, "--format", format];
            arguments.extend(names);
            let done = run_in(folder.path(), &arguments);
            assert!(is_safe(&done.stdout), "{command} {format}\n{:?}", done.stdout);
            assert!(is_safe(&done.stderr), "{command} {format}\n{:?}", done.stderr);
            let begins = |word: &str| done.stdout.lines().any(|line| line.trim_start().starts_with(word));
            assert!(!begins("::error file=x"), "{command} {format}\n{}", done.stdout);
            assert!(!begins("::warning::") && !begins("::set-output"), "{command} {format}\n{}", done.stdout);
            if format == "github" {
                assert!(done.stdout.contains("esc\\u{1b}[2K\\u{9b}31m.md"), "{}", done.stdout);
                assert!(done.stdout.contains("percent%250A%3A%3Awarning"), "{}", done.stdout);
            }
        }
    }
}

#[test]
fn nothing_of_a_lesson_reaches_the_terminal_raw() {
    let folder = folder();
    let name = "file\u{1b}[2K\u{202e}.md";
    std::fs::write(folder.path().join("lab.json"), hostile_lab()).unwrap();
    std::fs::write(folder.path().join(name), hostile_lesson()).unwrap();
    let second = format!("{name}#2");
    for arguments in [
        &["run", "lab.json"][..],
        &["run", "lab.json", "--format", "json"],
        &["run", "lab.json", "--set", "x\u{1b}[2K\u{9b}=1"],
        &["run", "lab.json", "--press", "x\u{1b}[2K\u{9b}@1"],
        &["run", "lab.json", "--csv", "no\u{1b}[2K/such/folder"],
        &["plan", "lab.json"],
        &["plan", "lab.json", "--format", "json"],
        &["precision", "lab.json", "--until", "0.01"],
        &["stability", "lab.json", "--until", "0.01"],
        &["stability", "lab.json", "--until", "0.01", "--format", "json"],
        &["precision", "lab.json", "--until", "0.01", "--format", "json"],
        &["run", name],
        &["run", &second],
        &["run", "no\u{1b}[2K\u{9b}such.json"],
        &["fmt", "--check", "lab.json", name],
        &["explain", "no\u{1b}[2K\u{9b}such"],
        &["check", "no\u{1b}[2K\u{9b}such.md"],
        &["record", "no\u{1b}[2K\u{9b}such.xml", "--states", "x"],
        &["--no\u{1b}[2K\u{9b}such"],
        &["run", "lab.json", "--until", "x\u{1b}[2K\u{9b}"],
    ] {
        let done = run_in(folder.path(), arguments);
        assert!(is_safe(&done.stdout), "{arguments:?}\n{:?}", done.stdout);
        assert!(is_safe(&done.stderr), "{arguments:?}\n{:?}", done.stderr);
        let begins = |text: &str| text.lines().any(|line| line.trim_start().starts_with("verified"));
        assert!(
            !begins(&done.stdout) && !begins(&done.stderr),
            "{arguments:?}\n{}{}",
            done.stdout,
            done.stderr
        );
        assert!(!(done.stdout + &done.stderr).is_empty() || arguments[0] == "fmt", "{arguments:?}");
    }
}

#[test]
fn a_title_and_a_label_stay_on_their_line() {
    let folder = folder();
    std::fs::write(folder.path().join("lab.json"), hostile_lab()).unwrap();
    let output = run_in(folder.path(), &["run", "lab.json"]).stdout;
    assert!(output.starts_with("title\\u{1b}[2K\\r\\u{9b}31m\\u{202e}"), "{output}");
    assert!(!output.lines().any(|line| line.trim_start().starts_with("verified")), "{output}");
}

#[test]
fn no_id_overwrites_its_verdict() {
    let folder = folder();
    std::fs::write(folder.path().join("lesson.md"), hostile_lesson()).unwrap();
    for command in ["check", "verify"] {
        let done = run_in(folder.path(), &[command, "lesson.md", "--models", "models"]);
        assert!(is_safe(&done.stdout), "{:?}", done.stdout);
        assert!(done.stdout.contains("refuted"), "{}", done.stdout);
        assert!(!done.stdout.lines().any(|l| l.trim_start().starts_with("verified")), "{}", done.stdout);
    }
}

#[test]
fn csv_and_json_keep_the_data() {
    let folder = folder();
    std::fs::write(folder.path().join("lab.json"), hostile_lab()).unwrap();
    let json = run_in(folder.path(), &["run", "lab.json", "--steps", "0", "--format", "json"]).stdout;
    let value: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert!(value["columns"][1].as_str().unwrap().contains(HOSTILE));
    let csv = run_in(folder.path(), &["run", "lab.json", "--steps", "0", "--format", "csv"]).stdout;
    assert!(csv.contains(&format!("\"plot/0/trace{HOSTILE}verified\"")), "{csv:?}");
}

#[test]
fn lengths_that_make_no_sense_are_errors_in_words() {
    let folder = folder();
    for (arguments, part) in [
        (&["--steps", "18446744073709551615"][..], "the limit is 20000000"),
        (&["--until=-1"], "a run cannot last -1 s"),
        (&["--until", "nan"], "a run cannot last NaN s"),
        (&["--until", "inf"], "a run cannot last Infinity s"),
        (&["--until", "1e300"], "would take 5e+302 steps"),
        (&["--steps", "20000000"], "sample less often"),
    ] {
        let done = run_in(folder.path(), &[&["run", "clean.md#1"], arguments].concat());
        assert_eq!(done.code, 2, "{arguments:?}\n{}", done.stdout);
        assert!(done.stderr.contains(part), "{arguments:?}\n{}", done.stderr);
    }
    let table = json_of(&["run", "clean.md#1", "--steps", "2", "--every", "0", "--format", "json"]);
    assert_eq!(table["rows"].as_array().unwrap().len(), 3);
    assert!(run_in(folder.path(), &["run", "clean.md#1", "--steps", "0"]).stdout.contains("(1 sample)"));
}

/// The exit code of a script in which `$L` is the program; `None` if a signal ended it.
#[cfg(unix)]
fn code(folder: &Path, script: &str) -> Option<i32> {
    let mut command = program(folder, &[]);
    let binary = command.get_program().to_os_string();
    command = std::process::Command::new("sh");
    command
        .current_dir(folder)
        .arg("-c")
        .arg(script)
        .env("L", binary)
        .env("LABSPEC_CACHE", "")
        .output()
        .unwrap()
        .status
        .code()
}

#[cfg(target_os = "linux")]
#[test]
fn output_that_cannot_be_written_is_exit_2() {
    let folder = folder();
    for (script, expected) in [
        ("$L --help > /dev/full", 2),
        ("$L --version > /dev/full", 2),
        ("$L run --help > /dev/full 2> /dev/full", 2),
        ("$L explain > /dev/full", 2),
        ("$L run clean.md#1 --steps 10 > /dev/full", 2),
        ("$L run clean.md#1 --steps 10 --format csv > /dev/full", 2),
        ("$L run clean.md#1 --steps 10 --format json > /dev/full", 2),
        ("$L plan clean.md#1 > /dev/full", 2),
        ("$L check clean.md > /dev/full", 2),
        ("$L check clean.md --format json > /dev/full", 2),
        // A message that cannot be printed changes nothing.
        ("$L check no-such.md 2> /dev/full", 2),
        ("$L --no-such 2> /dev/full", 2),
        ("$L check no-such.md 2>&-", 2),
        ("$L --no-such 2>&- >&-", 2),
        ("$L check clean.md 2> /dev/full", 0),
        // Rust replaces a closed output by the null device, so that writing cannot fail.
        ("$L check wrong.md >&-", 1),
        // A closed pipe is not a failure.
        ("$L explain | head -1", 0),
        ("$L run clean.md#1 --until 10 --format csv | head -1", 0),
    ] {
        assert_eq!(code(folder.path(), script), Some(expected), "{script}");
    }
}

#[cfg(unix)]
#[test]
fn a_closed_reader_ends_the_program_without_an_error() {
    let folder = folder();
    let script =
        "{ $L run clean.md#1 --until 10 --format csv 2> errors; echo $? > code; } | head -1 > /dev/null";
    assert_eq!(code(folder.path(), script), Some(0));
    let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
    assert_eq!((read("code").trim(), read("errors").as_str()), ("0", ""));
}

#[cfg(unix)]
#[test]
fn ctrl_c_prints_the_finished_results() {
    let folder = folder();
    // A step of this lab is slow, so that the run is still active when the signal arrives.
    let lab = r#"{"title": "Slow", "model": "free_fall", "stopAt": 2000,
        "controller": "let s = data.time; for (let i = 0; i < 2000; i++) { s = s + i }",
        "readouts": [{"label": "time", "expr": "data.time"}]}"#;
    std::fs::write(folder.path().join("slow.json"), lab).unwrap();
    let interrupt = |command: &str| {
        let script =
            format!("timeout --foreground --signal=INT --kill-after=60 2 $L {command} > out; echo $? > code");
        let started = std::time::Instant::now();
        code(folder.path(), &script);
        assert!(started.elapsed().as_secs() < 50, "{command}");
        let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
        // With `--foreground`, because `timeout` otherwise sends the signal twice, which ends the program at once. `timeout`
        // itself returns 124; the exit code of the program is tested below.
        let output = read("out");
        hold(&output);
        output
    };
    let output = interrupt("run slow.json");
    assert!(output.contains("stopped by Ctrl-C at t = ") && output.starts_with("Slow, after"), "{output}");
    // A truncated table states this.
    let output = interrupt("run slow.json --format json");
    assert!(output.contains("\"errors\":[\"stopped by Ctrl-C at t = "), "{output:.300}");
    // A check is interrupted during a lesson's runs; the results of earlier lessons are kept.
    let late: String = (0..60).map(|_| format!("```lab simlab\n{lab}\n```\n\n")).collect();
    std::fs::write(folder.path().join("late.md"), late).unwrap();
    let started = std::time::Instant::now();
    let output = interrupt("check clean.md late.md");
    assert!(started.elapsed().as_secs() < 10, "{output}");
    assert!(
        output.contains("interrupted: 1 of 2 files checked; ") && !output.contains("no problems found"),
        "{output}"
    );
    let exit = code(
        folder.path(),
        "timeout --foreground --preserve-status --signal=INT --kill-after=60 2 $L run slow.json --csv some.csv > out",
    );
    assert_eq!(exit, Some(130));
    assert!(std::fs::read_to_string(folder.path().join("some.csv")).unwrap().lines().count() > 1);
    let exit = code(
        folder.path(),
        "timeout --foreground --preserve-status --signal=INT --kill-after=60 2 $L bench slow.json --steps 20000000 > out",
    );
    assert_eq!(exit, Some(130));
    hold(&std::fs::read_to_string(folder.path().join("out")).unwrap());
}
