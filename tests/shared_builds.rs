//! What is built for one purpose is not built again for another one.

#![allow(clippy::unwrap_used)]

use crate::support::workspace;
use std::collections::BTreeSet;

/// `cargo test` builds no crate again that `cargo run -p labspec-cli` has built: both ask for the same features of each crate.
#[test]
fn the_program_and_the_tests_share_their_crates() {
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
    let tests = features(&["--workspace", "-e", "normal,build,dev"]);
    assert!(program.len() > 100, "{program:?}");
    assert_eq!(program.difference(&tests).collect::<Vec<_>>(), Vec::<&String>::new());
}

/// Packages of others that the tests have built are not built again for the C library and for the Python package because of their version.
#[test]
fn the_bindings_have_the_versions_of_the_workspace() {
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
    for folder in ["bindings/c", "bindings/python"] {
        let has_other = |package: &&(String, String)| {
            let is_compatible = |(name, version): &(String, String)| {
                *name == package.0 && compatible(version) == compatible(&package.1)
            };
            !workspace.contains(*package) && workspace.iter().any(is_compatible)
        };
        let all = packages(folder);
        assert!(all.len() > 50, "{all:?}");
        assert_eq!(
            all.iter().filter(has_other).collect::<Vec<_>>(),
            Vec::<&(String, String)>::new(),
            "{folder}"
        );
    }
}
