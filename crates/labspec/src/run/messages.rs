//! What went wrong in a run, as findings.

use super::{Breakdown, Trouble};
use crate::finding::Finding;
use std::ops::Range;

/// A program that threw, at its place. `done` says what was done to the lab: `as it stands`.
pub fn threw(t: &Trouble, done: &str) -> Finding {
    Finding::error(
        t.rule,
        t.text.span_of(t.span.clone()),
        format!("{} ({done}, at t = {} s)", t.message, t.time),
    )
    .why("on the page, an error in `setup` or `controller` freezes the lab, and one in a trace shows nan")
    .help("correct the statement, or guard it with a condition")
}

/// What broke, at `place`: what the engine warned of, or what went wrong silently, with time, joint or geoms and likely cause.
/// `done` says what was done to the lab.
pub fn broke(b: &Breakdown, done: &str, place: Range<usize>) -> Finding {
    let what = match b.rule.code {
        "engine-warning" => format!("the engine warns {done}: {}", b.what),
        "simulation-diverges" | "energy-grows" => format!("the simulation breaks {done}: {}", b.what),
        _ => format!("the simulation goes wrong {done}: {}", b.what),
    };
    Finding::warning(b.rule, place, what).why(b.why).help(b.help())
}
