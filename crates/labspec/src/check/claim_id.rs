//! The identity of a claim, stored in each of its findings. It links a finding to its entry in the ledger, and a baseline
//! identifies findings by it.

use crate::finding::{ClaimId, Finding};
use crate::json::read::Number;
use crate::ledger::{Entry, Subject};
use crate::source::Text;
use crate::spec::{AnswerKey, Question, QuestionKind, Verify};
use crate::verify::Judgement;
use std::fmt::Write;
use std::ops::Range;

/// The name of a ledger entry among the claims of its owner.
fn part(subject: Subject, what: &str) -> String {
    match subject {
        // An undecided option is part of the answer.
        Subject::Answer | Subject::Option => Subject::Answer.as_str().to_string(),
        subject => format!("{} {what}", subject.as_str()),
    }
}

/// Whether a finding belongs to the claim of this entry.
pub fn is_about(claim: &ClaimId, entry: &Entry) -> bool {
    claim.owner == entry.owner && (claim.part.is_empty() || claim.part == part(entry.subject, &entry.what))
}

/// Sets the identity of the claim in each finding of its check.
pub(super) fn identify(
    owner: &str,
    verify: &Verify,
    question: Option<&Question>,
    judgement: &Judgement,
    findings: &mut [Finding],
) {
    let answer = judgement.answer.as_ref().map(|_| answer_result(verify, question, judgement));
    for finding in findings {
        let (part, result) = result_at(judgement, &finding.span).unwrap_or_else(|| match &answer {
            Some(result) => (String::new(), result.clone()),
            None => Default::default(),
        });
        finding.claim = Some(Box::new(ClaimId { owner: owner.to_string(), part, result }));
    }
}

/// The name and the result of the quote, closed form or run with this span.
fn result_at(judgement: &Judgement, span: &Range<usize>) -> Option<(String, String)> {
    let is_same = |is_span: &Range<usize>| is_span == span;
    let quotes = judgement.quotes.iter().filter(|q| is_same(&q.span));
    let quotes = quotes.map(|q| (part(Subject::Quote, &q.text), q.reason.clone()));
    let forms = judgement.exact.iter().filter(|form| is_same(&form.span));
    let forms = forms.map(|form| (part(Subject::ClosedForm, &form.trace), form.remark.clone()));
    let runs = judgement.runs.iter().filter(|run| is_same(&run.span));
    let runs = runs.map(|run| (part(Subject::Run, &run.name), run.broke.clone().unwrap_or_default()));
    quotes.chain(forms).chain(runs).next()
}

/// The claim and the result of a question as a text: the key, the conditions, the verdict, and which options hold.
fn answer_result(verify: &Verify, question: Option<&Question>, judgement: &Judgement) -> String {
    let mut text = String::new();
    match question.map(|q| &q.kind) {
        Some(QuestionKind::Choice { options, key, .. }) => {
            let described = key.as_ref().map_or("NaN".to_string(), AnswerKey::describe);
            let right = question.and_then(Question::keyed).unwrap_or_default();
            let right = right.iter().filter_map(|i| options.get(*i)).map(Text::as_str).collect::<Vec<_>>();
            let _ = write!(text, "key {described} ({})", right.join("; "));
        }
        Some(QuestionKind::TrueFalse { key, .. }) => {
            let _ = write!(text, "key {}", key.as_ref().map_or("NaN".to_string(), AnswerKey::describe));
        }
        Some(QuestionKind::Numeric { answer, tol, .. }) => {
            let value = |n: &Option<Number>| n.as_ref().map_or(f64::NAN, |n| n.value);
            let _ = write!(text, "key {} within {}", value(answer), value(tol));
        }
        _ => {}
    }
    for condition in verify.options.iter().chain(&verify.value) {
        let _ = write!(text, "; {}", condition.as_str());
    }
    if let Some(answer) = &judgement.answer {
        let _ = write!(text, "; {}: {}", answer.verdict.as_str(), answer.reason);
        for weight in &answer.weights {
            let holds = match weight.holds {
                Some(true) => "holds",
                Some(false) => "is false",
                None => "is undecided",
            };
            let option = weight.option.map_or(String::from("value"), |i| i.to_string());
            let _ = write!(text, "; {option} {holds}");
        }
    }
    text
}
