//! Numbers that are not claimed, in a lesson that claims nearly all of them: forgotten, or changed after they were claimed.

use crate::finding::Finding;
use crate::rules::NUMBERS_UNCLAIMED;
use crate::spec::Lesson;
use crate::verify::{Stated, claimed, stated};

/// With fewer claims nobody can say that the author means to claim everything.
const LEAST: usize = 10;
/// Of so many numbers one may be left out.
const SHARE: usize = 10;

/// Tells each number on its own; nothing where many are left out, as one finding says so for all of them.
pub(super) fn check(lesson: &Lesson, findings: &mut Vec<Finding>) {
    if lesson.findings.iter().any(|f| f.code == NUMBERS_UNCLAIMED.code) {
        return;
    }
    let places = claimed(lesson);
    if places.len() < LEAST {
        return;
    }
    let is_claimed = |s: &Stated| places.iter().any(|at| at.start < s.span.end && s.span.start < at.end);
    // A bound cannot be quoted, and the answer of a question has its `value`.
    let numbers: Vec<Stated> = stated(lesson).into_iter().filter(|s| !s.answer && !s.bound).collect();
    let left: Vec<&Stated> = numbers.iter().filter(|s| !is_claimed(s)).collect();
    if left.len() * SHARE > numbers.len() {
        return;
    }
    for s in left {
        let others = numbers.len() - 1;
        let message =
            format!("{} is claimed nowhere, as nearly all of the other {others} numbers are", s.quote);
        findings.push(
            Finding::new(NUMBERS_UNCLAIMED, s.span.clone(), message)
                .help("quote it under `says`, or write what was claimed here before"),
        );
    }
}
