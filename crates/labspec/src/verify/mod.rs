//! The truth of what a lesson claims: runs, measures over them, and verdicts.

mod bound;
mod measure;
mod outcome;
mod quote;

pub use bound::BoundVerify;
pub use quote::{Form, Other, QuoteOutcome, QuoteState, Quoted, ShownText, Style, Unread, quoted};

use crate::bind::scene::finding;
use crate::finding::Finding;
use crate::run::Numerics;
use crate::spec::{Lesson, Question, QuestionKind, Verify};
use std::ops::Range;

/// What became of a question or of a lab's claims.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Verdict {
    /// Exactly the keyed answer holds, and every quoted number is right.
    Verified,
    /// It holds, but not when the timestep is halved or the solver tightened.
    Fragile,
    /// The keyed answer holds, and another one too.
    Ambiguous,
    /// The keyed answer does not hold, or a quoted number is wrong.
    Refuted,
    /// It could not be checked: something is wrong with the runs or the conditions.
    Failed,
    /// There is nothing to check.
    Unverified,
}

impl Verdict {
    /// In one word.
    pub fn as_str(self) -> &'static str {
        match self {
            Verdict::Verified => "verified",
            Verdict::Fragile => "fragile",
            Verdict::Ambiguous => "ambiguous",
            Verdict::Refuted => "refuted",
            Verdict::Failed => "failed",
            Verdict::Unverified => "unverified",
        }
    }
}

/// A checked claim, for the report.
#[derive(Clone, Debug, PartialEq)]
pub struct Claim {
    /// What claims it: `quiz 0.1-predict, question 2`, `lab #2`.
    pub name: String,
    /// Bytes of the lesson.
    pub span: Range<usize>,
    /// What became of it.
    pub verdict: Verdict,
    /// Values of all measures, as `run.measure`.
    pub measures: Vec<(String, f64)>,
    /// Number of quoted numbers that were compared.
    pub quotes: usize,
}

/// The two changes of the numerics that an answer must survive, and how to call them.
const PERTURBED: [(Numerics, &str); 2] = [
    (Numerics { timestep: 0.5, tight: false }, "with half the timestep"),
    (Numerics { timestep: 1.0, tight: true }, "with the solver run to convergence"),
];

/// Checks the claims of one `verify` object. `question` is what carries it, unless a lab does.
pub fn check(
    bound: &BoundVerify<'_>,
    verify: &Verify,
    question: Option<&Question>,
    lesson: &Lesson,
    findings: &mut Vec<Finding>,
) -> Judgement {
    let mut failed = Judgement { verdict: Verdict::Failed, measures: Vec::new(), quotes: 0 };
    let Some(outcome) = bound.outcome(Numerics::NOMINAL, findings) else { return failed };
    failed.measures = outcome.list();
    let mut judgement = Judgement { verdict: Verdict::Verified, ..failed.clone() };

    if let Some(question) = question
        && !verify.options.is_empty()
    {
        let Some(holds) = bound.conditions(&outcome, verify, findings) else { return failed };
        judgement.verdict = judge_options(bound, &holds, verify, question, findings);
    }
    if let (Some(question), Some(value)) = (question, &verify.value) {
        let Some(computed) = bound.number(&outcome, value, findings) else { return failed };
        judgement.verdict = judge_value(bound, computed, verify, question, findings);
    }
    let half = (!verify.says.is_empty()).then(|| bound.outcome(PERTURBED[0].0, &mut Vec::new())).flatten();
    let shown = if verify.says.is_empty() { ShownText::default() } else { ShownText::of(lesson) };
    judgement.quotes = 0;
    for said in &verify.says {
        let Some(computed) = bound.number(&outcome, &said.expr, findings) else {
            judgement.verdict = Verdict::Failed;
            continue;
        };
        let halved = half.as_ref().and_then(|o| bound.number(o, &said.expr, &mut Vec::new()));
        let others: Vec<Other> =
            halved.map(|value| Other { how: "at half the timestep", value }).into_iter().collect();
        let checked = quote::check(said, computed, &others, &[], question, &shown, findings);
        match checked.state {
            QuoteState::Right => judgement.quotes += 1,
            QuoteState::Wrong => judgement.verdict = judgement.verdict.max(Verdict::Refuted),
            QuoteState::Unclear => judgement.verdict = Verdict::Failed,
        }
    }
    judgement
}

/// The result of [`check`].
#[derive(Clone, Debug, PartialEq)]
pub struct Judgement {
    /// What became of the claim.
    pub verdict: Verdict,
    /// Values of all measures.
    pub measures: Vec<(String, f64)>,
    /// Number of quoted numbers that were compared.
    pub quotes: usize,
}

/// Which options hold, and so whether the keyed one is the only one.
fn judge_options(
    bound: &BoundVerify<'_>,
    holds: &[bool],
    verify: &Verify,
    question: &Question,
    findings: &mut Vec<Finding>,
) -> Verdict {
    let (Some(answer), QuestionKind::Choice { options, answer: Some(keyed), .. }) =
        (question.right_option(), &question.kind)
    else {
        return Verdict::Failed;
    };
    let name =
        |i: usize| format!("{} (\"{}\")", i, options.get(i).map_or(String::new(), |o| shorten(&o.value)));
    let held: Vec<usize> = (0..holds.len()).filter(|&i| holds[i]).collect();
    let condition = |i: usize| verify.options.get(i).map_or(verify.span.clone(), |c| c.span());
    if !holds.get(answer).copied().unwrap_or(false) {
        let others = held.iter().map(|&i| name(i)).collect::<Vec<_>>().join(", ");
        let mut f = finding(
            "answer-refuted",
            keyed.span.clone(),
            format!("the simulation refutes answer {}", name(answer)),
        )
        .why("a student who predicts right is told that they are wrong")
        .related(condition(answer), "this condition does not hold");
        f = match held.as_slice() {
            [] => f.help("no condition holds: correct the conditions, or the model that they are about"),
            [one] => {
                f.help(format!("what holds is answer {others}")).fix(keyed.span.clone(), one.to_string())
            }
            _ => f.help(format!("what holds is {others}")),
        };
        findings.push(f);
        return Verdict::Refuted;
    }
    if held.len() > 1 {
        let others = held.iter().filter(|&&i| i != answer).map(|&i| name(i)).collect::<Vec<_>>().join(", ");
        let mut f = finding(
            "answer-ambiguous",
            keyed.span.clone(),
            format!("besides answer {}, {others} holds too", name(answer)),
        )
        .why("a student who chooses the other one is right and is told otherwise")
        .help("word the options, or write their conditions, so that exactly one can hold");
        for &i in held.iter().filter(|&&i| i != answer) {
            f = f.related(condition(i), "this condition holds too");
        }
        findings.push(f);
        return Verdict::Ambiguous;
    }
    for (numerics, how) in PERTURBED {
        let again = bound
            .outcome(numerics, &mut Vec::new())
            .and_then(|o| bound.conditions(&o, verify, &mut Vec::new()));
        if again.as_deref() != Some(holds) {
            findings.push(fragile(keyed.span.clone(), how));
            return Verdict::Fragile;
        }
    }
    Verdict::Verified
}

fn judge_value(
    bound: &BoundVerify<'_>,
    computed: f64,
    verify: &Verify,
    question: &Question,
    findings: &mut Vec<Finding>,
) -> Verdict {
    let (Some((answer, tol)), Some(value), QuestionKind::Numeric { answer: Some(keyed), .. }) =
        (question.numeric(), &verify.value, &question.kind)
    else {
        return Verdict::Failed;
    };
    let right = |x: f64| (x - answer).abs() <= tol;
    if !right(computed) {
        findings.push(
            finding(
                "answer-refuted",
                keyed.span.clone(),
                format!("the answer is {answer}, the simulation gives {}", significant(computed)),
            )
            .why(format!(
                "they differ by {}, the tolerance is {}",
                significant((computed - answer).abs()),
                significant(tol)
            ))
            .help("correct the answer, or the expression that it is compared with")
            .related(value.span(), format!("this is {}", significant(computed))),
        );
        return Verdict::Refuted;
    }
    for (numerics, how) in PERTURBED {
        let again =
            bound.outcome(numerics, &mut Vec::new()).and_then(|o| bound.number(&o, value, &mut Vec::new()));
        if !again.is_some_and(right) {
            findings.push(fragile(keyed.span.clone(), how));
            return Verdict::Fragile;
        }
    }
    Verdict::Verified
}

fn fragile(span: Range<usize>, how: &str) -> Finding {
    crate::bind::warning("answer-fragile", span, format!("the answer holds, but not {how}"))
        .why("it depends on numerics that the question does not mention: a student with another setting sees something else")
        .help("state the setting in the question and `set` it in the run, or ask about what does not depend on it")
}

/// A number with six significant digits, without trailing zeros.
pub(crate) fn significant(x: f64) -> String {
    if x == 0.0 || !x.is_finite() {
        return x.to_string();
    }
    let exponent = x.abs().log10().floor() as i32;
    if !(-4..=6).contains(&exponent) {
        return format!("{x:.5e}");
    }
    let text = format!("{x:.*}", (5 - exponent).max(0) as usize);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_string() } else { text }
}

/// The beginning of a text, for messages.
fn shorten(text: &str) -> String {
    let short: String = text.chars().take(48).collect();
    if short.len() < text.len() { format!("{short}…") } else { short }
}
