//! The models of `../shared` (conformance, corpus, bench) against what MuJoCo 3.14.0 computes for them.
//!
//! The repository keeps two states of each model, in `golden/conformance`. With `LABSPEC_ORACLE` naming a Python that has
//! mujoco 3.14.0, the library itself is asked for eight.

#![allow(clippy::unwrap_used, clippy::panic)]

use crate::recorded::examine;
use crate::standing::{Exception, Standing};
use crate::support::{models, read_json, workspace};
use std::path::PathBuf;
use std::process::Command;

/// What is known to differ, and why.
const EXCEPTIONS: &[Exception] = &[
    ("*", "compile", "fields whose compilation is not here yet"),
    ("*", "forward", "fields whose compilation is not here yet"),
    ("*", "implicit", "the integrator is not here yet"),
    ("*", "discrete", "the integrator is not here yet"),
];

/// Folder of the recordings, and of the models in `../shared`.
const FOLDERS: [(&str, &str); 3] =
    [("conformance", "conformance/models"), ("corpus", "corpus/models"), ("bench", "bench")];

/// The recordings: those of the repository, or new ones of the library itself in a folder of their own.
fn recordings() -> (PathBuf, Option<tempfile::TempDir>) {
    let Some(python) = std::env::var_os("LABSPEC_ORACLE") else {
        return (workspace().join("tests/golden/conformance"), None);
    };
    let folder = tempfile::tempdir().unwrap();
    let script = workspace().join("tests/golden/conformance.py").canonicalize().unwrap();
    let asked = Command::new(python)
        .arg(script)
        .args(["--states", "8", "--out"])
        .arg(folder.path())
        .current_dir(folder.path())
        .output()
        .unwrap();
    assert!(asked.status.success(), "{}", String::from_utf8_lossy(&asked.stderr));
    (folder.path().to_path_buf(), Some(folder))
}

#[test]
fn every_shared_model_is_as_recorded() {
    let shared = workspace().join("../shared");
    if !shared.join("conformance").is_dir() {
        println!("skipped: there are no models in {}", shared.display());
        return;
    }
    let (recordings, fresh) = recordings();
    let mut standing = Standing::default();
    for (kind, folder) in FOLDERS {
        for name in models(&shared.join(folder)) {
            let recording = read_json(&recordings.join(kind).join(format!("{name}.json")));
            let model = shared.join(folder).join(format!("{name}.xml"));
            standing.add(format!("{kind}/{name}"), examine(&model, &recording));
        }
    }
    standing.check(if fresh.is_some() { None } else { Some("conformance") }, EXCEPTIONS);
}
