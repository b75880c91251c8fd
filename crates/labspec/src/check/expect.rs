//! The expectation of the author for the runs of a lab: that none breaks, or with `"expect": "breaks"` that one breaks.

use crate::finding::Finding;
use crate::rules;
use crate::spec::{Expect, Lab};

/// Rules of findings about a run that breaks.
const BREAK_RULES: [&str; 8] = [
    rules::SIMULATION_DIVERGES.code,
    rules::ENERGY_GROWS.code,
    rules::DAMPER_PUSHES.code,
    rules::PAST_LIMIT.code,
    rules::PASSES_THROUGH.code,
    rules::SINKS_IN.code,
    rules::SOLVER_STOPS_EARLY.code,
    rules::RUNS_AWAY.code,
];
/// Rules of findings that predict a break, or report a fault without a break. They are redundant if a run breaks.
const PREDICTION_RULES: [&str; 5] = [
    rules::STIFF_FOR_TIMESTEP.code,
    rules::NEAR_ITS_LIMIT.code,
    rules::PRESSED_DEEP.code,
    rules::CHATTERS.code,
    rules::CREEPS.code,
];

/// Compares the findings in the runs of one lab, those from index `first` on, with the expectation of its author. `runs` is
/// the number of runs.
pub(super) fn settle(lab: &Lab, runs: usize, findings: &mut Vec<Finding>, first: usize) {
    let Some(expect) = &lab.expect else { return };
    let of_lab = findings.split_off(first.min(findings.len()));
    let broke = of_lab.iter().any(|f| BREAK_RULES.contains(&f.code));
    let impossible = of_lab.iter().any(|f| f.code == rules::RUN_IMPOSSIBLE.code);
    findings.extend(
        of_lab.into_iter().filter(|f| !BREAK_RULES.contains(&f.code) && !PREDICTION_RULES.contains(&f.code)),
    );
    // Without runs there is no evidence, and another finding reports that.
    let Expect::Breaks(place) = expect else { return };
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
