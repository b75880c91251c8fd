//! Structural problems of a lesson, with their positions. `lint` contains the messages.

use crate::{json, markdown};
use std::ops::Range;

/// A problem of a lesson.
#[derive(Clone, Debug, PartialEq)]
pub enum Problem {
    /// In its fences.
    Fence(markdown::Problem),
    /// In the JSON of a block.
    Json(json::Problem),
    /// In an object that does not conform to the format.
    Format(FormatProblem),
}

/// A deviation from the format.
#[derive(Clone, Debug, PartialEq)]
pub struct FormatProblem {
    /// Byte range in the file.
    pub span: Range<usize>,
    /// The error.
    pub mistake: Mistake,
    /// Whether it is in a `verify` object, which the page does not read.
    pub in_verify: bool,
}

/// The possible errors.
#[derive(Clone, Debug, PartialEq)]
pub enum Mistake {
    /// A value has the wrong type.
    Type {
        /// The value: `` `stopAt` ``, `a slider`.
        what: String,
        /// The expected type.
        expected: Expected,
        /// The actual type, for messages.
        found: &'static str,
        /// The text, if the value is a text.
        text: Option<String>,
    },
    /// A number with decimals instead of an integer.
    NotWhole {
        /// Its key.
        key: String,
        /// The number.
        value: f64,
    },
    /// A key that is not in the format.
    UnknownKey {
        /// The object: `a slider`.
        object: &'static str,
        /// The key.
        key: String,
        /// The key that is probably meant.
        meant: Meant,
    },
    /// A missing key.
    MissingKey {
        /// The object.
        object: &'static str,
        /// The key.
        key: &'static str,
        /// The reason that it is needed.
        why: &'static str,
        /// Whether it is only recommended.
        advised: bool,
        /// A possible value, as JSON; empty if the format has none.
        example: &'static str,
    },
    /// An unknown type of control.
    ControlType(String),
    /// An unknown kind of question.
    QuestionKind(String),
    /// An option that is not a pair of text and value.
    NoChoice {
        /// Its text, if it is one.
        text: Option<String>,
        /// Its index.
        index: usize,
    },
    /// A select without options.
    NothingOffered,
    /// A plot without traces.
    NoTraces,
    /// A point that is not a list of three numbers.
    NoPoint,
    /// An overlay whose value is not a boolean.
    NoSwitch,
    /// An unknown value of `expect` of a lab.
    LabExpects(String),
    /// An unknown value of `expect` of a run.
    RunExpects(String),
    /// A text that is not the address of a lab.
    NoPlace(String),
    /// A value that is neither the address of a lab nor a lab; with a description of the value.
    NoLab(&'static str),
    /// A sweep that is not one control or one attribute with its values.
    NoSweep,
    /// A column with neither `by` nor `row`, or with both.
    NoRows,
    /// An entry of a table without a column, or with several forms of one.
    NoColumn,
    /// A search with neither `largest` nor `smallest`, or with both.
    FindsNothing,
    /// A search whose first value is not less than its last value.
    FindsBackwards,
    /// A sweep with too few or too many values.
    SweptValues(usize),
    /// A name of runs that lists more or fewer names than its sweep has runs.
    RunNames {
        /// The number of names.
        names: usize,
        /// The number of runs of the sweep.
        members: usize,
    },
    /// A name in a list of runs that another run has.
    RunTwice(String),
    /// A file or a listing of a claim that cannot be read: its name, and the reason.
    NoSource(String, String),
    /// A press that is not a pair of label and time.
    NoPress,
    /// A range that is not a pair of a smaller and a larger number.
    NoRange,
    /// A quote that is not a pair of quote and expression.
    NoQuote,
    /// A list with one quote and its expression, in place of a list of such lists.
    QuoteWithoutList([String; 2]),
    /// An answer that is the text or the letter of an option; its index.
    AnswerText(usize),
    /// A `verify` object without any comparison.
    ClaimsNothing,
    /// A definition has claims.
    ClaimsInDefinition,
    /// A definition has no name, or the name of another one.
    NoDefinitionName(String),
    /// A lab fence that contains a quiz; with the correct opening line.
    HoldsQuiz(String),
    /// A quiz fence that contains a lab; with the correct opening line.
    HoldsLab(String),
    /// An empty fence.
    EmptyFence,
    /// An object that is neither a lab nor a quiz.
    UnknownObject,
    /// A file larger than the limit.
    TooLarge,
}

/// The expected type of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Expected {
    /// A text.
    Text,
    /// A number.
    Number,
    /// `true` or `false`.
    Flag,
    /// A number, a text or a boolean.
    Scalar,
    /// A list.
    List,
    /// An object.
    Object,
}

/// The key that an unknown key probably means.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Meant {
    /// A key that the object already has.
    There(&'static str),
    /// A key that accepts this type of value; the value is read as its value.
    Likely(&'static str),
    /// A key that expects another type.
    Other {
        /// The key.
        key: &'static str,
        /// The type that it expects, for messages.
        takes: &'static str,
    },
    /// Unknown; with the keys that are possible.
    Unclear(Vec<&'static str>),
}

impl Mistake {
    /// The problem at this byte range of the file.
    pub(super) fn at(self, span: Range<usize>) -> Problem {
        Problem::Format(FormatProblem { span, mistake: self, in_verify: false })
    }
}
