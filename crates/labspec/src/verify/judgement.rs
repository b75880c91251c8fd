//! The results of all claims of one `verify` object.

use super::exact::ClosedForm;
use super::quote::QuoteState;
use super::quote_checker::Quote;
use super::verdict::{Answer, Verdict};
use crate::ledger::State;
use crate::spec::{Question, Run, Verify};
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// The results of one `verify` object.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Judgement {
    /// The answer of the question, if the object checks it.
    pub answer: Option<Answer>,
    /// The numbers under `says`, in order.
    pub quotes: Vec<Quote>,
    /// The closed forms under `exact`, in order.
    pub exact: Vec<ClosedForm>,
    /// The runs, in order.
    pub runs: Vec<RunReport>,
    /// Every measure of every run, named as conditions read it.
    pub measures: Vec<Measured>,
    /// Why no run was executed, if none could be.
    pub unmade: Option<String>,
}

/// A run of a `verify` object.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RunReport {
    /// Its name.
    pub name: String,
    /// Its span in the lesson.
    pub span: Range<usize>,
    /// How it broke.
    pub broke: Option<String>,
    /// Whether the lesson declares that it breaks.
    pub expected: bool,
}

/// A measure under the numerics of the lesson and at half the timestep.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Measured {
    /// `run.measure`, or the measure alone where there is one run.
    pub name: String,
    /// Its value.
    #[serde(with = "crate::verify::float_bits")]
    pub value: f64,
    /// Its value at half the timestep; `None` when it is the same, was not needed, or the lesson sets every timestep.
    #[serde(with = "crate::verify::float_bits")]
    pub halved: Option<f64>,
}

/// The result of a `verify` object whose runs cannot be executed: no claim could be checked.
pub fn not_executable(verify: &Verify, question: Option<&Question>, reason: &str) -> Judgement {
    let run = |run: &Run| RunReport {
        name: run.name.value.clone(),
        span: run.name.span(),
        broke: None,
        expected: run.breaks,
    };
    Judgement {
        answer: question.filter(|_| verify.claims_answer()).map(|_| Answer::failed(reason)),
        quotes: verify
            .says
            .iter()
            .map(|s| &s.quote)
            .chain(verify.table.iter().map(|c| &c.column))
            .map(|text| Quote::unclear(text, reason))
            .collect(),
        exact: verify.exact.iter().map(|e| ClosedForm::unchecked(e, reason)).collect(),
        runs: verify.runs.iter().map(run).collect(),
        measures: Vec::new(),
        unmade: Some(reason.to_string()),
    }
}

impl Judgement {
    /// Changes every true result to unchecked, for a reason that applies to all of them.
    pub(crate) fn withdraw(&mut self, reason: &str) {
        let is_true = |state: State| matches!(state, State::True(_));
        for answer in self.answer.iter_mut().filter(|a| is_true(a.verdict.state())) {
            *answer = Answer { verdict: Verdict::Failed, reason: reason.to_string(), ..answer.clone() };
        }
        for quote in self.quotes.iter_mut().filter(|q| q.state == QuoteState::Right) {
            (quote.state, quote.reason) = (QuoteState::Unclear, reason.to_string());
        }
        for form in self.exact.iter_mut().filter(|form| is_true(form.state)) {
            (form.state, form.remark) = (State::Unchecked, reason.to_string());
        }
    }
}
