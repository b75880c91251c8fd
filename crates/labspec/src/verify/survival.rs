//! Checks an answer under perturbed numerics that the question does not mention: it must hold under all of them.

use super::bound::BoundVerify;
use super::numerics::CLOSE_VARIANTS;
use super::outcome::MeasuredRuns;
use super::outcomes::Outcomes;
use super::verdict::{Verdict, Weight};
use crate::finding::Finding;
use crate::ledger::Evidence;
use crate::rules;
use std::ops::Range;

/// A finding if the answer changes in an outcome under perturbed numerics with the given name. The spread of the weights is
/// widened by the margins.
pub(super) type ChangedAnswer<'t> = dyn FnMut(&MeasuredRuns, &str, &mut [Weight]) -> Option<Finding> + 't;

/// Checks an answer under the perturbed numerics, and under the closer ones where a margin is small. `turns` returns the
/// change in an outcome, and widens the spread of the weights.
///
/// # Errors
/// The answer does not hold under one of them, or could not be tested: the verdict, and the reason.
pub(super) fn withstand_numerics(
    bound: &BoundVerify<'_>,
    outcomes: &Outcomes,
    weights: &mut [Weight],
    place: Range<usize>,
    findings: &mut Vec<Finding>,
    turns: &mut ChangedAnswer<'_>,
) -> Result<(), (Verdict, String)> {
    let mut withstand = |outcome: Option<&MeasuredRuns>, how: &str, weights: &mut [Weight]| {
        let turned = outcome.map(|outcome| turns(outcome, how, weights));
        match turned {
            Some(None) => Ok(()),
            // A run that ended because the work budget ran out, or that cannot be executed, does not test the answer.
            Some(Some(finding)) if bound.stage().left() > 0 => {
                findings.push(finding);
                Err((Verdict::Fragile, format!("it does not hold {how}")))
            }
            _ => {
                findings.push(out_of_work(place.clone(), how));
                Err((Verdict::Failed, format!("the work budget ran out before testing it {how}")))
            }
        }
    };
    for (outcome, perturbation) in outcomes.under_perturbations() {
        withstand(Some(outcome), perturbation.how, weights)?;
    }
    for (numerics, how) in CLOSE_VARIANTS {
        if weights.iter().any(Weight::is_close) {
            withstand(bound.outcome(numerics, &mut Vec::new()).as_ref(), how, weights)?;
        }
    }
    Ok(())
}

pub(super) fn verdict_by(evidence: Option<Evidence>) -> Verdict {
    if evidence == Some(Evidence::Simulated) { Verdict::Verified } else { Verdict::Computed }
}

/// The finding about a work budget that ran out before an answer was tested under all numerics.
pub(super) fn out_of_work(span: Range<usize>, how: &str) -> Finding {
    let what = format!("the work budget ran out before testing whether the answer holds {how}");
    Finding::error(rules::RUN_BREAKS, span, what)
        .why("without this test, the answer may hold only for the timestep and the solver of the lesson")
        .help("make the runs shorter, or use fewer of them in one lesson")
}

pub(super) fn fragile_answer(span: Range<usize>, how: &str, what: &str) -> Finding {
    Finding::warning(rules::ANSWER_FRAGILE, span, format!("the answer holds, but not {how}: {what}"))
        .why("it depends on numerics that the question does not mention: a student with other settings sees something else")
        .help("state the setting in the question and `set` it in the run, or ask about something that does not depend on it")
}
