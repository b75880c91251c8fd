//! Many lessons at once: on several threads, from the cache, and again when files change. The output is always the same.

#![allow(clippy::unwrap_used, clippy::panic)]

use crate::needs::needs;
use crate::population::takes_all;
use crate::program::{folder, program, wrong};
use crate::support::workspace;
use std::path::Path;

/// The output and the exit code, with or without a cache folder.
fn stdout_and_code(here: &Path, cache: Option<&Path>, arguments: &[&str]) -> (String, Option<i32>) {
    let mut command = program(here, arguments);
    if let Some(cache) = cache {
        command.env("LABSPEC_CACHE", cache);
    }
    let output = command.output().unwrap();
    assert_eq!(String::from_utf8(output.stderr).unwrap(), "", "{arguments:?}");
    (String::from_utf8(output.stdout).unwrap(), output.status.code())
}

/// All lessons.
fn all_lessons() -> Vec<&'static str> {
    let mut folders = vec!["specs/lessons", "tests/lessons"];
    if needs("../shared/corpus") {
        folders.extend(["../shared/corpus/labs", "../shared/corpus/quizzes"]);
    }
    folders
}

#[test]
fn threads_and_the_cache_change_no_byte() {
    let cache_folder = tempfile::tempdir().unwrap();
    for folder in all_lessons() {
        let check = |format: &str, cache: Option<&Path>, more: &[&str]| {
            let all = [&["check", folder, "--format", format], more].concat();
            stdout_and_code(&workspace(), cache, &all)
        };
        let cache = Some(cache_folder.path());
        // The first of the other runs fills the cache. The cached results serve both formats.
        let human = [(cache, "8"), (cache, "2"), (cache, "1")];
        let json = [(cache, "2")];
        for (format, others) in [("human", &human[..]), ("json", &json[..])] {
            // A sample takes the results in JSON without the cache for the example lessons alone.
            if format == "json" && folder != "specs/lessons" && !takes_all() {
                continue;
            }
            let alone = check(format, None, &["--jobs", "1"]);
            assert!(alone.0.len() > 1000 && alone.1.is_some_and(|code| code < 2), "{folder}: {}", alone.0);
            for &(cache, jobs) in others {
                let other = check(format, cache, &["--jobs", jobs]);
                assert!(other == alone, "{folder} {format} --jobs {jobs}, cached: {}", cache.is_some());
            }
        }
    }
    // One file for each lesson, and one for the program.
    let files = std::fs::read_dir(cache_folder.path()).unwrap().count();
    assert!(files > 50, "{files}");
}

/// `off` is not a folder name.
#[test]
fn the_cache_can_be_switched_off() {
    let here = folder();
    let names = || {
        std::fs::read_dir(here.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect::<Vec<_>>()
    };
    let before = names();
    for off in ["", "off"] {
        stdout_and_code(here.path(), Some(Path::new(off)), &["check", "clean.md"]);
    }
    assert_eq!(names(), before);
}

/// The findings of the first lesson are printed while the second is still running.
#[test]
fn findings_are_printed_as_lessons_are_done() {
    use std::io::{BufRead, BufReader, Read};
    let folder = tempfile::tempdir().unwrap();
    let model =
        "<mujoco><worldbody><body pos='0 0 1'><freejoint/><geom size='.1'/></body></worldbody></mujoco>";
    let lab = |until: u32| {
        format!(
            r#"{{"xml": "{model}", "readouts": [{{"label": "z (m)", "exp": "data.qpos[2]"}}], "verify": {{"runs": {{"r": {{"until": {until}}}}}, "value": "data.time"}}}}"#
        )
    };
    std::fs::write(folder.path().join("a.json"), lab(1)).unwrap();
    std::fs::write(folder.path().join("b.json"), lab(2000)).unwrap();
    let mut command = program(folder.path(), &["check", ".", "--jobs", "1", "--no-cache"]);
    let mut child = command.stdout(std::process::Stdio::piped()).spawn().unwrap();
    let mut out = BufReader::new(child.stdout.take().unwrap());
    let mut first = String::new();
    out.read_line(&mut first).unwrap();
    let running = child.try_wait().unwrap().is_none();
    let mut rest = String::new();
    out.read_to_string(&mut rest).unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(1));
    assert!(first.contains("error") && running, "{first}{rest}");
}

#[test]
fn without_a_cache_no_file_is_stored() {
    let (folder, cache_folder) = (folder(), tempfile::tempdir().unwrap());
    let files = || std::fs::read_dir(cache_folder.path()).unwrap().count();
    stdout_and_code(folder.path(), Some(cache_folder.path()), &["check", "clean.md", "--no-cache"]);
    assert_eq!(files(), 0);
    stdout_and_code(folder.path(), Some(cache_folder.path()), &["check", "clean.md"]);
    assert_eq!(files(), 2);
    // If the cache cannot be written, nothing is stored, and the results are complete.
    let blocked = folder.path().join("fall.json");
    let [here, there] =
        [None, Some(blocked.as_path())].map(|c| stdout_and_code(folder.path(), c, &["check", "clean.md"]));
    assert_eq!(here, there);
}

/// After a model changes or cache entries are damaged, the report is that of a check without a cache.
#[test]
fn cached_results_are_valid_only_for_equal_bytes() {
    let (folder, cache_folder) = (folder(), tempfile::tempdir().unwrap());
    let arguments = ["check", "clean.md", "wrong.md", "fall.json", "broken/lesson.md"];
    let same = || {
        let cached = stdout_and_code(folder.path(), Some(cache_folder.path()), &arguments);
        assert_eq!(cached, stdout_and_code(folder.path(), None, &arguments));
        cached.0
    };
    let before = same();
    assert_eq!(same(), before);
    let model = folder.path().join("models/free_fall.xml");
    let text = std::fs::read_to_string(&model).unwrap();
    std::fs::write(&model, text.replace("<mujoco", "<mujoco><option gravity='0 0 -3'/></mujoco><mujoco"))
        .unwrap();
    assert_ne!(same(), before);
    std::fs::write(&model, &text).unwrap();
    assert_eq!(same(), before);
    let files = || std::fs::read_dir(cache_folder.path()).unwrap().map(|f| f.unwrap().path());
    for cut in [0, 1, 64, 65, 100] {
        for path in files() {
            let bytes = std::fs::read(&path).unwrap();
            std::fs::write(&path, &bytes[..cut.min(bytes.len())]).unwrap();
        }
        assert_eq!(same(), before);
    }
    // A lab of another lesson.
    let other = folder.path().join("labs.md");
    let lab = |height: f64| {
        let lab = format!("{{\"model\": \"free_fall\", \"setup\": \"data.qpos[2] = {height}\"}}");
        std::fs::write(&other, format!("# Labs\n\n```lab simlab\n{lab}\n```\n")).unwrap();
    };
    let claim = r##"{"lab": "labs.md#1", "runs": {"fall": {"until": 0.1}}, "measure": {"top": "max(data.qpos[2])"}, "says": [["3 m", "top"]]}"##;
    let lesson = format!("<!-- labspec verify {claim} -->\nIt begins at 3 m.\n");
    std::fs::write(folder.path().join("said.md"), lesson).unwrap();
    let quoted = || {
        let cached = stdout_and_code(folder.path(), Some(cache_folder.path()), &["check", "said.md"]);
        assert_eq!(cached, stdout_and_code(folder.path(), None, &["check", "said.md"]));
        cached.1
    };
    for (height, code) in [(3.0, 0), (2.0, 1), (3.0, 0)] {
        lab(height);
        assert_eq!([quoted(), quoted()], [Some(code); 2], "{height}");
    }
    // Swapped entries.
    let names: Vec<_> = files().collect();
    let texts: Vec<_> = names.iter().map(|p| std::fs::read(p).unwrap()).collect();
    for (path, text) in names.iter().zip(texts.iter().cycle().skip(1)) {
        std::fs::write(path, text).unwrap();
    }
    assert_eq!(same(), before);
}

/// A program that is killed at the end of its test.
#[cfg(unix)]
struct Running(std::process::Child);

#[cfg(unix)]
impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.0.kill();
    }
}

/// A report, another one after a change, and the end by Ctrl-C.
#[cfg(unix)]
#[test]
fn watching_checks_changed_files_again() {
    use std::io::{BufRead, BufReader};
    use std::process::Stdio;
    use std::sync::mpsc;
    use std::time::Duration;

    let folder = folder();
    let mut command = program(folder.path(), &["check", "clean.md", "--watch"]);
    let mut child = Running(command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap());
    let (sender, lines) = mpsc::channel();
    for stream in [
        Box::new(child.0.stdout.take().unwrap()) as Box<dyn std::io::Read + Send>,
        Box::new(child.0.stderr.take().unwrap()),
    ] {
        let sender = sender.clone();
        std::thread::spawn(move || {
            for line in BufReader::new(stream).lines().map_while(Result::ok) {
                let _ = sender.send(line);
            }
        });
    }
    drop(sender);
    let wait_for = |what: &str| {
        let mut seen = Vec::new();
        loop {
            match lines.recv_timeout(Duration::from_secs(60)) {
                Ok(line) if line.contains(what) => return,
                Ok(line) => seen.push(line),
                Err(e) => panic!("{what}: {e}\n{}", seen.join("\n")),
            }
        }
    };
    wait_for("no problems found");
    std::fs::write(folder.path().join("clean.md"), wrong()).unwrap();
    wait_for("error[answer-refuted]");
    wait_for("1 file, 1 lab run");
    // A model is a dependency of the lesson.
    std::fs::write(folder.path().join("clean.md"), crate::program::CLEAN).unwrap();
    wait_for("no problems found");
    let model = folder.path().join("models/ball_drop.xml");
    std::fs::write(model, "<mujoco><worldbody><body><goem/></body></worldbody></mujoco>").unwrap();
    wait_for("goem");
    let id = child.0.id().to_string();
    assert!(std::process::Command::new("kill").args(["-INT", &id]).status().unwrap().success());
    assert_eq!(child.0.wait().unwrap().code(), Some(130));
}
