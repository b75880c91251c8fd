//! Reading and writing of files: nothing is lost or overwritten, nothing blocks, and no input exhausts
//! the memory of the machine.

#![allow(clippy::unwrap_used)]

use crate::program::{Done, folder, program, run_in};
use crate::support::report::hold;
use serde_json::json;
use std::path::Path;
use std::process::Command;

/// Runs a script in which `$L` is the program. An exit code of 1000 or more means that a signal ended it.
#[cfg(unix)]
fn script(folder: &Path, script: &str) -> Done {
    use std::os::unix::process::ExitStatusExt;
    let binary = program(folder, &[]).get_program().to_os_string();
    let mut command = Command::new("sh");
    let output = command.current_dir(folder).arg("-c").arg(script).env("L", binary).output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8_lossy(&bytes).into_owned();
    let code = output.status.code().unwrap_or_else(|| 1000 + output.status.signal().unwrap_or(0));
    let done = Done { code, stdout: text(output.stdout), stderr: text(output.stderr) };
    if code < 1000 {
        hold(&done.stdout);
    }
    done
}

pub(crate) fn read(folder: &Path, name: &str) -> String {
    std::fs::read_to_string(folder.join(name)).unwrap()
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// A lesson of about this many bytes whose code `fmt` changes.
fn long_lesson(bytes: usize) -> String {
    let lab = json!({"model": "free_fall", "setup": "data.qpos[2]=1", "readouts": [{"label": "h", "expr": "data.qpos[2]+1"}]});
    format!("{}\n\n```lab simlab\n{lab}\n```\n", "Some prose that must not be lost.\n".repeat(bytes / 34))
}

#[cfg(unix)]
#[test]
fn a_full_disk_loses_no_lesson() {
    let folder = folder();
    let lesson = long_lesson(200_000);
    std::fs::write(folder.path().join("lesson.md"), &lesson).unwrap();
    let before = names(folder.path());
    // No file may grow beyond 32 kB, which has the same effect on the program as a full disk.
    let done = script(folder.path(), "trap '' XFSZ; ulimit -f 64; exec $L fmt lesson.md");
    assert_eq!(done.code, 2, "{}", done.stdout);
    assert!(done.stderr.contains("the old file is unchanged"), "{}", done.stderr);
    assert!(read(folder.path(), "lesson.md") == lesson, "the lesson is damaged");
    assert_eq!(names(folder.path()), before, "something is left over");
    assert_eq!(run_in(folder.path(), &["fmt", "lesson.md"]).code, 0);
    assert!(read(folder.path(), "lesson.md").contains("data.qpos[2] + 1"));
    assert_eq!(names(folder.path()), before, "something is left over");
}

#[cfg(unix)]
#[test]
fn links_and_permissions_are_kept() {
    use std::os::unix::fs::PermissionsExt;
    let folder = folder();
    let path = folder.path().join("lesson.md");
    std::fs::write(&path, long_lesson(100)).unwrap();
    std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o640)).unwrap();
    std::os::unix::fs::symlink("lesson.md", folder.path().join("link.md")).unwrap();
    assert_eq!(run_in(folder.path(), &["fmt", "link.md"]).code, 0);
    assert!(folder.path().join("link.md").symlink_metadata().unwrap().is_symlink());
    assert!(read(folder.path(), "lesson.md").contains("data.qpos[2] + 1"));
    assert_eq!(path.metadata().unwrap().permissions().mode() & 0o777, 0o640);
    // A link to a file that does not exist yet, and a cyclic link.
    std::fs::create_dir(folder.path().join("results")).unwrap();
    std::os::unix::fs::symlink("results/a.csv", folder.path().join("a.csv")).unwrap();
    std::os::unix::fs::symlink("round.csv", folder.path().join("round.csv")).unwrap();
    assert_eq!(run_in(folder.path(), &["run", "fall.json", "--steps", "2", "--csv", "a.csv"]).code, 0);
    assert_eq!(read(folder.path(), "results/a.csv").lines().count(), 4);
    let done = run_in(folder.path(), &["run", "fall.json", "--steps", "2", "--csv", "round.csv"]);
    assert!(done.code == 2 && done.stderr.contains("its links form a circle"), "{}", done.stderr);
}

#[test]
fn an_output_never_overwrites_an_input() {
    let folder = folder();
    std::fs::copy(folder.path().join("fall.json"), folder.path().join("lab.json")).unwrap();
    #[cfg(unix)]
    std::os::unix::fs::symlink("lab.json", folder.path().join("link.svg")).unwrap();
    std::fs::hard_link(folder.path().join("lab.json"), folder.path().join("hard.svg")).unwrap();
    let before = read(folder.path(), "lab.json");
    let model = read(folder.path(), "models/free_fall.xml");
    for output in
        ["lab.json", "./models/../lab.json", "link.svg", "hard.svg", "models/free_fall.xml", "clean.md"]
    {
        for arguments in
            [["run", "lab.json", "--csv"], ["run", "lab.json", "--json"], ["run", "lab.json", "--svg"]]
                .into_iter()
                .chain([["precision", "lab.json", "--svg"]])
        {
            if output == "link.svg" && cfg!(not(unix)) {
                continue;
            }
            let done = run_in(folder.path(), &[&arguments[..], &[output]].concat());
            assert_eq!(done.code, 2, "{arguments:?} {output}");
            assert!(done.stderr.contains("would overwrite a lesson or a model"), "{}", done.stderr);
        }
    }
    assert_eq!(read(folder.path(), "lab.json"), before);
    assert_eq!(read(folder.path(), "models/free_fall.xml"), model);
}

#[test]
fn two_outputs_never_share_a_file() {
    let folder = folder();
    for arguments in [
        &["--csv", "x", "--json", "./x"][..],
        &["--csv", "x", "--svg", "x"],
        &["--svg", "plot.svg", "--csv", "plot-2.svg"],
        &["--json", "models/../plot-2.svg", "--svg", "plot.svg"],
    ] {
        let arguments = [&["run", "clean.md#1", "--steps", "2"], arguments].concat();
        let done = run_in(folder.path(), &arguments);
        assert_eq!(done.code, 2, "{arguments:?}");
        assert!(done.stderr.contains("are the same file"), "{}", done.stderr);
    }
    assert!(!names(folder.path()).iter().any(|n| n == "x" || n.ends_with(".svg")));
    #[cfg(unix)]
    {
        let done = script(folder.path(), "$L run clean.md#1 --steps 2 --csv out > out");
        assert!(done.code == 2 && done.stderr.contains("the output"), "{}", done.stderr);
    }
}

#[test]
fn many_plots_ask_for_a_folder() {
    let folder = folder();
    let plot = json!({"traces": [{"label": "h", "expr": "data.qpos[2]"}]});
    let lab = json!({"model": "free_fall", "stopAt": 0.01, "plots": vec![plot; 60]});
    std::fs::write(folder.path().join("lab.json"), lab.to_string()).unwrap();
    let done = run_in(folder.path(), &["run", "lab.json", "--svg", "plot.svg"]);
    assert_eq!(done.code, 2, "{}", done.stdout);
    assert!(done.stderr.contains("--svg plot/"), "{}", done.stderr);
    assert_eq!(run_in(folder.path(), &["run", "lab.json", "--svg", "plot/"]).code, 0);
    assert_eq!(names(&folder.path().join("plot")).len(), 60);
    assert!(read(folder.path(), "plot/plot-60.svg").starts_with("<svg"));
    // A few plots may be written next to each other.
    assert_eq!(run_in(folder.path(), &["run", "clean.md#1", "--steps", "2", "--svg", "p.svg"]).code, 0);
    assert!(read(folder.path(), "p-2.svg").starts_with("<svg"));
}

#[test]
fn a_picture_in_pixels_replaces_its_own_and_no_other() {
    let folder = folder();
    let draw = || run_in(folder.path(), &["run", "clean.md#1", "--steps", "2", "--png", "p.png"]);
    assert_eq!([draw().code, draw().code], [0, 0]);
    assert!(std::fs::read(folder.path().join("p-2.png")).unwrap().starts_with(b"\x89PNG"));
    // Pictures may also be height fields.
    std::fs::write(folder.path().join("p.png"), b"\x89PNG of a mountain").unwrap();
    let done = draw();
    assert_eq!(done.code, 2, "{}", done.stdout);
    assert!(done.stderr.contains("--png p.png would overwrite"), "{}", done.stderr);
}

#[cfg(unix)]
#[test]
fn pipes_and_devices_never_block() {
    let folder = folder();
    std::fs::create_dir(folder.path().join("folder.xml")).unwrap();
    std::fs::create_dir(folder.path().join("folder.md")).unwrap();
    script(folder.path(), "mkfifo pipe.md pipe.xml pipe.json models/pipe.xml");
    std::fs::write(folder.path().join("of_pipe.json"), r#"{"model": "pipe", "readouts": []}"#).unwrap();
    for arguments in [
        "check pipe.md",
        "check pipe.json",
        "check pipe.xml",
        "check of_pipe.json",
        "check /dev/zero",
        "check /dev/tty",
        "check folder.md",
        "fmt pipe.md",
        "run pipe.json",
        "run pipe.xml",
        "run folder.xml",
        "run /dev/zero",
        "run fall.json --csv pipe.md",
        "run fall.json --json pipe.xml",
        "run fall.json --svg pipe.json",
        "run fall.json --csv /dev/full",
        "run fall.json --csv folder.md",
        "precision fall.json --svg pipe.json",
        "record models/free_fall.xml --states pipe.json",
        "record models/free_fall.xml --states /dev/zero",
        "record models/free_fall.xml --states models",
        "record pipe.xml --states fall.json",
    ] {
        let done = script(folder.path(), &format!("exec timeout --signal=KILL 30 $L {arguments}"));
        assert!(matches!(done.code, 1 | 2), "{arguments}: {}\n{}{}", done.code, done.stdout, done.stderr);
    }
    // A pipe in a folder of lessons is skipped.
    let done = script(folder.path(), "mkfifo course/pipe.md; exec timeout --signal=KILL 60 $L check course");
    assert!(done.code < 1000, "{}", done.stderr);
}

#[test]
fn fmt_keeps_the_names_of_functions() {
    let folder = folder();
    let setup = "const g = function f(x) { return x > 0 ? f(x-1) : 0 }; data.qpos[2]=1";
    let lab = json!({"model": "free_fall", "setup": setup});
    std::fs::write(folder.path().join("lab.json"), lab.to_string()).unwrap();
    run_in(folder.path(), &["fmt", "lab.json"]);
    let after: serde_json::Value = serde_json::from_str(&read(folder.path(), "lab.json")).unwrap();
    let code = after["setup"].as_str().unwrap();
    assert!(code.contains("function f(x) {") && code.contains("f(x - 1)"), "{code}");
    // Formatting again changes nothing.
    assert_eq!(run_in(folder.path(), &["fmt", "--check", "lab.json"]).code, 0);
}

#[test]
fn fmt_continues_after_an_unreadable_file() {
    let folder = folder();
    std::fs::write(folder.path().join("a.md"), b"latin-1: \xe9").unwrap();
    std::fs::write(folder.path().join("b.md"), long_lesson(100)).unwrap();
    let done = run_in(folder.path(), &["fmt", "a.md", "b.md"]);
    assert_eq!(done.code, 2);
    assert!(done.stdout.contains("b.md: 2 of 2 texts and the layout of 1 block changed"), "{}", done.stdout);
    assert!(done.stderr.contains("a.md, line 1: not UTF-8"), "{}", done.stderr);
}

/// Runs the program with limited address space; no run may end by a signal or take very long.
#[cfg(target_os = "linux")]
fn within_memory(folder: &Path, arguments: &str) -> Done {
    let done = script(folder, &format!("ulimit -v 1500000; exec timeout --signal=KILL 280 $L {arguments}"));
    assert!(done.code <= 2, "{arguments}: {}\n{}", done.code, done.stderr);
    done
}

#[cfg(target_os = "linux")]
#[test]
fn texts_in_every_row_have_a_limit() {
    let folder = folder();
    let lab = json!({"model": "free_fall", "readouts": [{"label": "t", "expr": "'x'.padEnd(1000000) + data.time"}]});
    std::fs::write(folder.path().join("lab.json"), lab.to_string()).unwrap();
    let long = json!({"model": "free_fall", "setup": "ctx.t = 'x'; for (let i = 0; i < 20; i++) { ctx.t = ctx.t + ctx.t }",
        "readouts": [{"label": "t", "expr": "ctx.t + data.time"}]});
    std::fs::write(folder.path().join("long.json"), long.to_string()).unwrap();
    within_memory(folder.path(), "run lab.json --steps 4000");
    let done = within_memory(folder.path(), "run long.json --steps 4000");
    assert!(done.code == 2 && done.stderr.contains("exceed 64 MB"), "{}{}", done.code, done.stderr);
}

#[cfg(target_os = "linux")]
#[test]
fn millions_of_rows_are_streamed() {
    let folder = folder();
    let done = within_memory(folder.path(), "run models/free_fall.xml --steps 4900000 --json out.json");
    assert_eq!(done.code, 0, "{}", done.stderr);
    assert!(folder.path().join("out.json").metadata().unwrap().len() > 4_900_000 * 6);
}

#[cfg(target_os = "linux")]
#[test]
fn recordings_have_limits() {
    let folder = folder();
    let states = json!({"model": {}, "sizes": {}, "forward": vec![json!({"M": 0}); 400_000]});
    std::fs::write(folder.path().join("states.json"), states.to_string()).unwrap();
    let record = "record models/free_fall.xml --states";
    for steps in ["18446744073709551615", "20000000"] {
        let done = within_memory(folder.path(), &format!("{record} states.json --steps {steps} --every 1"));
        assert!(done.code == 2 && done.stderr.contains("too long"), "{}", done.stderr);
    }
    let huge = std::fs::File::create(folder.path().join("huge.json")).unwrap();
    huge.set_len(1 << 40).unwrap();
    let done = within_memory(folder.path(), &format!("{record} huge.json"));
    assert!(done.code == 2 && done.stderr.contains("larger than 64 MB"), "{}", done.stderr);
    let done = within_memory(folder.path(), "check huge.json");
    assert_ne!(done.code, 0);
}

/// Lessons of nearly 16 MB that repeat one element.
#[cfg(target_os = "linux")]
#[test]
fn no_lesson_of_16_mb_takes_more_than_a_gigabyte() {
    let folder = folder();
    let size = 16_000_000;
    for (name, part) in [
        ("tags", "<geom>"),
        ("quotes", ">"),
        ("brackets", "["),
        ("emphasis", "*a_ "),
        ("fences", "```\nx\n```\n"),
        ("list", "- a\n"),
        ("links", "[a](b) "),
        ("html", "<a><!--"),
    ] {
        std::fs::write(folder.path().join("lesson.md"), part.repeat(size / part.len())).unwrap();
        let done = within_memory(folder.path(), "check lesson.md");
        assert!(done.stdout.len() + done.stderr.len() < 1 << 20, "{name}: {} bytes", done.stdout.len());
    }
    // The same in the texts of a lab and a quiz.
    let lab = json!({"model": "free_fall", "note": "<geom>".repeat(size / 6)});
    std::fs::write(folder.path().join("lab.json"), lab.to_string()).unwrap();
    within_memory(folder.path(), "check lab.json");
}

/// All files of the program and its libraries by name, without tests.
fn sources() -> Vec<(String, String)> {
    let crates = crate::support::workspace().join("crates");
    let folders = ["cli", "developer", "labspec", "lsp", "numerics", "proposals"];
    let (mut open, mut all) = (folders.map(|name| crates.join(name).join("src")).to_vec(), Vec::new());
    while let Some(folder) = open.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let name = path.strip_prefix(&crates).unwrap().display().to_string();
            if path.is_dir() {
                open.push(path);
            } else if !name.ends_with("tests.rs") && name.ends_with(".rs") {
                let text = std::fs::read_to_string(&path).unwrap();
                let code = text.split("#[cfg(test)]\n#[allow").next().unwrap();
                all.push((name, code.split("#[cfg(test)]\nmod").next().unwrap().to_string()));
            }
        }
    }
    all.sort();
    all
}

/// The files whose code contains one of these texts.
fn with(texts: &[&str]) -> Vec<String> {
    let has = |code: &str| texts.iter().any(|text| code.contains(text));
    sources().into_iter().filter(|(_, code)| has(code)).map(|(name, _)| name).collect()
}

/// Files are written, removed and renamed in one module, which checks their kind; the cache and the runs of listings have
/// folders of their own. One loader reads lessons; a page plays a lab from its text. Threads are created in one module, which sets their stack size.
#[test]
fn files_lessons_and_threads_have_one_place_each() {
    let writes = [
        "fs::write(",
        "File::create",
        "OpenOptions",
        "fs::rename(",
        "fs::remove_",
        "remove_dir",
        "fs::copy(",
    ];
    assert_eq!(
        with(&writes),
        [
            "cli/src/cache.rs",
            "cli/src/listings/environment.rs",
            "cli/src/listings/folder.rs",
            "cli/src/output.rs"
        ]
    );
    assert_eq!(
        with(&[" load_lesson(", "(load_lesson("]),
        ["labspec/src/lint/load.rs", "labspec/src/player/load.rs"]
    );
    assert_eq!(with(&["thread::spawn", "Builder::new().s"]), ["labspec/src/threads.rs"]);
}

/// A link to a lesson is followed below the root, and reported if it leads out of it.
#[cfg(unix)]
#[test]
fn links_in_folders_are_followed_or_named() {
    use std::os::unix::fs::symlink;
    let folder = folder();
    let at = |name: &str| folder.path().join(name);
    std::fs::create_dir_all(at("week/shared")).unwrap();
    std::fs::create_dir_all(at("outside")).unwrap();
    std::fs::write(at("week/shared/fall.json"), crate::program::FALL).unwrap();
    std::fs::write(at("outside/far.md"), "# Far\n").unwrap();
    symlink("shared/fall.json", at("week/again.json")).unwrap();
    let done = run_in(folder.path(), &["check", "week"]);
    assert_eq!(done.code, 0, "{}{}", done.stdout, done.stderr);
    // It is one file with two names.
    assert!(done.stdout.contains("\n1 file, 1 lab run"), "{}", done.stdout);
    symlink("../fall.json", at("week/out.json")).unwrap();
    symlink("../outside", at("week/far")).unwrap();
    let done = run_in(folder.path(), &["check", "week"]);
    assert_eq!(done.code, 3, "{}{}", done.stdout, done.stderr);
    for name in ["week/out.json is skipped: it is a link that leads outside", "week/far is skipped"] {
        assert!(done.stderr.contains(name), "{}", done.stderr);
    }
    assert!(done.stdout.contains("but not everything was"), "{}", done.stdout);
    let json: serde_json::Value =
        serde_json::from_str(&run_in(folder.path(), &["check", "week", "--format", "json"]).stdout).unwrap();
    let left: Vec<&serde_json::Value> =
        json["ledger"].as_array().unwrap().iter().filter(|e| e["owner"] == "week/out.json").collect();
    assert_eq!(left.len(), 1, "{json:#}");
    // With a root that contains both, the file is read.
    std::fs::write(at("labspec.toml"), "").unwrap();
    let done = run_in(folder.path(), &["check", "week"]);
    assert_eq!(done.code, 0, "{}{}", done.stdout, done.stderr);
    assert!(done.stdout.contains("\n2 files, 2 labs run"), "{}", done.stdout);
    // A dangling link is reported as well.
    symlink("nowhere.md", at("week/lost.md")).unwrap();
    let done = run_in(folder.path(), &["check", "week"]);
    assert!(done.code == 1 && done.stdout.contains("cannot read week/lost.md"), "{}", done.stdout);
}

/// A file counts once, whatever its paths are.
#[test]
fn a_path_that_is_given_twice_is_one_file() {
    let folder = folder();
    for arguments in [
        &["check", "course/a.md", "course/../course/a.md"][..],
        &["check", "course", "course/a.md", "./course"],
    ] {
        let done = run_in(folder.path(), arguments);
        assert!(done.code == 0 && done.stdout.contains("\n1 file, 2 labs run"), "{}", done.stdout);
    }
    // Standard input replaces the file with its name.
    let arguments = ["check", "course/a.md", "-", "--stdin-name", "./course/a.md"];
    let done = crate::program::run_with_input(folder.path(), &arguments, &crate::program::wrong());
    assert!(done.code == 1 && done.stdout.contains("\n1 file, "), "{}", done.stdout);
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("a.md", folder.path().join("course/b.md")).unwrap();
        let done = run_in(folder.path(), &["check", "course/b.md", "course/a.md"]);
        assert!(done.code == 0 && done.stdout.contains("\n1 file, 2 labs run"), "{}", done.stdout);
    }
}
