//! Random and damaged input of every kind: no panic, no hang, bounded memory, and the same result twice. A test run has a fixed
//! number of cases with a fixed seed. This command runs each kind for an hour with other seeds:
//!
//!     LABSPEC_FUZZ_SECONDS=3600 LABSPEC_SEED=2 cargo test -- fuzz --nocapture
//!
//! A failure reports the number of its case. `LABSPEC_FUZZ_CASE=4294967296 cargo test -- fuzz::lessons --nocapture`
//! runs only this case and writes its input to `target/tmp`. The expressions are in `crates/expr/src/tests/language.rs`.

#![allow(clippy::unwrap_used, clippy::panic)]

mod files;
mod lessons;
mod models;
mod public;

use crate::support::thread_time;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::time::{Duration, Instant};

/// The maximum time of one case, in a build with few optimizations. It is processor time if that is known, because the machine
/// may be busy with other programs.
const LONGEST: Duration = Duration::from_secs(60);

fn variable(name: &str) -> Option<u64> {
    std::env::var(name).ok().and_then(|s| s.parse().ok())
}

/// Runs `cases` cases, or as many as fit into `LABSPEC_FUZZ_SECONDS`. A case returns its input.
fn run_cases(cases: u64, mut case: impl FnMut(u64) -> String) {
    if let Some(n) = variable("LABSPEC_FUZZ_CASE") {
        let case_file = Path::new(env!("CARGO_TARGET_TMPDIR")).join("case");
        let input = case(n);
        std::fs::write(&case_file, &input).unwrap();
        println!("the input of case {n} is in {}", case_file.display());
        return;
    }
    let limit = variable("LABSPEC_FUZZ_SECONDS").map(Duration::from_secs);
    let first = variable("LABSPEC_SEED").unwrap_or(1) << 32;
    let (start, mut n) = (Instant::now(), 0);
    while limit.map_or(n < cases, |limit| start.elapsed() < limit) {
        let (begin, ran) = (Instant::now(), thread_time());
        let done = catch_unwind(AssertUnwindSafe(|| case(first + n)));
        assert!(done.is_ok(), "case {} fails", first + n);
        let elapsed = thread_time().zip(ran).map_or(begin.elapsed(), |(now, ran)| now - ran);
        assert!(elapsed < LONGEST, "case {} takes {elapsed:?}", first + n);
        n += 1;
    }
    println!("{n} cases");
}
