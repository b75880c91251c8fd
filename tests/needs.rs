//! What some tests need and not every machine has: the material in `../shared`, and node.
//!
//! Without it a test checks nothing, passes, and says so past the capture of `cargo test`, with the number so far;
//! `zz.rs` ends with the sum. With `LABSPEC_REQUIRE=all`, as in `.ci/run`, it fails.

#![allow(clippy::unwrap_used)]

use std::collections::BTreeMap;
use std::io::Write;
use std::path::Path;
use std::process::Command;
use std::sync::Mutex;

/// Tests, and what the first thing was that each of them missed.
static MISSING: Mutex<BTreeMap<String, String>> = Mutex::new(BTreeMap::new());

/// Whether something is there that a test needs: `node`, or a place seen from the workspace (`../shared/corpus`). To be
/// asked before anything else; where the answer is no, the test has to return.
pub(crate) fn needs(what: &str) -> bool {
    if there(what) {
        return true;
    }
    let required = std::env::var_os("LABSPEC_REQUIRE").is_some_and(|value| value == "all");
    assert!(!required, "{}", refusal(what));
    let test = std::thread::current().name().unwrap_or("a test").to_string();
    let mut missing = MISSING.lock().unwrap();
    if missing.insert(test.clone(), what.into()).is_none() {
        say(&format!("skipped ({}): {test} needs {what}, which is not there", missing.len()));
    }
    false
}

fn there(what: &str) -> bool {
    match what {
        "node" => Command::new("node").arg("--version").output().is_ok_and(|o| o.status.success()),
        place => Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(place).exists(),
    }
}

fn refusal(what: &str) -> String {
    format!("LABSPEC_REQUIRE=all: this test needs {what}, which is not there")
}

/// Tests keep what macros print to themselves when they pass; this line they do not see.
fn say(line: &str) {
    let _ = writeln!(std::io::stderr().lock(), "{line}");
}

/// The sum, for the last test of a binary.
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
fn what_is_missing_is_told_from_what_is_there() {
    assert!(there("tests/needs.rs") && !there("../nowhere/at-all"));
}
