//! Findings that are consequences of another one: with its fix, they end too. They are not findings of their own, because an
//! author who follows their advice would make the lesson wrong in two places.
//!
//! The fix is applied to the text, and the lesson is checked again. The ledger keeps the verdicts of the text as it stands.

use super::{Claim, LabOutcome};
use crate::bind::scene::Models;
use crate::finding::{Finding, Fix};
use crate::lint::reload_lesson;
use crate::rules::{self, Layer};
use crate::spec::Lesson;

/// Maximum number of fixes that are tried. Each needs a check of the whole lesson.
const MAX_CAUSES: usize = 4;

/// Rules that a run decides, but that are about what a program writes: their findings are causes.
const PROGRAM_RULES: [&rules::Rule; 5] =
    [rules::MISSING_SETCONST, rules::MASS_ALONE, rules::INERTIA_ALONE, rules::SHAPE_ALONE, rules::GAIN_ALONE];

/// Removes the consequences of fixable findings; the remaining finding names them. `check` checks a lesson as it stands.
pub(super) fn remove_consequences(
    lesson: &Lesson,
    models: &Models,
    outcome: &mut LabOutcome,
    check: impl Fn(&Lesson) -> LabOutcome,
) {
    let candidates = outcome.findings.iter().chain(&lesson.findings);
    let causes: Vec<Finding> = candidates.filter(|f| is_cause(lesson, f)).take(MAX_CAUSES).cloned().collect();
    for cause in causes {
        let Some(fix) = cause.fix.as_ref().filter(|_| outcome.findings.iter().any(is_consequence)) else {
            continue;
        };
        let Some(text) = repaired(lesson.file.text(), fix) else { continue };
        let corrected = reload_lesson(lesson, &text, models.folder());
        let after = check(&corrected);
        let fixed = FixedLesson { fix, lesson: &corrected, outcome: &after };
        let gone = fixed.consequences(lesson, &cause, &outcome.findings);
        outcome.findings.retain(|f| !gone.contains(f));
        if let Some(cause) = outcome.findings.iter_mut().find(|f| **f == cause) {
            for consequence in gone {
                let label = format!("a consequence: {}", consequence.message);
                *cause = cause.clone().related(consequence.span, label);
            }
        }
    }
}

/// Whether the fix of a finding may end others: it corrects the lab or the question, not the claim itself.
fn is_cause(lesson: &Lesson, finding: &Finding) -> bool {
    let suppressed =
        || lesson.allowances().iter().any(|a| a.codes.iter().any(|(code, _)| code == finding.code));
    let in_broken = |fix: &Fix| lesson.is_broken(&fix.span);
    finding.claim.is_none()
        && !is_consequence(finding)
        && finding.fix.as_ref().is_some_and(|fix| !in_broken(fix))
        && !suppressed()
}

/// Whether a finding can be the consequence of another one: a run or a claim shows it.
fn is_consequence(finding: &Finding) -> bool {
    rules::find(finding.code).is_some_and(|rule| match rule.layer {
        Layer::Claim => true,
        Layer::Run => finding.fix.is_none() && !PROGRAM_RULES.iter().any(|of| of.code == rule.code),
        _ => false,
    })
}

fn repaired(text: &str, fix: &Fix) -> Option<String> {
    let (before, after) = (text.get(..fix.span.start)?, text.get(fix.span.end..)?);
    Some(format!("{before}{}{after}", fix.text))
}

/// A lesson with one fix, and its check.
struct FixedLesson<'f> {
    fix: &'f Fix,
    lesson: &'f Lesson,
    outcome: &'f LabOutcome,
}

impl FixedLesson<'_> {
    /// The consequences that end with the fix. None if the cause remains, or if the fix causes another finding.
    fn consequences(&self, lesson: &Lesson, cause: &Finding, before: &[Finding]) -> Vec<Finding> {
        let existed = |after: &Finding| before.iter().chain(&lesson.findings).any(|f| self.is_same(f, after));
        if self.remains(cause) || !self.all().all(existed) {
            return Vec::new();
        }
        before.iter().filter(|f| is_consequence(f) && self.has_ended(f)).cloned().collect()
    }

    fn all(&self) -> impl Iterator<Item = &Finding> {
        self.lesson.findings.iter().chain(&self.outcome.findings)
    }

    /// Whether a finding has ended. A claim must now be true: one that can no longer be checked is not corrected.
    fn has_ended(&self, finding: &Finding) -> bool {
        let about = |claim: &&Claim| finding.claim.as_ref().is_some_and(|id| id.owner == claim.name);
        let doubtful = self.outcome.claims.iter().find(about).is_some_and(Claim::is_doubtful);
        !doubtful && !self.remains(finding)
    }

    fn remains(&self, finding: &Finding) -> bool {
        self.all().any(|after| self.is_same(finding, after))
    }

    /// Whether a finding after the fix is the same as one before.
    fn is_same(&self, before: &Finding, after: &Finding) -> bool {
        before.code == after.code && self.moved(before.span.start) == after.span.start
    }

    /// A position of the old text in the new one.
    fn moved(&self, offset: usize) -> usize {
        let Fix { span, text, .. } = self.fix;
        if offset >= span.end && offset > span.start { offset - span.len() + text.len() } else { offset }
    }
}
