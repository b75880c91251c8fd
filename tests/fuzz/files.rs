//! Random trees of files with unusual names, contents and file types, and random command lines for them. The program terminates
//! without a signal, with exit code 0, 1 or 2.

use super::run_cases;
use crate::program::{CLEAN, FALL, wrong};
use crate::support::model_text;
use crate::support::random::Random;
use crate::support::report::hold;
use std::fs::File;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// The number of cases of a test run.
const CASES: u64 = 40;
/// The maximum time of one call of the program, on a busy machine.
const LONGEST: Duration = Duration::from_secs(120);

const NAMES: &[&str] = &[
    "a.md",
    "b.json",
    "c.xml",
    "d.MD",
    "e.markdown",
    "models",
    "lessons",
    "labspec.toml",
    " spaced .md",
    "-dash.md",
    "--help",
    "é.md",
    "\u{202e}dm.x",
    "line\nbreak.md",
    "esc\u{1b}[2J.md",
    "x.md",
    "x.json",
    "x.xml",
    "ball_drop.xml",
    "free_fall.xml",
    "a#1.md",
    "%s.md",
    ".hidden.md",
    "noending",
    "con",
    "a'b\"c.md",
    "*.md",
];

const WORDS: &[&str] = &[
    "--models",
    "--format",
    "json",
    "human",
    "--color",
    "always",
    "--until",
    "0.1",
    "-1",
    "nan",
    "1e300",
    "--steps",
    "10",
    "--every",
    "0",
    "--set",
    "gravity=-1",
    "timestep=0.005",
    "=",
    "--press",
    "Kick@0.1",
    "@",
    "--csv",
    "out.csv",
    "--json",
    "out.json",
    "--svg",
    "out.svg",
    "--check",
    "--help",
    "--",
    "",
    "-",
    ".",
    "nothing-here",
    "missing-setconst",
    "--integrators",
    "\u{1b}[31m",
    "a.md#1",
    "a.md#99",
    "b.json#1",
    "#",
];

fn write(path: &Path, random: &mut Random) {
    // Writing into a pipe would block until it is read.
    if std::fs::metadata(path).is_ok_and(|m| !m.is_file()) {
        return;
    }
    let text: Vec<u8> = match random.below(12) {
        0 => Vec::new(),
        1 => vec![0xff, 0xfe, b'a', 0, b'\n', 0],
        2 => b"\xef\xbb\xbf# with a mark\n".to_vec(),
        3 => "Grüße".chars().map(|c| c as u8).collect(),
        4 => vec![0; 5000],
        5 => wrong().into_bytes(),
        6 => FALL.into(),
        7 => model_text("ball_drop").into_bytes(),
        8 => format!("{CLEAN}{}", "\u{1b}[2J\r\u{202e}").into_bytes(),
        9 => CLEAN.replace('\n', "\r\n").into_bytes(),
        10 => CLEAN[..CLEAN.len() / 2].into(),
        _ => CLEAN.into(),
    };
    let _ = std::fs::write(path, text);
}

/// Unusual files. Links point into the tree and may form cycles.
#[cfg(unix)]
fn unusual_file(path: &Path, all: &[PathBuf], random: &mut Random) {
    use std::os::unix::fs::{PermissionsExt, symlink};
    match random.below(5) {
        0 => drop(symlink(path, path)),
        1 => drop(symlink(random.pick(all), path)),
        2 => drop(symlink(path.parent().unwrap(), path)),
        3 => drop(Command::new("mkfifo").arg(path).stderr(Stdio::null()).status()),
        _ => {
            write(path, random);
            let _ = std::fs::set_permissions(path, std::fs::Permissions::from_mode(0o0));
        }
    }
}

#[cfg(not(unix))]
fn unusual_file(path: &Path, _: &[PathBuf], random: &mut Random) {
    write(path, random);
}

/// Fills a folder. Returns all paths that were created or attempted.
fn grow(root: &Path, random: &mut Random) -> Vec<PathBuf> {
    let (mut folders, mut all) = (vec![root.to_path_buf()], vec![root.to_path_buf()]);
    for _ in 0..3 + random.below(14) {
        let path = random.pick(&folders).join(random.word(NAMES));
        match random.below(6) {
            0 | 1 => {
                if std::fs::create_dir(&path).is_ok() {
                    folders.push(path.clone());
                }
            }
            2 if !path.exists() => unusual_file(&path, &all, random),
            _ => write(&path, random),
        }
        all.push(path);
    }
    all
}

/// Runs the program, and kills it after `LONGEST`. Returns its error output, or how it failed.
fn run(root: &Path, outputs: &Path, arguments: &[String]) -> Result<String, String> {
    let out = |name: &str| File::create(outputs.join(name)).unwrap();
    let mut child = Command::new(env!("CARGO_BIN_EXE_labspec"))
        .args(arguments)
        .env("LABSPEC_CACHE", "")
        .current_dir(root)
        .stdin(Stdio::null())
        .stdout(out("stdout"))
        .stderr(out("stderr"))
        .spawn()
        .unwrap();
    let start = Instant::now();
    let status = loop {
        if let Some(status) = child.try_wait().unwrap() {
            break status;
        }
        if start.elapsed() > LONGEST {
            child.kill().unwrap();
            child.wait().unwrap();
            return Err("does not end".into());
        }
        std::thread::sleep(Duration::from_millis(2));
    };
    let text = String::from_utf8_lossy(&std::fs::read(outputs.join("stderr")).unwrap()).into_owned();
    match status.code() {
        Some(0..=2) => {
            hold(&String::from_utf8_lossy(&std::fs::read(outputs.join("stdout")).unwrap()));
            Ok(text)
        }
        other => Err(format!("ends with {other:?}: {text}")),
    }
}

#[test]
fn odd_files_and_command_lines_end_with_0_1_or_2() {
    run_cases(CASES, |n| {
        let mut random = Random(n);
        let (folder, outputs) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
        let all = grow(folder.path(), &mut random);
        let mut transcript = String::new();
        for _ in 0..3 {
            let command = random.word(&[
                "check",
                "check",
                "verify",
                "fmt",
                "run",
                "precision",
                "plan",
                "explain",
                "record",
                "",
                "chekc",
            ]);
            let mut arguments = vec![command.to_string()];
            for _ in 0..random.below(5) {
                arguments.push(if random.below(2) == 0 {
                    let path = random.pick(&all).strip_prefix(folder.path()).unwrap();
                    let number = random.word(&["", "", "", "#1", "#drop.1"]);
                    format!(
                        "{}{number}",
                        if path.as_os_str().is_empty() { ".".into() } else { path.display().to_string() }
                    )
                } else {
                    random.word(WORDS).to_string()
                });
            }
            transcript += &format!("{arguments:?}\n");
            if let Err(how) = run(folder.path(), outputs.path(), &arguments) {
                panic!("labspec {arguments:?} {how}\nin {all:#?}");
            }
        }
        transcript
    });
}
