//! Labs, quizzes and lessons as typed values.
//!
//! The types and defaults of the keys are those of the lab format. Every string with code or HTML is a
//! [`Text`](crate::source::Text), so that positions in it map to positions in the lesson. Reading never fails: errors
//! become problems with a position, and the valid parts remain available for the checks.

mod address;
mod allow;
mod allowances;
mod answer_key;
mod claim;
mod comment;
mod control;
mod conventions;
mod fields;
pub mod format;
mod integrators;
mod kind;
mod lab;
mod lesson;
mod plot;
mod problem;
mod quiz;
mod read;
mod read_claim;
mod read_comments;
mod read_lab;
mod read_lesson;
mod shared;
mod sources;
mod verify;

pub use address::LabAddress;
pub use allow::Allowance;
pub use answer_key::{AnswerHash, AnswerKey, KeyValue};
pub use claim::{
    Change, Column, ColumnCells, Exact, Find, MOST_AXES, MOST_SWEPT, QuotedClaim, Sweep, SweepAxis,
    SweepValue,
};
pub use comment::{ClaimComment, Definition};
pub(crate) use comment::{UnreadComment, claims_in_comments, unread_comments};
pub use control::{Action, Choice, Control, ControlKind};
pub use conventions::Conventions;
pub use integrators::{ENERGY_DRIFT, INTEGRATOR};
pub use kind::{FileKind, kind_of};
pub use lab::{
    BreakExpectation, Camera, CodeForm, Comparison, Expect, Lab, ModelSource, Run, UsedObject, Verify,
    VerifyLab,
};
pub use lesson::{DataFile, LabEntry, Lesson, Other, Widget};
pub use plot::{Plot, Readout, RefLine, Trace};
pub use problem::{Expected, FormatProblem, Meant, Mistake, Problem};
pub use quiz::{ChoiceStyle, Question, QuestionKind, Quiz};
pub(crate) use read_lesson::read_lab_json;
pub use read_lesson::{read_lesson, read_lesson_in, read_other};
