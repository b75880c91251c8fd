//! Numbers without a claim: most of them in a lesson without a review, or a few in a lesson that claims the others.

use super::explanation_unclaimed::check_explanations;
use crate::json::encode;
use crate::spec::Lesson;
use crate::verify::{Counted, Stated, counted, quoted};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};
use std::collections::HashSet;
use std::ops::Range;

/// The lesson states numbers with units that no `verify` quotes and no output of a listing has.
pub const NUMBERS_UNCLAIMED: &Rule = &Rule {
    code: "numbers-unclaimed",
    severity: Severity::Note,
    exceptions: &[],
    layer: Layer::Claim,
    summary: "the lesson states numbers with units that no `verify` quotes and no listing prints",
    why: "every check recomputes a quoted number, and `labspec check --listings` the outputs of listings, whose numbers count as claimed (`printedNumber` in reports); any other number may become wrong when the model changes",
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

/// Reports the numbers of the explanations of verified questions, whose `verify` objects have these spans. Reports each number
/// separately if nearly all are claimed. Otherwise reports the first one of the text, with the count.
pub(crate) fn check_unclaimed_numbers(
    lesson: &Lesson,
    verified: &[Range<usize>],
    findings: &mut Vec<Finding>,
) {
    // If nothing can be claimed, nothing is missing. Very long lessons are not searched.
    if has_no_claims(lesson) || lesson.file.text().len() > MAX_LESSON {
        return;
    }
    let counted = counted(lesson);
    let reported = report_related(lesson, &counted, verified, findings);
    report_left(lesson, counted, &reported, &HashSet::new(), findings);
}

/// Reports the numbers of the text again. Those of the displayed outputs of listings are not counted, and the others that such
/// outputs have (`printed`) count as claimed.
pub(crate) fn report_again(
    lesson: &Lesson,
    verified: &[Range<usize>],
    [displayed, printed]: [&HashSet<Range<usize>>; 2],
    findings: &mut Vec<Finding>,
) {
    let is_unclaimed = |f: &Finding| f.code == NUMBERS_UNCLAIMED.code;
    // What was removed as a consequence of another finding is not reported again.
    if !findings.iter().any(is_unclaimed) && !has_no_claims(lesson) || lesson.file.text().len() > MAX_LESSON {
        return;
    }
    findings.retain(|f| !is_unclaimed(f));
    let mut counted = counted(lesson);
    counted.left.retain(|s| !displayed.contains(&s.span));
    // These findings exist already.
    let mut existing = findings.clone();
    existing.retain(|f| f.code != super::EXPLANATION_UNCLAIMED.code);
    let reported = report_related(lesson, &counted, verified, &mut existing);
    report_left(lesson, counted, &reported, printed, findings);
}

/// Whether the lesson has neither labs nor `verify` objects.
fn has_no_claims(lesson: &Lesson) -> bool {
    lesson.labs.is_empty() && lesson.verifies().next().is_none()
}

/// Adds suggestions to findings about quotes, and reports the numbers of explanations. Returns the numbers of both.
fn report_related(
    lesson: &Lesson,
    counted: &Counted,
    verified: &[Range<usize>],
    findings: &mut Vec<Finding>,
) -> Vec<Stated> {
    let mut reported = suggest_quotes(lesson, counted, findings);
    let unquoted = Counted {
        left: counted.left.iter().filter(|s| !is_among(s, &reported)).cloned().collect(),
        ..counted.clone()
    };
    reported.extend(check_explanations(lesson, &unquoted, verified, findings));
    reported
}

/// Reports the numbers that neither a claim nor an output has, without those in `reported`.
fn report_left(
    lesson: &Lesson,
    counted: Counted,
    reported: &[Stated],
    printed: &HashSet<Range<usize>>,
    findings: &mut Vec<Finding>,
) {
    let count = counted.count();
    let Counted { claimed, mut left, others } = counted;
    left.retain(|s| !is_among(s, reported) && !printed.contains(&s.span));
    // A lesson that claims nearly every number claims those of options, too.
    let options: Vec<Stated> = others.into_iter().filter(|s| !s.answer && !s.bound).collect();
    let all = count + options.len();
    if claimed.len() + printed.len() >= MIN_CLAIMS && (left.len() + options.len()) * SHARE <= all {
        left.extend(options);
        left.sort_by_key(|s| s.span.start);
        findings.extend(left.iter().map(|s| exception(s, all - 1, printed)));
        return;
    }
    // A claim that does not find its text may be about these numbers.
    if findings.iter().any(|f| f.code == super::QUOTE_NOT_FOUND.code) {
        return;
    }
    // Numbers of labs and questions are data of the task more often than results.
    let in_text: Vec<&Stated> = left.iter().filter(|s| is_text(lesson, s)).collect();
    if let Some(first) = in_text.first().filter(|_| in_text.len() >= FEWEST && !lesson.labs.is_empty()) {
        let (some, all) = (claimed.len(), count);
        let message = match printed.len() {
            0 => format!(
                "the lesson has {all} numbers with units and `verify` quotes {some} of them; this is the first one that it does not quote"
            ),
            n => format!(
                "the lesson has {all} numbers with units; `verify` quotes {some} of them, and outputs of listings have {n}; this is the first of the others"
            ),
        };
        findings.push(
            Finding::new(NUMBERS_UNCLAIMED, first.span.clone(), message)
                .help("quote numbers that come from a run under `says` of a `verify`; `labspec trace` finds their origin"),
        );
    }
}

/// The finding about a number without a claim among many with one.
fn exception(s: &Stated, others: usize, printed: &HashSet<Range<usize>>) -> Finding {
    let quote = &s.quote;
    let (message, help) = match printed.is_empty() {
        true => (
            format!(
                "no `verify` quotes {quote}, although nearly all of the other {others} numbers are quoted"
            ),
            "quote it under `says`, or restore the earlier claim",
        ),
        false => (
            format!(
                "no `verify` quotes {quote} and no output of a listing has it, unlike nearly all of the other {others} numbers"
            ),
            "correct it to the printed number, or quote it under `says`",
        ),
    };
    Finding::new(NUMBERS_UNCLAIMED, s.span.clone(), message).help(help)
}

fn is_among(s: &Stated, list: &[Stated]) -> bool {
    list.iter().any(|other| other.span == s.span)
}

/// The relative difference up to which a number is that of a quote with fewer digits.
const NEARLY_EQUAL: f64 = 0.02;

/// Adds the number of the text that a quote probably means to the finding about a quote that does not appear: the same number
/// with another spelling of its unit, or with other digits. Returns these numbers; they are not reported again.
fn suggest_quotes(lesson: &Lesson, counted: &Counted, findings: &mut [Finding]) -> Vec<Stated> {
    let mut suggested: Vec<Stated> = Vec::new();
    for finding in findings.iter_mut().filter(|f| f.code == super::QUOTE_NOT_FOUND.code) {
        let text = lesson.file.text().get(finding.span.clone()).unwrap_or("");
        let Ok(read) = quoted(text) else { continue };
        let comment = lesson.claim_comments.iter().find(|comment| contains(&comment.span, &finding.span));
        let difference = |s: &Stated| (s.read.value - read.value).abs();
        let is_meant = |s: &&Stated| {
            difference(s) <= NEARLY_EQUAL * read.value.abs()
                && comment.is_none_or(|comment| contains(&comment.over, &s.span))
        };
        let mut meant: Vec<&Stated> = counted.left.iter().filter(is_meant).collect();
        meant.sort_by(|a, b| difference(a).total_cmp(&difference(b)));
        let Some(meant) = meant.first().filter(|s| !is_among(s, &suggested)) else { continue };
        *finding = finding
            .clone()
            .help(format!("quote what the text says: write `{}`", meant.quote))
            .guess(finding.span.clone(), encode(&meant.quote))
            .related(meant.span.clone(), "the text says it here");
        suggested.push((*meant).clone());
    }
    suggested
}

fn contains(outer: &Range<usize>, inner: &Range<usize>) -> bool {
    outer.start <= inner.start && inner.end <= outer.end
}

/// Whether a number is outside all labs and quizzes.
fn is_text(lesson: &Lesson, s: &Stated) -> bool {
    let blocks = lesson.labs.iter().map(|lab| &lab.span).chain(lesson.quizzes.iter().map(|quiz| &quiz.span));
    !blocks.into_iter().any(|block| block.start <= s.span.start && s.span.end <= block.end)
}
