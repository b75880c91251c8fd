//! Findings about errors and breakdowns of a run.

use super::{Breakdown, ProgramError};
use crate::finding::Finding;
use std::ops::Range;

/// A finding at the text of a program that threw. `done` describes the interaction: `as it stands`.
pub fn error_finding(t: &ProgramError, done: &str) -> Finding {
    Finding::error(
        t.rule,
        t.text.span_of(t.span.clone()),
        format!("{} ({done}, at t = {} s)", t.message, t.time),
    )
    .why("on the page, an error in `setup` or `controller` freezes the lab, and one in a trace shows nan")
    .help("correct the statement, or guard it with a condition")
}

/// A finding at `place` about a breakdown: a warning of the engine or a silent fault, with time, joint or geoms and likely
/// cause. `done` describes the interaction.
pub fn describe_breakdown(b: &Breakdown, done: &str, place: Range<usize>) -> Finding {
    let what = match b.rule.code {
        "engine-warning" => format!("the engine warns {done}: {}", b.what),
        "simulation-diverges" | "energy-grows" => format!("the simulation breaks {done}: {}", b.what),
        _ => format!("the simulation goes wrong {done}: {}", b.what),
    };
    Finding::plain(b.rule, place, what).why(b.why).help(b.help())
}
