//! The results of all claims of one `verify` object.

use super::exact::ClosedForm;
use super::quote_checker::Quote;
use super::verdict::Answer;
use crate::ledger::{Evidence, State};
use crate::spec::{BreakExpectation, Question, Run, Verify};
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
    /// Whether it breaks, as the lesson says.
    pub expect: BreakExpectation,
}

impl RunReport {
    /// The state of the run, and the word that reports print for it.
    pub fn outcome(&self) -> (State, &'static str) {
        match (&self.broke, self.expect) {
            (Some(_), expect) if expect.forbids() => (State::False, "broken"),
            (Some(_), _) => (State::True(Evidence::Simulated), "breaks"),
            (None, expect) if expect.requires() => (State::False, "does not break"),
            (None, _) => (State::True(Evidence::Simulated), "made"),
        }
    }

    /// Whether the lesson says that it breaks, or that it may and it does.
    pub fn is_break_expected(&self) -> bool {
        self.expect.requires() || self.broke.is_some() && !self.expect.forbids()
    }
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
    /// Its unit, by its dimension; empty if it has none, or if it is not certain.
    pub unit: String,
}

/// The result of a `verify` object whose runs cannot be executed: no claim could be checked.
pub fn not_executable(verify: &Verify, question: Option<&Question>, reason: &str) -> Judgement {
    let run = |run: &Run| RunReport {
        name: run.name.value.clone(),
        span: run.name.span(),
        broke: None,
        expect: run.expect,
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
