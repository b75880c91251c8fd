//! No option and no command replaces a file of another kind.

#![allow(clippy::unwrap_used)]

use crate::files::read;
use crate::program::{folder, program, run_in};
use serde_json::json;
use std::path::Path;

/// The names and contents of files that other programs or other options wrote.
fn of_others(folder: &Path) -> Vec<String> {
    let texts: [(&str, &str); 12] = [
        ("notes.txt", "written by hand\n"),
        ("measured.csv", "time,height\n0,1\n0.1,0.95\n"),
        ("times.csv", "time\n0.10\n0.20\n"),
        ("page.html", "<!DOCTYPE html>\n<p>A page of the course.</p>\n"),
        ("drawn.svg", "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"9\"><rect/></svg>\n"),
        ("data.json", "{\"a\": 1}\n"),
        ("list.json", "[{\"report\": \"run\"}]\n"),
        ("labspec.toml", "ignore = []\n"),
        ("empty.md", ""),
        ("clean.md.snap", "labspec snapshot, or so\n"),
        ("photo.png", "\u{89}PNG of a mountain"),
        ("no-ending", "a text\n"),
    ];
    for (name, text) in texts {
        std::fs::write(folder.join(name), text).unwrap();
    }
    let mut all: Vec<String> = texts.iter().map(|(name, _)| (*name).to_string()).collect();
    all.extend(["clean.md", "fall.json", "models/free_fall.xml"].map(String::from));
    all
}

/// Options that write a file, with a command that needs nothing else; the second list contains those that only read one.
const WRITERS: [(&str, &[&str]); 15] = [
    ("check --record", &["check", "fall.json", "--record"]),
    ("check --html", &["check", "fall.json", "--html"]),
    ("check --judge-request", &["check", "fall.json", "--judge-request"]),
    ("check --baseline", &["check", "fall.json", "--update-baseline", "--baseline"]),
    ("verify --judge-request", &["verify", "fall.json", "--judge-request"]),
    ("verify --baseline", &["verify", "fall.json", "--update-baseline", "--baseline"]),
    ("run --csv", &["run", "fall.json", "--steps", "2", "--csv"]),
    ("run --json", &["run", "fall.json", "--steps", "2", "--json"]),
    ("run --svg", &["run", "fall.json", "--steps", "2", "--svg"]),
    ("run --png", &["run", "fall.json", "--steps", "2", "--png"]),
    ("precision --csv", &["precision", "fall.json", "--until", "0.02", "--csv"]),
    ("precision --svg", &["precision", "fall.json", "--until", "0.02", "--svg"]),
    ("precision --png", &["precision", "fall.json", "--until", "0.02", "--png"]),
    ("stability --svg", &["stability", "map.json", "--until", "0.02", "--map", "a,b", "--svg"]),
    ("stability --png", &["stability", "map.json", "--until", "0.02", "--map", "a,b", "--png"]),
];
const READERS: [&str; 10] = [
    "build --config",
    "check --config",
    "check --judge",
    "check --since",
    "verify --config",
    "verify --judge",
    "config --config",
    "lsp --config",
    "precision --beside",
    "preview --config",
];

/// All options of all commands that name a file, from the help of the program.
fn file_options(folder: &Path) -> Vec<String> {
    let help =
        |arguments: &[&str]| String::from_utf8(program(folder, arguments).output().unwrap().stdout).unwrap();
    let all_help = help(&["--help"]);
    let commands = all_help.lines().skip_while(|l| *l != "Commands:").skip(1).take_while(|l| !l.is_empty());
    let names =
        commands.filter_map(|l| l.strip_prefix("  ")?.split(' ').next().filter(|name| !name.is_empty()));
    let mut all = Vec::new();
    for command in names.filter(|name| *name != "help") {
        for line in help(&[command, "--help"]).lines().map(str::trim_start) {
            let Some((option, value)) = line.strip_prefix("--").and_then(|l| l.split_once(" <")) else {
                continue;
            };
            if value.contains("FILE") {
                all.push(format!("{command} --{option}"));
            }
        }
    }
    all.sort();
    all
}

#[test]
fn no_option_replaces_a_file_of_another_kind() {
    let folder = folder();
    let knobs = json!([{"label": "a", "set": "model.opt.gravity[2]", "min": -10, "max": -9, "value": -9.81},
        {"label": "b", "set": "model.opt.timestep", "min": 0.001, "max": 0.002, "value": 0.002}]);
    let lab = json!({"model": "free_fall", "stopAt": 0.02, "controls": knobs});
    std::fs::write(folder.path().join("map.json"), lab.to_string()).unwrap();
    // A new option of the program must be added to one of the lists.
    let mut expected: Vec<String> = WRITERS.iter().map(|(option, _)| (*option).to_string()).collect();
    expected.extend(READERS.iter().map(|option| (*option).to_string()));
    expected.sort();
    assert_eq!(file_options(folder.path()), expected);
    let others = of_others(folder.path());
    // The files of other options are of another kind as well.
    let mut written: Vec<(String, &str)> = Vec::new();
    for (i, (option, arguments)) in WRITERS.iter().enumerate() {
        let name = format!("out-{i}.dat");
        for _ in 0..2 {
            let done = run_in(folder.path(), &[*arguments, &[&name]].concat());
            assert_ne!(done.code, 2, "{option} does not replace its own: {}", done.stderr);
        }
        written.push((name, option));
    }
    // Tables of runs and of settings have the same kind, and so do plots.
    let kind = |option: &str| option.split(" --").nth(1).unwrap_or_default().to_string();
    for (option, arguments) in &WRITERS {
        let foreign = written.iter().filter(|(_, by)| kind(by) != kind(option)).map(|(name, _)| name);
        for name in others.iter().chain(foreign) {
            let before = std::fs::read(folder.path().join(name)).unwrap();
            let done = run_in(folder.path(), &[*arguments, &[name]].concat());
            assert_eq!(done.code, 2, "{option} {name}: {}", done.stdout);
            assert!(done.stderr.contains("would overwrite"), "{option} {name}: {}", done.stderr);
            assert!(std::fs::read(folder.path().join(name)).unwrap() == before, "{option} {name} is changed");
        }
    }
}

/// Commands that write without an option that names the file.
#[test]
fn no_command_replaces_a_file_of_another_kind() {
    let folder = folder();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    let same = |arguments: &[&str], name: &str, text: &str| {
        let done = run_in(folder.path(), arguments);
        assert_eq!(done.code, 2, "{arguments:?}: {}{}", done.stdout, done.stderr);
        assert_eq!(read(folder.path(), name), text, "{arguments:?}");
    };
    // Snapshots are neither overwritten nor removed.
    write("clean.md.snap", "notes of a photographer\n");
    same(&["snapshot", "clean.md", "--accept"], "clean.md.snap", "notes of a photographer\n");
    std::fs::create_dir(folder.path().join("old")).unwrap();
    write("old/gone.md.snap", "notes of a photographer\n");
    same(&["snapshot", "old", "--accept"], "old/gone.md.snap", "notes of a photographer\n");
    // A folder with a page of another origin.
    std::fs::create_dir_all(folder.path().join("site/pages")).unwrap();
    write("site/pages/codes.md", "# Codes of conduct\n");
    same(&["reference", "site/pages"], "site/pages/codes.md", "# Codes of conduct\n");
    write("labspec.toml", "deny = [\"warnings\"]\n");
    same(&["init", "."], "labspec.toml", "deny = [\"warnings\"]\n");
    // A lesson that is not UTF-8 differs from its decoded text.
    let latin =
        b"# A caf\xe9\n\n```lab simlab\n{\"model\": \"free_fall\", \"setup\": \"data.qpos[2]=1\"}\n```\n";
    std::fs::write(folder.path().join("latin.md"), latin).unwrap();
    for arguments in
        [&["fmt", "latin.md"][..], &["check", "latin.md", "--fix"], &["scaffold", "latin.md", "--write"]]
    {
        run_in(folder.path(), arguments);
        assert!(std::fs::read(folder.path().join("latin.md")).unwrap() == latin, "{arguments:?}");
    }
    // Commands that change lessons do not change other files.
    let model = read(folder.path(), "models/free_fall.xml");
    for command in [&["fmt"][..], &["check", "--fix"], &["check", "--unsafe-fixes"], &["scaffold", "--write"]]
    {
        run_in(folder.path(), &[command, &["models/free_fall.xml"]].concat());
        assert_eq!(read(folder.path(), "models/free_fall.xml"), model, "{command:?}");
    }
}
