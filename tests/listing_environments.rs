//! `labspec check --listings`: the environments of listings. A script takes the place of `uv`, so that nothing is downloaded.

#![allow(clippy::unwrap_used, clippy::panic)]

use crate::needs::{is_available, needs};
use crate::program::program;
use serde_json::Value;
use std::path::Path;

const LESSON: &str =
    "# A number\n\n```python\nimport installed\nprint(installed.VALUE)\n```\nOutput:\n```text\n42\n```\n";

/// Makes environments with a module `installed`, and writes its arguments into a file.
const UV: &str = r#"#!/bin/sh
here=$(dirname "$0")
echo "$@" >> "$here/log"
[ ! -e "$here/broken" ] || exit 1
add() { echo "VALUE = 42" > "$("$1" -c 'import site; print(site.getsitepackages()[0])')/installed.py"; }
case "$1" in
  venv) for last; do :; done; python3 -m venv --without-pip "$last" ;;
  pip) add "$5" ;;
  sync) cd "$7" && python3 -m venv --without-pip "$UV_PROJECT_ENVIRONMENT" && add "$UV_PROJECT_ENVIRONMENT/bin/python" ;;
esac
"#;

/// A folder with the lesson, a project and the script, or `None` where listings cannot run.
fn folder(settings: &str) -> Option<tempfile::TempDir> {
    if !needs("python3") {
        return None;
    }
    let folder = tempfile::tempdir().unwrap();
    let write = |path: &str, text: &str| {
        let path = folder.path().join(path);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(&path, text).unwrap();
        path
    };
    let network = if is_available("unshare") { "" } else { "network = true" };
    write("labspec.toml", &format!("[listings]\n{network}\n{settings}\n"));
    write("a.md", LESSON);
    write("course/pyproject.toml", "[project]\nname = \"course\"\n");
    write("course/uv.lock", "version = 1\n");
    let uv = write("programs/uv", UV);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        std::fs::set_permissions(&uv, std::fs::Permissions::from_mode(0o755)).unwrap();
    }
    Some(folder)
}

/// The numbers of true and unchecked listings, and the remark about the first one.
fn check(folder: &Path) -> (u64, u64, String) {
    let mut command = program(folder, &["check", "a.md", "--listings", "--format", "json"]);
    let programs = folder.join("programs");
    let inherited = std::env::var_os("PATH").unwrap_or_default();
    let path = std::env::join_paths([programs].into_iter().chain(std::env::split_paths(&inherited))).unwrap();
    let output = command.env("PATH", path).env("LABSPEC_CACHE", "cache").output().unwrap();
    let report: Value = serde_json::from_slice(&output.stdout)
        .unwrap_or_else(|e| panic!("{e}: {}", String::from_utf8_lossy(&output.stderr)));
    let count = |state: &str| report["summary"]["claims"]["listing"][state].as_u64().unwrap();
    let entries = report["ledger"].as_array().unwrap();
    let listing = entries.iter().find(|entry| entry["subject"] == "listing").unwrap();
    (count("simulated"), count("unchecked"), listing["remark"].as_str().unwrap_or_default().to_string())
}

/// The commands of the script, without the questions for its version.
fn commands(folder: &Path) -> Vec<String> {
    let log = std::fs::read_to_string(folder.join("programs/log")).unwrap_or_default();
    log.lines().filter(|line| *line != "--version").map(String::from).collect()
}

#[test]
fn a_project_of_uv_gives_the_environment_of_its_lock_file() {
    let Some(folder) = folder("project = \"course\"") else { return };
    let folder = folder.path();
    assert_eq!(check(folder).0, 1, "{:?}", check(folder));
    let first = commands(folder);
    let start = "sync --frozen --no-install-project --no-build --no-config --project ";
    assert!(
        first.len() == 1 && first[0].starts_with(start) && first[0].contains("course --python "),
        "{first:?}"
    );
    // It is made once, and again for another lock file.
    std::fs::write(folder.join("a.md"), LESSON.replace("# A number", "# The number")).unwrap();
    assert_eq!((check(folder).0, commands(folder).len()), (1, 1));
    std::fs::write(folder.join("course/uv.lock"), "version = 2\n").unwrap();
    assert_eq!((check(folder).0, commands(folder).len()), (1, 2));
    let environments = std::fs::read_dir(folder.join("cache/environments")).unwrap().count();
    assert_eq!(environments, 2, "nothing is left half made");
}

#[test]
fn packages_are_installed_by_uv_where_it_is() {
    let Some(folder) = folder("requirements = [\"some==1.0\"]") else { return };
    let folder = folder.path();
    assert_eq!(check(folder).0, 1, "{:?}", check(folder));
    let made = commands(folder);
    assert!(made.len() == 2 && made[0].starts_with("venv --no-config --python "), "{made:?}");
    assert!(made[1].ends_with("--only-binary :all: some==1.0"), "{made:?}");
}

#[test]
fn a_project_that_cannot_be_installed_is_not_checked() {
    let Some(folder) = folder("project = \"course\"") else { return };
    let folder = folder.path();
    std::fs::write(folder.join("programs/broken"), "").unwrap();
    let (simulated, unchecked, remark) = check(folder);
    assert!(
        (simulated, unchecked) == (0, 1) && remark.contains("`project` needs the program `uv`"),
        "{remark}"
    );
    std::fs::remove_file(folder.join("programs/broken")).unwrap();
    std::fs::remove_file(folder.join("course/uv.lock")).unwrap();
    let (simulated, unchecked, remark) = check(folder);
    assert!(
        (simulated, unchecked) == (0, 1) && remark.contains("uv.lock") && remark.contains("`uv lock`"),
        "{remark}"
    );
}

/// `python` may be the folder of an environment.
#[test]
fn an_environment_is_named_by_its_folder() {
    let Some(folder) = folder("python = \"own\"") else { return };
    let folder = folder.path();
    let (_, unchecked, remark) = check(folder);
    assert!(unchecked == 1 && remark.contains("own does not run"), "{remark}");
    let made = std::process::Command::new("python3")
        .args(["-m", "venv", "--without-pip", "own"])
        .current_dir(folder)
        .status();
    assert!(made.unwrap().success());
    let site = std::fs::read_dir(folder.join("own/lib")).unwrap().next().unwrap().unwrap().path();
    std::fs::write(site.join("site-packages/installed.py"), "VALUE = 42\n").unwrap();
    assert_eq!(check(folder).0, 1);
    assert!(commands(folder).is_empty());
}
