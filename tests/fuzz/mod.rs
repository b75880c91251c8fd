//! Random and damaged input of every kind: no panic, no hang, bounded memory, and the same result twice. A test run has a fixed
//! number of cases with a fixed seed. This command runs each kind for an hour with other seeds:
//!
//!     LABSPEC_FUZZ_SECONDS=3600 LABSPEC_SEED=2 cargo test --workspace -- fuzz --nocapture
//!
//! A failure reports the number of its case. `LABSPEC_FUZZ_CASE=4294967296 cargo test --workspace -- fuzz::lessons --nocapture`
//! runs only this case and writes its input to `target/tmp`. The expressions are in `crates/expr/src/tests/language.rs`.

#![allow(clippy::unwrap_used, clippy::panic)]

mod files;
mod lessons;
mod models;
mod public;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::time::{Duration, Instant};

/// The maximum time of one case, in a build with few optimizations. It is processor time if that is known, because the machine
/// may be busy with other programs.
const LONGEST: Duration = Duration::from_secs(60);

/// A pseudorandom sequence of numbers (Steele, Lea and Flood 2014, SplitMix64).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number below `n`; `n` must not be 0.
    fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }

    fn pick<'a, T>(&mut self, list: &'a [T]) -> &'a T {
        &list[self.below(list.len())]
    }

    fn word(&mut self, list: &[&'static str]) -> &'static str {
        list[self.below(list.len())]
    }
}

fn variable(name: &str) -> Option<u64> {
    std::env::var(name).ok().and_then(|s| s.parse().ok())
}

/// The processor time of this thread.
fn running() -> Option<Duration> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    text.split(' ').next()?.parse().ok().map(Duration::from_nanos)
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
        let (begin, ran) = (Instant::now(), running());
        let done = catch_unwind(AssertUnwindSafe(|| case(first + n)));
        assert!(done.is_ok(), "case {} fails", first + n);
        let elapsed = running().zip(ran).map_or(begin.elapsed(), |(now, ran)| now - ran);
        assert!(elapsed < LONGEST, "case {} takes {elapsed:?}", first + n);
        n += 1;
    }
    println!("{n} cases");
}
