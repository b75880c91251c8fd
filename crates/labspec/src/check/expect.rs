//! What an author expects of the runs of a lab: that they go well, or, with `"expect": "breaks"`, that one breaks.

use crate::finding::Finding;
use crate::rules;
use crate::spec::{Expect, Lab};

/// What a run that breaks is reported as.
const BROKE: [&str; 8] = [
    rules::SIMULATION_DIVERGES.code,
    rules::ENERGY_GROWS.code,
    rules::DAMPER_PUSHES.code,
    rules::PAST_LIMIT.code,
    rules::PASSES_THROUGH.code,
    rules::SINKS_IN.code,
    rules::SOLVER_STOPS_EARLY.code,
    rules::RUNS_AWAY.code,
];
/// What is only said of a scene, or of settings with a fault though nothing breaks: beside what breaks, it is no news.
const LIKELY: [&str; 5] = [
    rules::STIFF_FOR_TIMESTEP.code,
    rules::NEAR_ITS_LIMIT.code,
    rules::PRESSED_DEEP.code,
    rules::CHATTERS.code,
    rules::CREEPS.code,
];

/// Holds the findings of the runs of one lab, those from `first` on, against what its author expects. `runs` is how
/// many were made.
pub(super) fn settle(lab: &Lab, runs: usize, findings: &mut Vec<Finding>, first: usize) {
    let Some(Expect::Breaks(place)) = &lab.expect else { return };
    let of_lab = findings.split_off(first.min(findings.len()));
    let broke = of_lab.iter().any(|f| BROKE.contains(&f.code));
    let impossible = of_lab.iter().any(|f| f.code == rules::RUN_IMPOSSIBLE.code);
    findings.extend(of_lab.into_iter().filter(|f| !BROKE.contains(&f.code) && !LIKELY.contains(&f.code)));
    // What was not run shows nothing, and is said elsewhere.
    if broke || impossible || runs == 0 {
        return;
    }
    findings.push(
        Finding::error(
            rules::DOES_NOT_BREAK,
            place.clone(),
            "this lab is expected to break, but it does not",
        )
        .why(format!(
            "{}: a student does not see the break that the text describes",
            if runs == 1 {
                "one run was made, and every number stayed finite".into()
            } else {
                format!(
                    "{runs} runs were made, with every control at its ends, and every number stayed finite"
                )
            }
        ))
        .help("make it break (a larger timestep, a stiffer spring, a longer run), or delete `expect`"),
    );
}
