//! Checks the answer of a question: one condition per option, or a numeric value, under the numerics of the lesson and
//! under perturbed numerics.

use super::bound::BoundVerify;
use super::numeric_answer::check_number;
use super::options::check_options;
use super::outcome::MeasuredRuns;
use super::outcomes::Outcomes;
use super::over;
use super::verdict::{Answer, Verdict};
use crate::finding::Finding;
use crate::source::Text;
use crate::spec::{Question, Verify};

/// Checks the answer of a question; `None` when the `verify` object has no condition or value for it.
pub(super) fn check_answer(
    bound: &BoundVerify<'_>,
    outcomes: &Outcomes,
    verify: &Verify,
    question: &Question,
    findings: &mut Vec<Finding>,
) -> Option<Answer> {
    let by_options = (!verify.options.is_empty()).then(|| {
        let mut answer = check_options(bound, outcomes, verify, question, findings);
        if let Some(keyed) = question.key()
            && is_right(&answer)
            && !verify.over.is_empty()
        {
            over::hold_over_range(bound, verify, keyed.span.clone(), &mut answer, findings);
        }
        add_searches(bound, &verify.options, &outcomes.nominal, &mut answer);
        answer
    });
    let by_value = verify.value.as_ref().map(|text| {
        let mut answer = check_number(bound, outcomes, text, &verify.wrong, question, findings);
        add_searches(bound, std::slice::from_ref(text), &outcomes.nominal, &mut answer);
        answer
    });
    // An object has both only by mistake, which is reported. The worse verdict counts.
    by_options.into_iter().chain(by_value).max_by_key(|a| a.verdict)
}

fn is_right(answer: &Answer) -> bool {
    matches!(answer.verdict, Verdict::Verified | Verdict::Computed)
}

/// Adds to the reason where the values that these texts read were searched for.
fn add_searches(bound: &BoundVerify<'_>, texts: &[Text], outcome: &MeasuredRuns, answer: &mut Answer) {
    if !is_right(answer) {
        return;
    }
    for (i, looked) in outcome.looked.iter().enumerate() {
        if texts.iter().any(|text| bound.reads_found(text, i)) {
            let before = std::mem::take(&mut answer.reason);
            answer.reason = if before.is_empty() { looked.clone() } else { format!("{before}; {looked}") };
        }
    }
}
