//! Compares with MuJoCo as a reference engine: the verdicts of claims with its numbers in place of ours.
//!
//! | part | module |
//! |---|---|
//! | the runs that it has to make | `task` |
//! | its numbers beside ours | `numbers` |
//! | the claims that it does not check, counted | `left` |

mod left;
mod numbers;
mod task;

pub use left::Unjudged;
pub use task::RunTask;
pub(crate) use task::tasks;

use super::bound::BoundVerify;
use super::format::significant;
use super::numerics::CHANGES;
use super::outcome::MeasuredRuns;
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

/// The results of a run in the reference engine.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RecordedRun {
    /// Measures by name, and expressions with their own aggregates by their text.
    pub values: BTreeMap<String, f64>,
    /// Why the other measures have no value.
    pub refused: BTreeMap<String, String>,
    /// Number of warnings.
    pub warnings: usize,
    /// Why measures are NaN.
    pub without_value: BTreeMap<String, String>,
    /// How the run broke.
    pub broke: Option<String>,
}

/// A value that differs in the reference engine.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    /// The measure, `run.measure`, or an expression with its own aggregates.
    pub name: String,
    /// Our value.
    pub labspec_value: f64,
    /// The reference value.
    pub reference_value: f64,
    /// Why one of them is NaN, if that is known.
    pub no_value: Option<String>,
}

impl Difference {
    /// Both values, and why one of them is NaN.
    pub fn describe(&self) -> String {
        let [labspec_value, reference_value] = [self.labspec_value, self.reference_value].map(format_value);
        let why = self.no_value.as_ref().map_or(String::new(), |why| format!(": {why}"));
        format!("`{}` is {labspec_value} in labspec but {reference_value} in the recording{why}", self.name)
    }
}

/// The comparison of a `verify` object with the reference engine.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Judged {
    /// Number of compared values.
    pub compared: usize,
    /// Values that differ.
    pub differing: Vec<Difference>,
    /// Values that the reference engine did not record, and why.
    pub unjudged: Vec<(String, String)>,
    /// Number of answers and quoted numbers that were checked again.
    pub claims: usize,
    /// Number of those whose verdict differs.
    pub turned: usize,
}

/// The name of a reference engine, and its results for each run of an object; an error for a run that is not recorded.
pub(crate) struct Reference<'w> {
    /// `MuJoCo 3.14.0`.
    pub(crate) engine: &'w str,
    /// In the order of [`tasks`]; the error is the reason.
    pub(crate) runs: Vec<Result<&'w RecordedRun, String>>,
}

/// Compares every measure, and checks every claim again with the reference values in place of ours. `None` when a run
/// cannot be executed here.
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
    let with_reference = numbers::replaced(bound, verify, &nominal, reference, &mut judged);
    numbers::compare(bound, verify, &nominal, &with_reference, reference, &mut judged);
    if judged.compared == 0 {
        return Some(judged);
    }
    // An answer over a range needs many runs that are not recorded: it is counted in [`Unjudged`].
    let verify = &Verify { over: Vec::new(), ..verify.clone() };
    let [nominal_verdicts, current] =
        [&nominal, &with_reference].map(|o| verdicts(bound, verify, question, rendered, o));
    let mut turn = |place: Range<usize>, what: &str, before: &str, after: &str, values: String| {
        judged.turned += 1;
        findings.push(
            Finding::new(
                rules::ENGINE_DEPENDENT,
                place,
                format!("{what} depends on the engine: {before} with labspec, but {after} with {}", reference.engine),
            )
            .why(format!("{values}: a student whose page has another version sees something else"))
            .help(
                "ask about something that does not depend on it, quote fewer digits, or name the version in the text",
            ),
        );
    };
    let most: Vec<String> = judged.differing.iter().take(3).map(Difference::describe).collect();
    let values =
        if most.is_empty() { "a run breaks in one of the engines".to_string() } else { most.join(", ") };
    if let (Some(computed), Some(current)) = (&nominal_verdicts.0, &current.0) {
        judged.claims += 1;
        if computed.verdict != current.verdict {
            let right = question.and_then(Question::right_option).and_then(|i| verify.options.get(i));
            let place = verify.value.as_ref().or(right).map_or(verify.span.clone(), Text::span);
            turn(place, "this answer", computed.verdict.as_str(), current.verdict.as_str(), values.clone());
        }
    }
    for (quote, current) in nominal_verdicts.1.iter().zip(&current.1) {
        judged.claims += 1;
        if quote.state != current.state {
            let numbers = format!(
                "it is {} in labspec but {} in the recording",
                format_value(quote.computed),
                format_value(current.computed)
            );
            turn(
                quote.span.clone(),
                &format!("\"{}\"", quote.text),
                quote.verdict(),
                current.verdict(),
                numbers,
            );
        }
    }
    Some(judged)
}

/// Formats a number with enough digits to distinguish it from another one.
pub fn format_value(x: f64) -> String {
    let short = significant(x);
    if x.is_finite() && short.parse::<f64>().is_ok_and(|y| y != x) {
        format!("{x:.9e}").parse::<f64>().map_or(short, |y| y.to_string())
    } else {
        short
    }
}

/// The verdicts of the answer and of the quoted numbers for an outcome.
fn verdicts(
    bound: &BoundVerify<'_>,
    verify: &Verify,
    question: Option<&Question>,
    rendered: &RenderedText,
    outcome: &MeasuredRuns,
) -> (Option<Answer>, Vec<Quote>) {
    let outcomes = Outcomes { nominal: outcome.clone(), perturbed: [const { None }; CHANGES] };
    let ignored = &mut Vec::new();
    let answer = question.and_then(|q| answer::check_answer(bound, &outcomes, verify, q, ignored));
    let checker = QuoteChecker { bound, outcomes: &outcomes, rendered };
    (answer, says::check_quotes(checker, verify, question, ignored))
}
