//! Labs, quizzes and lessons as typed values.
//!
//! Every key has its type and default from the lab format; every string that is code or HTML is a
//! [`Text`](crate::source::Text), so that a place inside it is a place of the lesson. Reading never fails: what is wrong is
//! a finding, and what is right is still there for the other checks.

mod control;
mod encoding;
mod fields;
pub mod format;
mod kind;
mod lab;
mod lesson;
mod plot;
mod quiz;
mod verify;

pub use control::{Action, Choice, Control, ControlKind};
pub use encoding::{load_lesson_file, not_utf8};
pub use kind::{FileKind, kind_of};
pub use lab::{Camera, Expect, Form, Lab, Scene};
pub use lesson::{LabAddress, LabEntry, Lesson, MAX_FINDINGS, Widget, load_lesson};
pub use plot::{Plot, Readout, RefLine, Trace};
pub use quiz::{ChoiceStyle, Question, QuestionKind, Quiz};
pub use verify::{Exact, Run, Said, Verify, VerifyLab};
