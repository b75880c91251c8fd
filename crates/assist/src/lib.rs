//! What an editor of lessons and models shows: findings while an author types, their fixes, completions and hover texts.
//!
//! Input is a text, the models around it, and a byte offset; output are plain values with byte ranges of the text. The server of
//! editors (`labspec-lsp`) translates them to its protocol, the checker of pages (`bindings/wasm`) to JavaScript.
//!
//! * [`Document`]: a text with its kind, its lesson and its findings; [`Context`]: the models and lessons around it
//! * `check`: findings while typing; [`fix`](fixes::fix), [`suppression`](fixes::suppression), [`fix_all`](fixes::fix_all):
//!   edits that resolve them
//! * [`completions`], [`hover`]: of lessons, of their programs, and of MJCF (`mjcf`)
//! * [`code`]: the programs in a lesson; [`elements`]: the names in a model; `start`: labs at their start
//! * [`lab_texts`]: the labs of a lesson, each as a text of its own
//! * [`EditorText`]: the answers for an editor on a page, as JSON: `bindings/wasm` and the server of the preview send them
//! * [`Utf16Offsets`]: offsets as JavaScript counts them
#![forbid(unsafe_code)]

mod answer;
mod check;
pub mod code;
mod complete;
mod document;
pub mod elements;
pub mod fixes;
mod hover;
mod item;
mod labs;
mod mjcf;
mod start;
mod tag;
mod utf16;

pub use answer::{CompletionAnswer, EditAnswer, EditorText, FindingAnswer, FixAnswer, HoverAnswer};
pub use complete::completions;
pub use document::{Context, Document};
pub use hover::hover;
pub use item::{Completion, CompletionKind, Edit, FixKind, Hover, TextFix};
pub use labs::{LabText, lab_texts};
pub use utf16::Utf16Offsets;
