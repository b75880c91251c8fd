//! Findings that an author has suppressed: they are removed, counted, and listed on request.

use super::CheckLevel;
use crate::finding::Finding;
use crate::lint::MAX_FINDINGS;
use crate::rules;
use crate::spec::{Allowance, Lesson};
use std::ops::Range;

/// A suppressed finding with its reason.
#[derive(Clone, Debug, PartialEq)]
pub struct SuppressedFinding {
    /// The finding.
    pub finding: Finding,
    /// The author's reason.
    pub why: String,
}

/// Removes suppressed findings, and adds findings about the suppressions themselves.
pub(super) fn suppress_allowed(
    lesson: &Lesson,
    findings: &mut Vec<Finding>,
    level: CheckLevel,
) -> Vec<SuppressedFinding> {
    let allowances = lesson.allowances();
    if allowances.is_empty() {
        return Vec::new();
    }
    let mut suppressed = Vec::new();
    let mut used = Vec::new();
    let mut errors = Vec::new();
    let named_by = |f: &Finding, allowance: &Allowance| {
        let inside = allowance.over.start <= f.span.start && f.span.start <= allowance.over.end;
        inside.then(|| allowance.codes.iter().find(|(code, _)| code == f.code)).flatten().cloned()
    };
    findings.retain(|f| {
        let by = allowances.iter().filter(|a| !a.why.is_empty()).find_map(|a| Some((a, named_by(f, a)?)));
        let Some((allowance, code)) = by else { return true };
        if f.is_error() {
            errors.push(code.clone());
        } else {
            suppressed.push(SuppressedFinding { finding: f.clone(), why: allowance.why.clone() });
        }
        used.push(code);
        f.is_error()
    });
    errors.dedup();
    findings.extend(errors.into_iter().map(|(code, span)| rules::error_allowed::refuse(&code, span)));
    findings.extend(check_allowances(lesson, &allowances, &used, level));
    suppressed
}

/// A rule code in a suppression, with its span.
type SuppressedCode = (String, Range<usize>);

/// The findings about the suppressions: no reason, an unknown rule, nothing to suppress. `used` contains the codes that
/// suppress a finding.
fn check_allowances(
    lesson: &Lesson,
    allowances: &[Allowance],
    used: &[SuppressedCode],
    level: CheckLevel,
) -> Vec<Finding> {
    let mut wrong = Vec::new();
    for allowance in allowances {
        if wrong.len() > MAX_FINDINGS {
            break;
        }
        if let Some(finding) = rules::allowance_without_reason::check_reason(allowance) {
            wrong.push(finding);
            continue;
        }
        let unused = allowance.codes.iter().filter(|code| !used.contains(code));
        wrong.extend(unused.filter_map(|(code, span)| match rules::find(code) {
            None => Some(rules::unknown_rule::name_nearest(code, span.clone(), rules::all())),
            Some(rule) => rules::unused_allowance::check_use(rule, span.clone(), level),
        }));
    }
    if wrong.len() > MAX_FINDINGS {
        wrong.truncate(MAX_FINDINGS);
        let end = lesson.file.text().len();
        let message = "more mistakes in suppressions are not listed";
        wrong.push(
            Finding::new(rules::LESSON_LIMIT, end..end, message).help("fix the first ones, then check again"),
        );
    }
    wrong
}
