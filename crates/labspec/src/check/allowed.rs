//! Findings that an author has looked at and keeps: they are suppressed, counted, and shown on request.

use super::CheckLevel;
use crate::finding::Finding;
use crate::lint::MAX_FINDINGS;
use crate::rules;
use crate::spec::{Allowance, Lesson};
use labspec_finding::{Layer, nearest};
use std::ops::Range;

/// A finding that is suppressed, and why.
#[derive(Clone, Debug, PartialEq)]
pub struct Allowed {
    /// What would be reported.
    pub finding: Finding,
    /// The author's reason.
    pub why: String,
}

/// Takes what is allowed out of the findings, and adds what is wrong with the allowances themselves.
pub(super) fn suppress_allowed(
    lesson: &Lesson,
    findings: &mut Vec<Finding>,
    depth: CheckLevel,
) -> Vec<Allowed> {
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
            suppressed.push(Allowed { finding: f.clone(), why: allowance.why.clone() });
        }
        used.push(code);
        f.is_error()
    });
    errors.dedup();
    findings.extend(errors.into_iter().map(|(code, span)| {
        Finding::new(rules::ERROR_ALLOWED, span, format!("`{code}` is an error and cannot be suppressed"))
            .help("fix the error, then delete this code")
    }));
    findings.extend(check_allowances(lesson, &allowances, &used, depth));
    suppressed
}

/// A code of an allowance, and where it stands.
type AllowedCode = (String, Range<usize>);

/// What is wrong with the allowances: no reason, an unknown rule, nothing to suppress. `used` are the codes that suppress something.
fn check_allowances(
    lesson: &Lesson,
    allowances: &[Allowance],
    used: &[AllowedCode],
    depth: CheckLevel,
) -> Vec<Finding> {
    let mut wrong = Vec::new();
    for allowance in allowances {
        if wrong.len() > MAX_FINDINGS {
            break;
        }
        if allowance.why.is_empty() {
            let message = "this suppression gives no reason";
            wrong.push(
                Finding::new(rules::ALLOWANCE_WITHOUT_REASON, allowance.span.clone(), message)
                    .help("write the reason after the codes, as \"why\" or after a colon"),
            );
            continue;
        }
        let unused = allowance.codes.iter().filter(|code| !used.contains(code));
        wrong.extend(unused.filter_map(|code| check_unused_code(code, depth)));
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

/// What is wrong with a code that suppresses nothing; `None` where a check to this depth cannot tell.
fn check_unused_code((code, span): &AllowedCode, depth: CheckLevel) -> Option<Finding> {
    let Some(rule) = rules::find(code) else {
        let message = format!("`allow` names the unknown rule `{code}`");
        let near = nearest(code, rules::all().map(|r| r.code));
        let found = Finding::new(rules::UNKNOWN_RULE, span.clone(), message);
        return Some(match near {
            Some(near) => found.help(format!("did you mean `{near}`?")),
            None => found.help("run `labspec explain` for a list of all rules"),
        });
    };
    can_find(rule.layer, depth).then(|| {
        Finding::new(rules::UNUSED_ALLOWANCE, span.clone(), format!("`{code}` matches no finding here"))
            .help("delete it")
    })
}

/// Whether a check to this depth can find what a rule of this layer says.
fn can_find(layer: Layer, depth: CheckLevel) -> bool {
    match layer {
        Layer::Run => depth.labs,
        Layer::Claim => depth.claims,
        Layer::Program => depth.programs,
        _ => true,
    }
}
