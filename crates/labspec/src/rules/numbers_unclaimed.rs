//! Numbers without a claim: most of them in a lesson without a review, or a few in a lesson that claims the others.

use crate::spec::Lesson;
use crate::verify::{Stated, counted};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// The lesson states numbers with units that no `verify` quotes.
pub const NUMBERS_UNCLAIMED: &Rule = &Rule {
    code: "numbers-unclaimed",
    severity: Severity::Note,
    layer: Layer::Claim,
    summary: "the lesson states numbers with units that no `verify` quotes",
    why: "every check recomputes a quoted number; a number that is not quoted may become wrong when the model changes",
    bad: Example::Lesson(
        "It touches the floor after ⟦0.442 s⟧, at 4.43 m/s, and falls 1 m.\n\n```lab simlab\n{\"model\": \"ball\", \"readouts\": [{\"label\": \"height (m)\", \"expr\": \"data.qpos[2]\"}]}\n```\n",
    ),
    good: Example::Lesson(
        "It touches the floor soon.\n\n```lab simlab\n{\"model\": \"ball\", \"readouts\": [{\"label\": \"height (m)\", \"expr\": \"data.qpos[2]\"}]}\n```\n",
    ),
};

/// With fewer claims, the lesson does not show the intention to claim every number.
const MIN_CLAIMS: usize = 10;
/// One of this many numbers may be without a claim.
const SHARE: usize = 10;
/// Fewer numbers are not reported: one or two are the data of the task.
const FEWEST: usize = 3;
/// The maximum length of a lesson that is searched, bytes.
const MAX_LESSON: usize = 2 << 20;

/// Reports each number separately if nearly all are claimed. Otherwise reports the first one of the text, with the count.
pub(crate) fn check_unclaimed_numbers(lesson: &Lesson, findings: &mut Vec<Finding>) {
    // If nothing can be claimed, nothing is missing. Very long lessons are not searched.
    let nothing = lesson.labs.is_empty() && lesson.verifies().next().is_none();
    if nothing || lesson.file.text().len() > MAX_LESSON {
        return;
    }
    let counted = counted(lesson);
    // The answer of a question has its `value` instead.
    let numbers = |list: Vec<Stated>| list.into_iter().filter(|s| !s.answer).collect::<Vec<_>>();
    let [claimed, left] = [counted.claimed, counted.left].map(numbers);
    let all = claimed.len() + left.len();
    if claimed.len() >= MIN_CLAIMS && left.len() * SHARE <= all {
        for s in left {
            let others = all - 1;
            let message = format!(
                "no `verify` quotes {}, although nearly all of the other {others} numbers are quoted",
                s.quote
            );
            findings.push(
                Finding::new(NUMBERS_UNCLAIMED, s.span.clone(), message)
                    .help("quote it under `says`, or restore the earlier claim"),
            );
        }
        return;
    }
    // All options of a question but one are wrong, so no claim can be about them.
    let in_text = |list: Vec<Stated>| list.into_iter().filter(|s| is_text(lesson, s)).collect::<Vec<_>>();
    let [claimed, left] = [claimed, left].map(in_text);
    if let Some(first) = left.first().filter(|_| left.len() >= FEWEST && !lesson.labs.is_empty()) {
        let (some, all) = (claimed.len(), claimed.len() + left.len());
        let message = format!(
            "the text has {all} numbers with units and `verify` quotes {some} of them; this is the first one that it does not quote"
        );
        findings.push(
            Finding::new(NUMBERS_UNCLAIMED, first.span.clone(), message)
                .help("quote numbers that come from a run under `says` of a `verify`; `labspec trace` finds their origin"),
        );
    }
}

/// Whether a number is outside all labs and quizzes.
fn is_text(lesson: &Lesson, s: &Stated) -> bool {
    let blocks = lesson.labs.iter().map(|lab| &lab.span).chain(lesson.quizzes.iter().map(|quiz| &quiz.span));
    !blocks.into_iter().any(|block| block.start <= s.span.start && s.span.end <= block.end)
}
