//! What can be wrong with the structure of a lesson, where. The words are those of `lint`.

use crate::{json, markdown};
use std::ops::Range;

/// Something that is wrong with a lesson.
#[derive(Clone, Debug, PartialEq)]
pub enum Problem {
    /// With its fences.
    Fence(markdown::Problem),
    /// With the JSON of a block.
    Json(json::Problem),
    /// With an object: it is not as the format says.
    Format(Misfit),
}

/// Something that is not as the format says.
#[derive(Clone, Debug, PartialEq)]
pub struct Misfit {
    /// Bytes of the file.
    pub span: Range<usize>,
    /// What it is.
    pub mistake: Mistake,
    /// It stands in a `verify` object, which a page does not read.
    pub in_verify: bool,
}

/// What can be wrong.
#[derive(Clone, Debug, PartialEq)]
pub enum Mistake {
    /// A value of another type.
    Type {
        /// What the value is: `` `stopAt` ``, `a slider`.
        what: String,
        /// What it should be.
        expected: Expected,
        /// What it is, in an author's words.
        found: &'static str,
        /// What it says, when it is a text.
        text: Option<String>,
    },
    /// A number with decimals.
    NotWhole {
        /// Its key.
        key: String,
        /// The number.
        value: f64,
    },
    /// A key that the format has not.
    UnknownKey {
        /// The object: `a slider`.
        of: &'static str,
        /// The key.
        key: String,
        /// What was meant.
        meant: Meant,
    },
    /// A key that is not there.
    MissingKey {
        /// The object.
        of: &'static str,
        /// The key.
        key: &'static str,
        /// What it is needed for.
        why: &'static str,
        /// It could be left out, but should not.
        advised: bool,
    },
    /// No such control.
    ControlType(String),
    /// No such question.
    QuestionKind(String),
    /// Something else than a pair of text and value.
    NoChoice,
    /// A select without choices.
    NothingOffered,
    /// A plot without traces.
    NoTraces,
    /// Something else than three numbers.
    NoPoint,
    /// An overlay that is neither on nor off.
    NoSwitch,
    /// What a lab cannot be expected to do.
    LabExpects(String),
    /// What a run cannot be expected to do.
    RunExpects(String),
    /// A text that is no place of a lab.
    NoPlace(String),
    /// Something that is neither the place of a lab nor a lab; what it is.
    NoLab(&'static str),
    /// Something else than one control or attribute with its values.
    NoSweep,
    /// A column that says neither how its rows are distinguished nor which row is meant, or both.
    NoRows,
    /// A search for neither the largest nor the smallest value, or for both.
    FindsNothing,
    /// A search whose first value is not below its last one.
    FindsBackwards,
    /// A sweep with too few or too many values.
    SweptValues(usize),
    /// Something else than a pair of label and time.
    NoPress,
    /// Something else than the two ends of a range, the smaller one first.
    NoRange,
    /// Something else than a pair of quote and expression.
    NoQuote,
    /// A `verify` object that compares nothing.
    ClaimsNothing,
    /// A fence of labs that holds a quiz; the opening line as it should be.
    HoldsQuiz(String),
    /// A fence of quizzes that holds a lab; the opening line as it should be.
    HoldsLab(String),
    /// A fence that holds nothing.
    EmptyFence,
    /// An object that is neither a lab nor a quiz.
    UnknownObject,
    /// A file that is larger than what is read.
    TooLarge,
}

/// What a value should be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Expected {
    /// A text.
    Text,
    /// A number.
    Number,
    /// `true` or `false`.
    Flag,
    /// A number, a text or a truth value.
    Scalar,
    /// A list.
    List,
    /// An object.
    Object,
}

/// What an unknown key was meant to be.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Meant {
    /// A key that the object has already.
    There(&'static str),
    /// A key that such a value fits; it is read as that.
    Likely(&'static str),
    /// A key that takes something else.
    Other {
        /// The key.
        key: &'static str,
        /// What it takes, in an author's words.
        takes: &'static str,
    },
    /// None of these.
    Unclear(Vec<&'static str>),
}

impl Mistake {
    /// The problem at these bytes of the file.
    pub(super) fn at(self, span: Range<usize>) -> Problem {
        Problem::Format(Misfit { span, mistake: self, in_verify: false })
    }
}
