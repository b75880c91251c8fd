//! Labs, quizzes and lessons as typed values.
//!
//! Every key has its type and default from the lab format; every string that is code or HTML is a
//! [`Text`](crate::source::Text), so that a place inside it is a place of the lesson. Reading never fails: what is wrong is
//! a problem with its place, and what is right is still there for the checks.

mod address;
mod allow;
mod allowances;
mod claim;
mod comment;
mod control;
mod fields;
pub mod format;
mod kind;
mod lab;
mod lesson;
mod plot;
mod problem;
mod quiz;
mod read;
mod read_claim;
mod read_lab;
mod read_lesson;
mod shared;
mod verify;

pub use address::LabAddress;
pub use allow::Allowance;
pub use claim::{Change, Column, Exact, Find, MOST_SWEPT, Said, Stands, Sweep};
pub use comment::Remark;
pub use control::{Action, Choice, Control, ControlKind};
pub use kind::{FileKind, kind_of};
pub use lab::{Camera, Expect, Form, Lab, ModelSource, Run, Verify, VerifyLab};
pub use lesson::{LabEntry, Lesson, Other, Widget};
pub use plot::{Plot, Readout, RefLine, Trace};
pub use problem::{Expected, Meant, Misfit, Mistake, Problem};
pub use quiz::{ChoiceStyle, Question, QuestionKind, Quiz};
pub(crate) use read_lesson::read_lab_json;
pub use read_lesson::{read_lesson, read_other};
