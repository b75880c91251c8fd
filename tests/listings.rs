//! `labspec check --listings`: Python listings are run and their outputs compared.

#![allow(clippy::unwrap_used, clippy::panic)]

use crate::needs::{is_available, needs};
use crate::program::{Done, program, run_in};
use serde_json::Value;
use std::path::Path;
use std::time::Instant;

const CODE: &str = "import math\nt, v = math.sqrt(2 * 0.95 / 9.81), math.sqrt(2 * 9.81 * 0.95)\nprint(f\"analytic: t = {t:.4f} s, v = {v:.3f} m/s\")";
const PRINTED: &str = "analytic: t = 0.4401 s, v = 4.317 m/s";

/// Whether listings can be run. Skips the test otherwise.
fn can_run() -> bool {
    needs("python3")
}

fn lesson(code: &str, output: &str) -> String {
    format!("# A fall\n\n```python file=examples/fall.py\n{code}\n```\nOutput:\n```text\n{output}\n```\n")
}

fn folder(text: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("a.md"), text).unwrap();
    settings(folder.path(), "");
    folder
}

/// Writes settings. Where the network cannot be switched off, listings run with it.
fn settings(folder: &Path, text: &str) {
    let network = if is_available("unshare") { "" } else { "network = true" };
    std::fs::write(folder.join("labspec.toml"), format!("[listings]\n{network}\n{text}\n")).unwrap();
}

/// The report of a check with listings.
fn report(folder: &Path) -> Value {
    let done = run_in(folder, &["check", "a.md", "--listings", "--format", "json"]);
    serde_json::from_str(&done.stdout).unwrap_or_else(|e| panic!("{e}: {}{}", done.stdout, done.stderr))
}

/// The codes of the findings, with the marked texts.
fn found(report: &Value, text: &str) -> Vec<(String, String)> {
    let one = |f: &Value| {
        let byte = |key: &str| f[key].as_u64().unwrap() as usize;
        (f["code"].as_str().unwrap().to_string(), text[byte("start")..byte("end")].to_string())
    };
    report["findings"].as_array().unwrap().iter().map(one).collect()
}

/// The findings of a listing.
fn check(code: &str, output: &str, toml: &str) -> (Vec<(String, String)>, Value) {
    let text = lesson(code, output);
    let folder = folder(&text);
    settings(folder.path(), toml);
    let report = report(folder.path());
    (found(&report, &text), report)
}

fn count(report: &Value, state: &str) -> u64 {
    report["summary"]["claims"]["listing"][state].as_u64().unwrap()
}

fn message(report: &Value) -> &str {
    report["findings"][0]["message"].as_str().unwrap_or("")
}

#[test]
fn a_right_output_passes() {
    if !can_run() {
        return;
    }
    let (findings, report) = check(CODE, PRINTED, "");
    assert_eq!((findings.len(), count(&report, "simulated")), (0, 1), "{report:#}");
    let folder = folder(&lesson(CODE, PRINTED));
    let Done { code, stdout, .. } = run_in(folder.path(), &["check", "a.md", "--listings"]);
    assert!(code == 0 && stdout.contains("1 listing as displayed"), "{code} {stdout}");
}

#[test]
fn nothing_runs_without_the_option() {
    let top = tempfile::tempdir().unwrap();
    let trace = top.path().join("ran");
    let code = format!("open({:?}, 'w').write('x')", trace.display().to_string());
    let folder = folder(&lesson(&code, "something else"));
    std::fs::write(folder.path().join("labspec.toml"), "[listings]\nnetwork = true\n").unwrap();
    for arguments in [
        &["check", "a.md"][..],
        &["check", "a.md", "--fix"],
        &["verify", "a.md"],
        &["check", "a.md", "--no-run"],
    ] {
        let done = run_in(folder.path(), arguments);
        assert!(!trace.exists() && !done.stdout.contains("listing"), "{}", done.stdout);
    }
    let both = run_in(folder.path(), &["check", "a.md", "--listings", "--no-run"]);
    assert!(both.code == 2 && !trace.exists(), "{}", both.stderr);
}

#[test]
fn a_changed_digit_is_found_and_fixed() {
    if !can_run() {
        return;
    }
    for (at, c) in PRINTED.char_indices().filter(|(_, c)| c.is_ascii_digit()).step_by(3) {
        let mut wrong = PRINTED.to_string();
        wrong.replace_range(at..at + 1, if c == '7' { "8" } else { "7" });
        let text = lesson(CODE, &wrong);
        let folder = folder(&text);
        let report = report(folder.path());
        let findings = found(&report, &text);
        assert_eq!(findings.len(), 1, "{wrong}: {report:#}");
        assert!(findings[0].0 == "listing-output" && wrong.contains(&findings[0].1), "{findings:?}");
        assert_eq!(count(&report, "false"), 1);
    }
    let folder = folder(&lesson(CODE, "analytic: t = 0.5 s\nmore"));
    let fixed = run_in(folder.path(), &["check", "a.md", "--listings", "--fix"]);
    assert_eq!(fixed.code, 0, "{}{}", fixed.stdout, fixed.stderr);
    assert_eq!(std::fs::read_to_string(folder.path().join("a.md")).unwrap(), lesson(CODE, PRINTED));
}

#[test]
fn an_exception_is_reported_at_its_line() {
    if !can_run() {
        return;
    }
    let (findings, report) = check("a = [1]\n\ndef f():\n    return a[5]\n\nprint(f())", "1", "");
    assert_eq!(findings, [("listing-fails".to_string(), "return a[5]".to_string())]);
    assert!(message(&report).contains("IndexError: list index out of range"), "{report:#}");
    assert_eq!(count(&report, "false"), 1);
    let (findings, _) = check("print(1", "1", "");
    assert_eq!(findings, [("listing-fails".to_string(), "print(1".to_string())]);
    let (_, report) = check("import sys\nsys.exit(3)", "1", "");
    assert!(message(&report).contains("exit code 3"), "{report:#}");
    let (_, report) = check("import module_of_nobody", "1", "");
    assert!(report["findings"][0]["help"].as_str().unwrap().contains("requirements"), "{report:#}");
}

#[test]
fn limits_end_a_listing() {
    if !can_run() {
        return;
    }
    let start = Instant::now();
    let (_, report) = check("while True:\n    pass", "1", "seconds = 1");
    assert!(message(&report).contains("longer than 1 s") && start.elapsed().as_secs() < 30, "{report:#}");
    let (_, report) = check("import time\ntime.sleep(999)", "1", "seconds = 1");
    assert!(message(&report).contains("longer than 1 s"), "{report:#}");
    let (findings, report) = check("a = bytearray(1 << 30)\nprint(len(a))", "1073741824", "memory = 200");
    assert!(findings.len() == 1 && message(&report).contains("MemoryError"), "{report:#}");
    let (_, report) = check("while True:\n    print('x' * 1000)", "1", "");
    assert!(message(&report).contains("more than 1 MB"), "{report:#}");
}

#[test]
fn a_listing_has_no_network() {
    if !needs("unshare") || !can_run() {
        return;
    }
    let server = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    for address in [format!("127.0.0.1\", {}", server.local_addr().unwrap().port()), "1.1.1.1\", 53".into()] {
        let code = format!("import socket\nsocket.create_connection((\"{address}), 5)\nprint(1)");
        let (findings, report) = check(&code, "1", "");
        assert!(findings.len() == 1 && message(&report).contains("Error"), "{report:#}");
    }
}

#[test]
fn surviving_processes_are_killed() {
    if !needs("unshare") || !can_run() {
        return;
    }
    let top = tempfile::tempdir().unwrap();
    let alive = top.path().join("alive");
    // Children in a session of their own, which write for as long as they live.
    let code = format!(
        "import os, time\nfor _ in range(3):\n    if os.fork() == 0:\n        os.setsid()\n        while True:\n            open({:?}, 'a').write('x')\n            time.sleep(0.02)\ntime.sleep(0.3)\nprint(1)",
        alive.display().to_string()
    );
    let size = || std::fs::metadata(&alive).map_or(0, |meta| meta.len());
    for (ending, toml) in [("", "seconds = 20"), ("\ntime.sleep(99)", "seconds = 1")] {
        let before = size();
        let (_, report) = check(&format!("{code}{ending}"), "1", toml);
        assert!(size() > before, "{report:#}");
        std::thread::sleep(std::time::Duration::from_millis(100));
        let then = size();
        std::thread::sleep(std::time::Duration::from_millis(300));
        assert_eq!(size(), then, "a process of the listing is alive");
    }
}

#[test]
fn a_path_outside_of_the_folder_is_refused() {
    let text = lesson("print(1)", "1").replace("examples/fall.py", "../x.py");
    let folder = folder(&text);
    let report = report(folder.path());
    assert_eq!(found(&report, &text), [("listing-fails".to_string(), "```python file=../x.py".to_string())]);
    assert!(!folder.path().join("../x.py").exists());
}

#[test]
fn shared_files_are_there_and_results_are_cached() {
    if !can_run() {
        return;
    }
    // How often it ran is in a file outside of its folder.
    let outside = tempfile::tempdir().unwrap();
    let trace = outside.path().join("runs");
    let code = "from course import G\nprint(G, open('models/ball.xml').read())\nopen(TRACE, 'a').write('x')";
    let code = &code.replace("TRACE", &format!("{:?}", trace.display().to_string()));
    let runs = || std::fs::metadata(&trace).map_or(0, |meta| meta.len());
    let folder = folder(&lesson(code, "9.81"));
    let top = folder.path();
    std::fs::create_dir_all(top.join("lib/models")).unwrap();
    std::fs::write(top.join("lib/course.py"), "G = 9.81").unwrap();
    std::fs::write(top.join("lib/models/ball.xml"), "<ball>").unwrap();
    settings(top, "files = [\"lib/course.py\", \"lib/models\"]");
    let run = |more: &[&str]| {
        let mut arguments = vec!["check", "a.md", "--listings", "--format", "json"];
        arguments.extend(more);
        let output = program(top, &arguments).env("LABSPEC_CACHE", top.join("cache")).output().unwrap();
        let report: Value = serde_json::from_slice(&output.stdout).unwrap();
        message(&report).to_string()
    };
    let first = run(&[]);
    assert!(first.contains("<ball>"), "{first}");
    assert_eq!(runs(), 2, "an output that is not displayed is confirmed by a second run");
    assert_eq!((run(&[]), runs()), (first.clone(), 2), "the result is in the cache");
    assert_eq!((run(&["--no-cache"]), runs()), (first, 4));
    std::fs::write(top.join("lib/models/ball.xml"), "<other>").unwrap();
    assert!(run(&[]).contains("<other>"));
    std::fs::remove_file(top.join("lib/course.py")).unwrap();
    let done = run_in(top, &["check", "a.md", "--listings"]);
    assert!(done.code == 1 && done.stdout.contains("correct `files`"), "{}", done.stdout);
}

/// An output that differs in each run is no correction of the lesson, and is never the displayed one.
#[test]
fn an_output_that_varies_is_not_a_fix() {
    if !can_run() {
        return;
    }
    for code in ["import time\nprint(1)\nprint(time.time_ns())", "print(1)\nimport os\nprint(os.getcwd())"] {
        let text = lesson(code, "1\n0.5");
        let folder = folder(&text);
        let report = report(folder.path());
        assert!(message(&report).contains("prints another output in each run"), "{report:#}");
        assert_eq!((found(&report, &text).len(), count(&report, "false")), (1, 1), "{report:#}");
        let fixed = run_in(folder.path(), &["check", "a.md", "--listings", "--fix"]);
        assert_eq!(fixed.code, 1, "{}", fixed.stdout);
        assert_eq!(std::fs::read_to_string(folder.path().join("a.md")).unwrap(), text);
    }
}

/// What a listing prints may contain control characters and may be long.
#[test]
fn hostile_outputs_are_quoted_in_part_and_escaped() {
    if !can_run() {
        return;
    }
    let printed = "print('\\x1b[2J' + 'x' * 100_000)";
    let raised = "raise ValueError('\\x1b[2J' + 'x' * 100_000)";
    let varies = "import os\nprint('\\x1b[2J' + os.getcwd() * 1000)";
    for code in [printed, raised, varies] {
        for format in ["human", "json", "github", "sarif", "junit"] {
            let folder = folder(&lesson(code, "1"));
            let done = run_in(folder.path(), &["check", "a.md", "--listings", "--format", format]);
            let all = format!("{}{}", done.stdout, done.stderr);
            assert!(done.code == 1 && !all.contains('\x1b'), "{code} {format}: {}", done.stderr);
            // The fix contains the printed output.
            let most = if code == printed && format != "human" { 600_000 } else { 8_000 };
            assert!(all.len() < most, "{code} {format}: {} bytes", all.len());
        }
    }
}

#[test]
fn a_listing_without_an_interpreter_is_not_checked() {
    if !can_run() {
        return;
    }
    let (findings, report) = check("print(1)", "1", "python = \"nowhere/python\"");
    assert!(findings.is_empty() && count(&report, "unchecked") == 1, "{report:#}");
    assert_eq!(report["summary"]["outcome"], "findings");
    let remark = report["ledger"].as_array().unwrap().iter().find(|e| e["subject"] == "listing").unwrap();
    assert!(remark["remark"].as_str().unwrap().contains("correct `python`"), "{remark}");
}

/// The environment of a listing: nothing of the user's, and folders of its own, which are removed.
#[test]
fn a_listing_sees_its_own_folder() {
    if !can_run() {
        return;
    }
    let code = "import os, sys, tempfile\nwork = os.getcwd()\ninside = lambda p: p.startswith(os.path.dirname(work))\nprint(inside(os.environ['HOME']), inside(tempfile.gettempdir()), sys.stdin.read() == '', 'SECRET' in os.environ, sys.argv, os.listdir())\nprint(work, file=open(os.environ.get('SECRET', '/dev/null'), 'w'))\nos.mkdir('x')\nos.chmod('x', 0)";
    let folder = folder(&lesson(code, "True True True False ['examples/fall.py'] ['examples']"));
    let listed = || {
        let entries = std::fs::read_dir(folder.path().join("tmp")).unwrap();
        entries.count()
    };
    std::fs::create_dir(folder.path().join("tmp")).unwrap();
    let arguments = ["check", "a.md", "--listings"];
    let mut command = program(folder.path(), &arguments);
    let output = command.env("SECRET", "x").env("TMPDIR", folder.path().join("tmp")).output().unwrap();
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.code() == Some(0) && listed() == 0, "{text}");
}
