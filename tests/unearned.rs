//! Commands give no verdict for what they did not do, and say why they are not clean.

#![allow(clippy::unwrap_used)]

use crate::program::{CLEAN, FALL, folder, run, run_in};
use crate::support::{check_text, codes};
use std::path::Path;

const BALL: &str = "<mujoco><worldbody><body name='ball' pos='0 0 1'><freejoint name='ball'/><geom size='0.05'/></body></worldbody></mujoco>";

/// A lesson whose true claim depends on a mistake that a fix removes.
fn throw(setup: &str, verify: &str) -> String {
    format!(
        "# Throw\n\nThe ball moves 0.27 m in 0.3 s.\n\n```lab simlab\n{{\"title\": \"A throw\", \"model\": \"ball\", \"stopAt\": 0.3, \
         \"setup\": \"{setup}\",\n \"readouts\": [{{\"label\": \"distance (m)\", \"expr\": \"data.joint('ball').qpos[0]\"}}]{verify}}}\n```\n"
    )
}

const CLAIM: &str = ", \"verify\": {\"measure\": {\"x\": \"final(data.joint('ball').qpos[0])\"}, \"says\": [[\"0.27 m\", \"x\"]]}";
const MISTAKE: &str = "data.qvel[0] = Math.sin(90)";

fn write(folder: &Path, name: &str, text: &str) {
    let path = folder.join(name);
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    std::fs::write(path, text).unwrap();
}

fn read(folder: &Path, name: &str) -> String {
    std::fs::read_to_string(folder.join(name)).unwrap()
}

#[test]
fn a_comment_that_nothing_reads_is_reported() {
    let found = |comment: &str| {
        let checked = check_text("l.md", &format!("# A lesson\n\n{comment}\nIt is 9 m.\n"));
        codes(&checked).contains(&"comment-keyword")
    };
    for comment in [
        "<!-- labspec verfy {\"says\": [[\"9 m\", \"4 + 5\"]]} -->",
        "<!-- labspec: verify {\"says\": [[\"9 m\", \"4 + 5\"]]} -->",
        "<!-- labspec-verify {\"says\": [[\"9 m\", \"4 + 5\"]]} -->",
        "<!-- LABSPEC VERIFY {\"says\": [[\"9 m\", \"4 + 5\"]]} -->",
        "<!-- labsepc verify {\"says\": [[\"9 m\", \"4 + 5\"]]} -->",
        "<!--- labspec verify {\"says\": [[\"9 m\", \"4 + 5\"]]} --->",
        "<!-- labspec alow unknown-key: because -->",
        "<!-- labspec ignore unknown-key -->",
        "{/* labspec verify {\"says\": [[\"9 m\", \"4 + 5\"]]} */}",
    ] {
        assert!(found(comment), "{comment}");
    }
    // Hostile texts take no longer than their length.
    for comment in ["<!-- labspec x ", "{/* labspec x ", "<!--", "{/*", "<!-- labspec x -->\n\n"] {
        found(&comment.repeat(50_000));
    }
    for comment in [
        "<!-- labspec verify {\"says\": [[\"9 m\", \"4 + 5\"]]} -->",
        "<!--labspec verify{\"says\": [[\"9 m\", \"4 + 5\"]]}-->",
        "<!-- the lab is in labs.md -->",
        "<!-- TODO: verify with labspec {later} -->",
        "`<!-- labspec verfy {} -->`",
        "```\n<!-- labspec verfy {} -->\n```",
    ] {
        assert!(!found(comment), "{comment}");
    }
}

#[test]
fn a_lab_that_the_page_reads_otherwise_is_not_verified() {
    let lesson = throw("data.qvel[0] = 0.9", CLAIM)
        .replace("\"model\"", "\"xml\"")
        .replace("\"ball\",", &format!("\"{BALL}\","));
    let word = |text: &str| {
        let checked = check_text("l.md", text);
        labspec::check::ledger(std::slice::from_ref(&checked), &checked.findings).summary()
    };
    assert!(word(&lesson).contains("1 quoted number verified"), "{}", word(&lesson));
    for key in ["stopat", "stopAT", "stop_at"] {
        let summary = word(&lesson.replace("stopAt", key));
        assert!(!summary.contains("verified"), "{key}: {summary}");
    }
}

#[test]
fn formatting_says_what_it_could_not_read() {
    let folder = folder();
    let here = folder.path();
    write(here, "broken.md", "# A\n\n```lab simlab\n{\"model\": }\n```\n");
    let done = run_in(here, &["fmt", "broken.md"]);
    assert_eq!(done.code, 2);
    assert!(done.stderr.contains("1 block of broken.md cannot be read"), "{}", done.stderr);
    assert_eq!(run_in(here, &["fmt", "empty"]).code, 2);
    // The layout does not depend on the line breaks.
    let loose = CLEAN.replace("  \"model\": \"ball_drop\",\n", "        \"model\": \"ball_drop\",\n");
    write(here, "unix.md", &loose);
    write(here, "windows.md", &loose.replace('\n', "\r\n"));
    for file in ["unix.md", "windows.md"] {
        assert_eq!(run_in(here, &["fmt", "--check", file]).code, 1, "{file}");
        assert_eq!(run_in(here, &["fmt", file]).code, 0, "{file}");
        assert_eq!(run_in(here, &["fmt", "--check", file]).code, 0, "{file}");
    }
    assert_eq!(read(here, "unix.md").replace('\n', "\r\n"), read(here, "windows.md"));
}

#[test]
fn a_new_baseline_keeps_what_was_not_checked() {
    let folder = folder();
    let here = folder.path();
    let update = |more: &[&str]| {
        let arguments = [&["check", "--baseline", "known.json", "--update-baseline"], more].concat();
        run_in(here, &arguments).code
    };
    assert_eq!(update(&["wrong.md"]), 0);
    assert_eq!(update(&["clean.md"]), 0);
    assert_eq!(run_in(here, &["check", "wrong.md", "--baseline", "known.json"]).code, 0);
    // What is ignored does not get into the baseline.
    assert_eq!(update(&["wrong.md", "--ignore", "all"]), 1);
    assert_eq!(update(&["wrong.md", "--no-run"]), 2);
}

#[test]
fn every_format_says_why_a_check_is_not_clean() {
    let folder = folder();
    let here = folder.path();
    for format in ["concise", "jsonl", "gitlab", "sarif"] {
        let done = run_in(here, &["check", "clean.md", "--no-run", "--format", format]);
        assert_eq!(done.code, 3);
        assert!(done.stderr.contains("not everything was checked"), "{format}: {}", done.stderr);
    }
    let done = run_in(here, &["check", "wrong.md", "--ignore", "all", "--statistics"]);
    assert_eq!(done.code, 1);
    assert!(done.stdout.contains("false") && done.stdout.contains("ignored"), "{}", done.stdout);
    assert_eq!(run(&["check", "clean.md", "--statistics", "--format", "json"]).code, 2);
}

#[test]
fn settings_that_cannot_be_read_are_an_error() {
    let folder = folder();
    let here = folder.path();
    std::fs::create_dir(here.join("course/labspec.toml")).unwrap();
    assert_eq!(run_in(here, &["check", "course"]).code, 2);
    assert_eq!(run_in(here, &["check", "clean.md"]).code, 0);
}

#[test]
fn a_fix_refutes_no_claim() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    write(here, "models/ball.xml", BALL);
    let lesson = throw(MISTAKE, CLAIM);
    for more in [&[][..], &["--select", "degrees-for-radians"], &["--ignore", "claim"], &["--no-run"]] {
        write(here, "a.md", &lesson);
        run_in(here, &[&["check", "--unsafe-fixes", "a.md"], more].concat());
        assert_eq!(read(here, "a.md"), lesson, "{more:?}");
    }
    // Nor one of another lesson.
    let alone = throw(MISTAKE, "");
    write(here, "a.md", &alone);
    assert!(run_in(here, &["check", "--unsafe-fixes", "a.md"]).stderr.contains("fixed 1 finding"));
    write(here, "a.md", &alone);
    write(
        here,
        "b.md",
        "# B\n\n<!-- labspec verify {\"lab\": \"a.md#1\", \"measure\": {\"x\": \"final(data.joint('ball').qpos[0])\"}, \"says\": [[\"0.27 m\", \"x\"]]} -->\nIt moves 0.27 m.\n",
    );
    let done = run_in(here, &["check", "--unsafe-fixes", "a.md", "b.md"]);
    assert!(done.stderr.contains("a.md is unchanged"), "{}", done.stderr);
    assert_eq!(read(here, "a.md"), alone);
}

#[test]
fn nothing_is_stable_in_no_step() {
    let folder = folder();
    let here = folder.path();
    for until in ["0", "1e-9"] {
        let done = run_in(here, &["stability", "fall.json", "--until", until]);
        assert_eq!((done.code, done.stdout.as_str()), (2, ""), "{}", done.stderr);
    }
}

#[test]
fn a_snapshot_without_values_is_not_as_stored() {
    let folder = folder();
    let here = folder.path();
    write(
        here,
        "bare.json",
        "{\"title\": \"A fall\", \"model\": \"free_fall\", \"stopAt\": 0.4, \"plots\": []}",
    );
    assert_eq!(run_in(here, &["snapshot", "bare.json"]).code, 0);
    let done = run_in(here, &["check", "bare.json"]);
    assert!(!done.stdout.contains("as stored"), "{}", done.stdout);
    write(here, "full.json", FALL);
    run_in(here, &["snapshot", "full.json"]);
    assert!(run_in(here, &["check", "full.json"]).stdout.contains("as stored"));
}

#[test]
fn what_a_lab_could_not_show_is_not_missing_in_the_text() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    write(here, "models/ball.xml", BALL);
    let lesson = throw("data.qvel[0] = 0.9", "");
    for text in [lesson.replace("\"ball\"", "\"bowl\""), lesson.replace("0.9", "NaN")] {
        write(here, "a.md", &text);
        let done = run_in(here, &["trace", "a.md"]);
        assert!(
            done.code != 0 && done.stdout.contains("no measure of lab #1 has a value"),
            "{}",
            done.stdout
        );
        let done = run_in(here, &["scaffold", "a.md"]);
        assert!(done.stdout.contains("no measure of its lab has a value"), "{}", done.stdout);
    }
    write(here, "a.md", &lesson);
    let done = run_in(here, &["trace", "a.md"]);
    assert!(!done.stdout.contains("has a value"), "{}", done.stdout);
}
