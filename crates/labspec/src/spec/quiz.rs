//! The quiz object and its kinds of questions.

use super::allow::{self, Allowance};
use super::answer_key::{AnswerKey, read_key};
use super::fields::Fields;
use super::format::{
    CODE, DEBUG, MCQ, MULTIPLE, NUMERIC, OPEN, Object, PREDICT, QUESTION, QUIZ, TOLERANCE, TRUEFALSE,
};
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
    /// Byte range in the file, braces included.
    pub span: Range<usize>,
    /// Its id, unique in a course: the page stores answers under it.
    pub id: Option<Text>,
    /// The displayed title, see [`Quiz::title`].
    pub title: Option<Text>,
    /// The questions. One that could not be read is `None`, so that the others keep their numbers.
    pub questions: Vec<Option<Question>>,
    /// The findings that are suppressed for this quiz.
    pub lint: Option<Allowance>,
}

/// A question.
#[derive(Clone, Debug, PartialEq)]
pub struct Question {
    /// Byte range in the file, braces included.
    pub span: Range<usize>,
    /// The question as HTML.
    pub q: Text,
    /// Displayed after the answer, HTML.
    pub explain: Option<Text>,
    /// The displayed label.
    pub label: Option<Text>,
    /// The kind of question.
    pub kind: QuestionKind,
    /// The checkable claims about the answer.
    pub verify: Option<Verify>,
    /// The findings that are suppressed for this question.
    pub lint: Option<Allowance>,
}

/// How a question is answered.
#[derive(Clone, Debug, PartialEq)]
pub enum QuestionKind {
    /// One of several options, or several of them.
    Choice {
        /// One of the four kinds.
        style: ChoiceStyle,
        /// The options as HTML, in display order.
        options: Vec<Text>,
        /// Which options are correct.
        key: Option<AnswerKey>,
        /// How often the student can try; once if absent.
        attempts: Option<Number>,
        /// The lab that is displayed after the student has answered (`predict`).
        sim: Option<Box<Lab>>,
    },
    /// Whether a statement is true.
    TrueFalse {
        /// The correct answer.
        key: Option<AnswerKey>,
        /// How often the student can try; once if absent.
        attempts: Option<Number>,
    },
    /// A number.
    Numeric {
        /// The correct answer.
        answer: Option<Number>,
        /// The tolerance, see [`Question::numeric`].
        tol: Option<Number>,
        /// The displayed unit.
        unit: Option<Text>,
        /// How often the student can try; without a limit if absent.
        attempts: Option<Number>,
    },
    /// A text or a program, which is not graded.
    Open {
        /// Whether the kind is `code`; otherwise it is `open`.
        code: bool,
        /// The reference answer as HTML.
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
    /// `multiple`: the student chooses all correct options.
    Multiple,
}

impl Question {
    /// The lab of a `predict` question.
    pub fn sim(&self) -> Option<&Lab> {
        match &self.kind {
            QuestionKind::Choice { sim, .. } => sim.as_deref(),
            _ => None,
        }
    }

    /// The correct answer and the tolerance of a numeric question.
    pub fn numeric(&self) -> Option<(f64, f64)> {
        match &self.kind {
            QuestionKind::Numeric { answer: Some(answer), tol, .. } => {
                Some((answer.value, tol.as_ref().map_or(TOLERANCE * answer.value.abs(), |t| t.value)))
            }
            _ => None,
        }
    }

    /// Index of the correct option of a question with one; `None` if there is no option with this index.
    pub fn right_option(&self) -> Option<usize> {
        match &self.kind {
            QuestionKind::Choice { style: ChoiceStyle::Multiple, .. } => None,
            QuestionKind::Choice { .. } => self.keyed()?.first().copied(),
            _ => None,
        }
    }

    /// The indexes of the conditions under `verify` that must hold, from 0: those of the correct options, or 0 for a true
    /// statement. `None` if the question is of another kind or its key is invalid.
    pub fn keyed(&self) -> Option<Vec<usize>> {
        match &self.kind {
            QuestionKind::Choice { style, options, key: Some(key), .. } => {
                key.right_options(options.len(), *style == ChoiceStyle::Multiple)
            }
            QuestionKind::TrueFalse { key: Some(key), .. } => {
                key.is_true().map(|right| if right { vec![0] } else { Vec::new() })
            }
            _ => None,
        }
    }

    /// The number of conditions under `verify` that decide the answer: one for each option, or one for a statement.
    pub fn condition_count(&self) -> usize {
        match &self.kind {
            QuestionKind::Choice { options, .. } => options.len(),
            QuestionKind::TrueFalse { .. } => 1,
            QuestionKind::Numeric { .. } | QuestionKind::Open { .. } => 0,
        }
    }

    /// Which options are correct, or whether the statement is true.
    pub fn key(&self) -> Option<&AnswerKey> {
        match &self.kind {
            QuestionKind::Choice { key, .. } | QuestionKind::TrueFalse { key, .. } => key.as_ref(),
            QuestionKind::Numeric { .. } | QuestionKind::Open { .. } => None,
        }
    }

    /// How often the student can try, if the question says so.
    pub fn attempts(&self) -> Option<&Number> {
        match &self.kind {
            QuestionKind::Choice { attempts, .. }
            | QuestionKind::TrueFalse { attempts, .. }
            | QuestionKind::Numeric { attempts, .. } => attempts.as_ref(),
            QuestionKind::Open { .. } => None,
        }
    }

    /// All texts of the question that are HTML.
    pub fn html(&self) -> Vec<&Text> {
        let mut all = vec![&self.q];
        match &self.kind {
            QuestionKind::Choice { options, .. } => all.extend(options),
            QuestionKind::Open { reference, .. } => all.extend(reference),
            QuestionKind::TrueFalse { .. } | QuestionKind::Numeric { .. } => {}
        }
        all.extend(&self.explain);
        all
    }
}

impl Quiz {
    /// The displayed title.
    pub fn title(&self) -> &str {
        self.title.as_ref().map_or(QUIZ.text("title"), Text::as_str)
    }

    /// The questions that could be read, with their numbers from 1.
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
        "mcq" => choice(&mut fields, &MCQ, ChoiceStyle::Mcq),
        "debug" => choice(&mut fields, &DEBUG, ChoiceStyle::Debug),
        "predict" => choice(&mut fields, &PREDICT, ChoiceStyle::Predict),
        "multiple" => choice(&mut fields, &MULTIPLE, ChoiceStyle::Multiple),
        "truefalse" => {
            fields.narrow(&TRUEFALSE);
            Some(QuestionKind::TrueFalse {
                key: read_key(&mut fields, &[]),
                attempts: fields.whole("attempts"),
            })
        }
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

/// `None` if an option could not be read, which is reported: without it, the index of the answer has no meaning.
fn choice(fields: &mut Fields<'_, '_>, object: &'static Object, style: ChoiceStyle) -> Option<QuestionKind> {
    fields.narrow(object);
    let options = fields.items("options");
    let options: Option<Vec<Option<Text>>> =
        options.map(|nodes| nodes.iter().map(|n| read::text(n, "an option", fields.problems)).collect());
    let options: Option<Vec<Text>> = options.and_then(|all| all.into_iter().collect());
    let key = read_key(fields, options.as_deref().unwrap_or_default());
    let (mut attempts, mut sim) = (None, None);
    if style == ChoiceStyle::Predict {
        sim = fields.node("sim").and_then(|n| read_lab(n, fields.problems)).map(Box::new);
    } else {
        attempts = fields.whole("attempts");
    }
    Some(QuestionKind::Choice { style, options: options?, key, attempts, sim })
}

fn numeric(fields: &mut Fields<'_, '_>) -> QuestionKind {
    fields.narrow(&NUMERIC);
    QuestionKind::Numeric {
        answer: fields.number("answer"),
        tol: fields.number("tol"),
        unit: fields.text("unit"),
        attempts: fields.whole("attempts"),
    }
}
