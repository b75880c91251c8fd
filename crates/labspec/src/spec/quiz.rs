//! The quiz object and its kinds of questions.

use super::allow::{self, Allowance};
use super::fields::Fields;
use super::format::{CODE, DEBUG, MCQ, NUMERIC, OPEN, PREDICT, QUESTION, QUIZ, TOLERANCE};
use super::lab::{Lab, Verify};
use super::problem::{Mistake, Problem};
use super::read;
use super::read_lab::{read_lab, read_verify};
use crate::json::{Node, Number};
use crate::source::Text;
use std::ops::Range;

/// A quiz.
#[derive(Clone, Debug, PartialEq)]
pub struct Quiz {
    /// Bytes of the file, braces included.
    pub span: Range<usize>,
    /// Its id, unique in a course: answers are stored under it.
    pub id: Option<Text>,
    /// Shown title, see [`Quiz::title`].
    pub title: Option<Text>,
    /// The questions. One that could not be understood is `None`, so that the numbers of the others stay.
    pub questions: Vec<Option<Question>>,
    /// Findings that are not reported about it.
    pub lint: Option<Allowance>,
}

/// A question.
#[derive(Clone, Debug, PartialEq)]
pub struct Question {
    /// Bytes of the file, braces included.
    pub span: Range<usize>,
    /// The question, HTML.
    pub q: Text,
    /// Shown after the answer, HTML.
    pub explain: Option<Text>,
    /// Shown label.
    pub label: Option<Text>,
    /// What is asked.
    pub kind: QuestionKind,
    /// What a machine can check about the answer.
    pub verify: Option<Verify>,
    /// Findings that are not reported about it.
    pub lint: Option<Allowance>,
}

/// How a question is answered.
#[derive(Clone, Debug, PartialEq)]
pub enum QuestionKind {
    /// One of several options.
    Choice {
        /// Which of the three kinds.
        style: ChoiceStyle,
        /// The options, HTML, in the order shown.
        options: Vec<Text>,
        /// Index of the right option, from 0.
        answer: Option<Number>,
        /// The lab that is shown after the student has committed (`predict`).
        sim: Option<Box<Lab>>,
    },
    /// A number.
    Numeric {
        /// The right answer.
        answer: Option<Number>,
        /// How far an answer may be off, see [`Question::numeric`].
        tol: Option<Number>,
        /// Unit, for display.
        unit: Option<Text>,
    },
    /// A text or a program, not graded.
    Open {
        /// `code` rather than `open`.
        code: bool,
        /// The reference answer, HTML.
        reference: Option<Text>,
    },
}

/// The kinds of questions with options.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChoiceStyle {
    /// `mcq`
    Mcq,
    /// `debug`
    Debug,
    /// `predict`
    Predict,
}

impl Question {
    /// The lab of a `predict` question.
    pub fn sim(&self) -> Option<&Lab> {
        match &self.kind {
            QuestionKind::Choice { sim, .. } => sim.as_deref(),
            _ => None,
        }
    }

    /// Right answer and tolerance of a numeric question.
    pub fn numeric(&self) -> Option<(f64, f64)> {
        match &self.kind {
            QuestionKind::Numeric { answer: Some(answer), tol, .. } => {
                Some((answer.value, tol.as_ref().map_or(TOLERANCE * answer.value.abs(), |t| t.value)))
            }
            _ => None,
        }
    }

    /// Index of the right option, when it is one of the options.
    pub fn right_option(&self) -> Option<usize> {
        match &self.kind {
            QuestionKind::Choice { answer: Some(answer), options, .. } => {
                (0..options.len()).find(|&i| i as f64 == answer.value)
            }
            _ => None,
        }
    }

    /// Every text of the question that is HTML.
    pub fn html(&self) -> Vec<&Text> {
        let mut all = vec![&self.q];
        match &self.kind {
            QuestionKind::Choice { options, .. } => all.extend(options),
            QuestionKind::Open { reference, .. } => all.extend(reference),
            QuestionKind::Numeric { .. } => {}
        }
        all.extend(&self.explain);
        all
    }
}

impl Quiz {
    /// The shown title.
    pub fn title(&self) -> &str {
        self.title.as_ref().map_or(QUIZ.text("title"), Text::as_str)
    }

    /// The questions that were understood, with their numbers from 1.
    pub fn numbered(&self) -> impl Iterator<Item = (usize, &Question)> {
        self.questions.iter().enumerate().filter_map(|(i, q)| q.as_ref().map(|q| (i + 1, q)))
    }
}

/// Reads a quiz.
pub(super) fn read_quiz(node: &Node, problems: &mut Vec<Problem>) -> Option<Quiz> {
    let mut fields = Fields::open(node, &QUIZ, problems)?;
    let id = fields.text("id");
    let title = fields.text("title");
    let questions = fields.items("questions");
    let questions = questions.unwrap_or_default().iter().map(|n| question(n, fields.problems)).collect();
    let span = fields.span();
    let lint = allow::read_allowance(fields.node("lint"), span.clone(), fields.problems);
    fields.finish();
    Some(Quiz { span, id, title, questions, lint })
}

fn question(node: &Node, problems: &mut Vec<Problem>) -> Option<Question> {
    let mut fields = Fields::open_one(node, &QUESTION, problems)?;
    let kind = fields.text("kind");
    let q = fields.text("q");
    let explain = fields.text("explain");
    let label = fields.text("label");
    let asked = match kind.as_ref().map_or("mcq", Text::as_str) {
        "mcq" => choice(&mut fields, ChoiceStyle::Mcq),
        "debug" => choice(&mut fields, ChoiceStyle::Debug),
        "predict" => choice(&mut fields, ChoiceStyle::Predict),
        "numeric" => Some(numeric(&mut fields)),
        word @ ("open" | "code") => {
            fields.narrow(if word == "code" { &CODE } else { &OPEN });
            Some(QuestionKind::Open { code: word == "code", reference: fields.text("reference") })
        }
        other => {
            let span = kind.as_ref().map_or(node.span.clone(), Text::span);
            fields.problems.push(Mistake::QuestionKind(other.to_string()).at(span));
            return None;
        }
    };
    let verify = fields.node("verify").and_then(|n| read_verify(n, fields.problems));
    let span = fields.span();
    let lint = allow::read_allowance(fields.node("lint"), span.clone(), fields.problems);
    fields.finish();
    Some(Question { span, q: q?, explain, label, kind: asked?, verify, lint })
}

/// `None` when an option is broken, which is reported: without it, indexes mean nothing.
fn choice(fields: &mut Fields<'_, '_>, style: ChoiceStyle) -> Option<QuestionKind> {
    let options = fields.items("options");
    let options: Option<Vec<Option<Text>>> =
        options.map(|nodes| nodes.iter().map(|n| read::text(n, "an option", fields.problems)).collect());
    let options: Option<Vec<Text>> = options.and_then(|all| all.into_iter().collect());
    let answer = fields.whole("answer");
    let mut sim = None;
    match style {
        ChoiceStyle::Mcq => fields.narrow(&MCQ),
        ChoiceStyle::Debug => fields.narrow(&DEBUG),
        ChoiceStyle::Predict => {
            fields.narrow(&PREDICT);
            sim = fields.node("sim").and_then(|n| read_lab(n, fields.problems)).map(Box::new);
        }
    }
    Some(QuestionKind::Choice { style, options: options?, answer, sim })
}

fn numeric(fields: &mut Fields<'_, '_>) -> QuestionKind {
    fields.narrow(&NUMERIC);
    QuestionKind::Numeric {
        answer: fields.number("answer"),
        tol: fields.number("tol"),
        unit: fields.text("unit"),
    }
}
