//! What is built for one purpose is not built again for another one.

#![allow(clippy::unwrap_used)]

use crate::support::workspace;
use std::collections::BTreeSet;

/// `cargo test` builds no crate again that `cargo run -p labspec-cli` has built, and the Python package contains what both have built: all
/// ask for the same features of each crate.
#[test]
fn the_program_the_tests_and_the_python_package_share_their_crates() {
    let features = |arguments: &[&str]| -> BTreeSet<String> {
        let mut cargo = std::process::Command::new(env!("CARGO"));
        cargo.args([
            "tree",
            "--offline",
            "--locked",
            "--prefix",
            "none",
            "--no-dedupe",
            "--format",
            "{p} [{f}]",
        ]);
        let out = cargo.args(arguments).current_dir(workspace()).output().unwrap();
        assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
        String::from_utf8(out.stdout).unwrap().lines().map(str::to_owned).collect()
    };
    let program = features(&["-p", "labspec-cli", "-e", "normal"]);
    let tests = features(&["-e", "normal,build,dev"]);
    let python = features(&["-p", "labspec-python", "-e", "normal,build"]);
    assert!(program.len() > 100, "{program:?}");
    assert!(python.is_superset(&program), "{python:?}");
    assert_eq!(program.difference(&tests).collect::<Vec<_>>(), Vec::<&String>::new());
    // What only the package needs.
    let of_python = ["labspec-python ", "portable-atomic ", "pyo3", "target-lexicon "];
    let is_shared = |package: &&String| !of_python.iter().any(|name| package.starts_with(name));
    assert_eq!(python.difference(&tests).filter(is_shared).collect::<Vec<_>>(), Vec::<&String>::new());
}

/// Packages of others that the tests have built are not built again for the C library because of their version.
#[test]
fn the_c_library_has_the_versions_of_the_workspace() {
    let packages = |folder: &str| -> BTreeSet<(String, String)> {
        let text = std::fs::read_to_string(workspace().join(folder).join("Cargo.lock")).unwrap();
        let value = |line: Option<&str>, key: &str| {
            let value = line?.strip_prefix(key)?.strip_prefix(" = \"")?.strip_suffix('"')?;
            Some(value.to_owned())
        };
        let of_package = |part: &str| {
            let mut lines = part.lines();
            Some((value(lines.next(), "name")?, value(lines.next(), "version")?))
        };
        text.split("[[package]]\n").filter_map(of_package).collect()
    };
    // The numbers up to the first one that is not zero: versions with the same ones are compatible.
    let compatible = |version: &str| -> String {
        let zeros = version.split('.').take_while(|number| *number == "0").count();
        version.split('.').take(zeros + 1).collect::<Vec<_>>().join(".")
    };
    let workspace = packages("");
    assert!(workspace.len() > 100, "{workspace:?}");
    let has_other = |package: &&(String, String)| {
        let is_compatible = |(name, version): &(String, String)| {
            *name == package.0 && compatible(version) == compatible(&package.1)
        };
        !workspace.contains(*package) && workspace.iter().any(is_compatible)
    };
    let library = packages("bindings/c");
    assert!(library.len() > 50, "{library:?}");
    assert_eq!(library.iter().filter(has_other).collect::<Vec<_>>(), Vec::<&(String, String)>::new());
}
