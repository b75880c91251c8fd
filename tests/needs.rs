//! Prerequisites of some tests that not every machine has: the material in `../shared`, node, Python, and namespaces of the
//! system.
//!
//! Without its prerequisite, a test checks nothing, passes, and prints this past the output capture of `cargo test`, with the
//! number of such tests so far; `zz.rs` prints the total. With `LABSPEC_REQUIRE=all`, as in `.ci/run`, it fails.

#![allow(clippy::unwrap_used)]

use std::collections::BTreeMap;
use std::io::Write;
use std::path::Path;
use std::process::Command;
use std::sync::Mutex;

/// Tests with the first missing prerequisite of each.
static MISSING: Mutex<BTreeMap<String, String>> = Mutex::new(BTreeMap::new());

/// Whether a prerequisite exists: `node`, `python3`, `unshare` (namespaces of users and networks), or a path relative to the
/// workspace (`../shared/corpus`). Must be called before anything else; if it returns `false`, the test must return. Nobody can
/// install what a kernel forbids: tests that need `unshare` are skipped there in every case.
pub(crate) fn needs(what: &str) -> bool {
    if is_available(what) {
        return true;
    }
    assert!(!requires_all() || what == "unshare", "{}", refusal(what));
    let test = std::thread::current().name().unwrap_or("a test").to_string();
    let mut missing = MISSING.lock().unwrap();
    if missing.insert(test.clone(), what.into()).is_none() {
        say(&format!("skipped ({}): {test} needs {what}, which is not there", missing.len()));
    }
    false
}

/// Whether nothing may be left out.
pub(crate) fn requires_all() -> bool {
    std::env::var_os("LABSPEC_REQUIRE").is_some_and(|value| value == "all")
}

pub(crate) fn is_available(what: &str) -> bool {
    match what {
        "node" | "python3" => Command::new(what).arg("--version").output().is_ok_and(|o| o.status.success()),
        "unshare" => {
            let options = ["--user", "--map-root-user", "--net", "--pid", "--kill-child=KILL", "true"];
            Command::new("unshare").args(options).output().is_ok_and(|o| o.status.success())
        }
        place => Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(place).exists(),
    }
}

fn refusal(what: &str) -> String {
    format!("LABSPEC_REQUIRE=all: this test needs {what}, which is not there")
}

/// Prints a line that the output capture of tests does not suppress.
fn say(line: &str) {
    let _ = writeln!(std::io::stderr().lock(), "{line}");
}

/// Prints the total, for the last test of a binary.
pub(crate) fn summary() {
    let missing = MISSING.lock().unwrap();
    let mut reasons = BTreeMap::new();
    missing.values().for_each(|what| *reasons.entry(what).or_insert(0) += 1);
    let list: Vec<String> = reasons.iter().map(|(what, n)| format!("{n} for want of {what}")).collect();
    if !list.is_empty() {
        say(&format!("{} tests of this binary were skipped: {}", missing.len(), list.join(", ")));
    }
}

#[test]
fn missing_prerequisites_are_detected() {
    assert!(is_available("tests/needs.rs") && !is_available("../nowhere/at-all"));
}
