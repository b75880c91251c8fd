//! An answer under numerics that the question does not mention: it must hold with all of them.

use super::bound::BoundVerify;
use super::numerics::{CLOSER, PERTURBED};
use super::outcome::Outcome;
use super::outcomes::Outcomes;
use super::verdict::{Verdict, Weight};
use crate::finding::Finding;
use crate::ledger::Evidence;
use crate::rules;
use std::ops::Range;

/// The outcomes under other numerics, with their names.
fn perturbed_outcomes(outcomes: &Outcomes) -> impl Iterator<Item = (&Outcome, &'static str)> {
    outcomes.perturbed.iter().zip(PERTURBED).filter_map(|(o, (_, how))| Some((o.as_ref()?, how)))
}

/// What turns over in an outcome under other numerics, so called; the margins are widened by it.
pub(super) type Turns<'t> = dyn FnMut(&Outcome, &str, &mut [Weight]) -> Option<Finding> + 't;

/// Puts an answer to the other numerics, and to those that are closer where these come near. `turns` says what turns over in an
/// outcome, and widens the margins by it.
///
/// # Errors
/// It does not hold in one of them, or could not be tried: the verdict, and why.
pub(super) fn withstand_numerics(
    bound: &BoundVerify<'_>,
    outcomes: &Outcomes,
    weights: &mut [Weight],
    place: Range<usize>,
    findings: &mut Vec<Finding>,
    turns: &mut Turns<'_>,
) -> Result<(), (Verdict, String)> {
    let mut withstand = |outcome: Option<&Outcome>, how: &str, weights: &mut [Weight]| {
        let turned = outcome.map(|outcome| turns(outcome, how, weights));
        match turned {
            Some(None) => Ok(()),
            // What ends because the work of a check is spent, or cannot be run at all, says nothing of the answer.
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
    for (outcome, how) in perturbed_outcomes(outcomes) {
        withstand(Some(outcome), how, weights)?;
    }
    for (numerics, how) in CLOSER {
        if weights.iter().any(Weight::is_close) {
            withstand(bound.outcome(numerics, &mut Vec::new()).as_ref(), how, weights)?;
        }
    }
    Ok(())
}

pub(super) fn verdict_by(evidence: Option<Evidence>) -> Verdict {
    if evidence == Some(Evidence::Simulated) { Verdict::Verified } else { Verdict::Computed }
}

/// The work of a check was spent before an answer was put to all numerics.
pub(super) fn out_of_work(span: Range<usize>, how: &str) -> Finding {
    let what = format!("the work budget ran out before testing whether the answer holds {how}");
    Finding::error(rules::RUN_BREAKS, span, what)
        .why("an answer that holds only under one choice of numerics is not an answer")
        .help("make the runs shorter, or use fewer of them in one lesson")
}

pub(super) fn fragile_answer(span: Range<usize>, how: &str, what: &str) -> Finding {
    Finding::warning(rules::ANSWER_FRAGILE, span, format!("the answer holds, but not {how}: {what}"))
        .why("it depends on numerics that the question does not mention: a student with other settings sees something else")
        .help("state the setting in the question and `set` it in the run, or ask about something that does not depend on it")
}
