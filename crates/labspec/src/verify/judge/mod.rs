//! The real library as a second judge: what becomes of claims with its numbers in place of ours.
//!
//! | piece | module |
//! |---|---|
//! | the runs that it is asked to make | `task` |
//! | its numbers beside ours | `numbers` |
//! | what it is not asked, counted | `left` |

mod left;
mod numbers;
mod task;

pub use left::Left;
pub use task::RunTask;
pub(crate) use task::tasks;

use super::bound::BoundVerify;
use super::format::significant;
use super::numerics::CHANGES;
use super::outcome::Outcome;
use super::outcomes::Outcomes;
use super::quote::RenderedText;
use super::quote_checker::Quote;
use super::quote_checker::QuoteChecker;
use super::verdict::Answer;
use super::{answer, says};
use crate::finding::Finding;
use crate::rules;
use crate::run::StepVariant;
use crate::source::Text;
use crate::spec::{Question, Verify};
use std::collections::BTreeMap;
use std::ops::Range;

/// What a judge found in a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RecordedRun {
    /// Measures by name, and expressions that look at the samples themselves by their text.
    pub values: BTreeMap<String, f64>,
    /// Why the others have no value.
    pub refused: BTreeMap<String, String>,
    /// Number of warnings.
    pub warnings: usize,
    /// What broke in it.
    pub broke: Option<String>,
}

/// What a judge makes of a `verify` object.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Judged {
    /// Numbers that were compared.
    pub compared: usize,
    /// Those that are others, by name: ours, and the judge's.
    pub differing: Vec<(String, f64, f64)>,
    /// Those that the judge has not taken, and why.
    pub unjudged: Vec<(String, String)>,
    /// Answers and quoted numbers that were judged again.
    pub claims: usize,
    /// Those whose verdict is another one.
    pub turned: usize,
}

/// What a judge is called, and what it found in each run of an object; `None` for a run of which it has nothing.
pub(crate) struct Reference<'w> {
    /// `MuJoCo 3.14.0`.
    pub(crate) engine: &'w str,
    /// In the order of [`tasks`]; with why nothing is there.
    pub(crate) runs: Vec<Result<&'w RecordedRun, String>>,
}

/// Compares every measure, and judges every claim again with the numbers of the judge in place of ours. `None` when a run cannot be
/// made here.
pub(crate) fn judge(
    bound: &BoundVerify<'_>,
    verify: &Verify,
    question: Option<&Question>,
    rendered: &RenderedText,
    reference: &Reference<'_>,
    findings: &mut Vec<Finding>,
) -> Option<Judged> {
    let nominal = bound.outcome(StepVariant::NOMINAL, &mut Vec::new())?;
    let mut judged = Judged::default();
    let theirs = numbers::replaced(bound, verify, &nominal, reference, &mut judged);
    numbers::compare(bound, verify, &nominal, &theirs, &mut judged);
    if judged.compared == 0 {
        return Some(judged);
    }
    // The range of an answer is a matter of many runs, which no judge has made: it is counted as left.
    let verify = &Verify { over: Vec::new(), ..verify.clone() };
    let [ours, now] = [&nominal, &theirs].map(|o| verdicts(bound, verify, question, rendered, o));
    let mut turn = |place: Range<usize>, what: &str, before: &str, after: &str, values: String| {
        judged.turned += 1;
        findings.push(
            Finding::new(
                rules::ENGINE_DEPENDENT,
                place,
                format!("{what} depends on the engine: {before} here, but {after} with {}", reference.engine),
            )
            .why(format!("{values}: a student whose page has another version sees something else"))
            .help(
                "ask about something that does not depend on it, quote fewer digits, or name the version in the text",
            ),
        );
    };
    let most: Vec<String> = judged
        .differing
        .iter()
        .take(3)
        .map(|(name, ours, theirs)| {
            format!("`{name}` is {} here but {} there", format_value(*ours), format_value(*theirs))
        })
        .collect();
    let values = if most.is_empty() { "a run breaks in one of them".to_string() } else { most.join(", ") };
    if let (Some(ours), Some(now)) = (&ours.0, &now.0) {
        judged.claims += 1;
        if ours.verdict != now.verdict {
            let right = question.and_then(Question::right_option).and_then(|i| verify.options.get(i));
            let place = verify.value.as_ref().or(right).map_or(verify.span.clone(), Text::span);
            turn(place, "this answer", ours.verdict.as_str(), now.verdict.as_str(), values.clone());
        }
    }
    for (ours, now) in ours.1.iter().zip(&now.1) {
        judged.claims += 1;
        if ours.state != now.state {
            let numbers = format!(
                "it is {} here but {} there",
                format_value(ours.computed),
                format_value(now.computed)
            );
            turn(ours.span.clone(), &format!("\"{}\"", ours.text), ours.verdict(), now.verdict(), numbers);
        }
    }
    Some(judged)
}

/// Enough digits to see that two numbers are not the same.
pub fn format_value(x: f64) -> String {
    let short = significant(x);
    if x.is_finite() && short.parse::<f64>().is_ok_and(|y| y != x) {
        format!("{x:.9e}").parse::<f64>().map_or(short, |y| y.to_string())
    } else {
        short
    }
}

/// The answer and the quoted numbers, as these numbers have them.
fn verdicts(
    bound: &BoundVerify<'_>,
    verify: &Verify,
    question: Option<&Question>,
    rendered: &RenderedText,
    outcome: &Outcome,
) -> (Option<Answer>, Vec<Quote>) {
    let outcomes =
        Outcomes { nominal: outcome.clone(), perturbed: [const { None }; CHANGES], perturbed_back: None };
    let ignored = &mut Vec::new();
    let answer = question.and_then(|q| answer::check_answer(bound, &outcomes, verify, q, ignored));
    let checker = QuoteChecker { bound, outcomes: &outcomes, rendered };
    (answer, says::check_quotes(checker, verify, question, ignored))
}
