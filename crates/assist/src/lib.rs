//! What an editor of lessons and models shows: findings while an author types, their fixes, completions and hover texts.
//!
//! Input is a text, the models around it, and a byte offset; output are plain values with byte ranges of the text. The server of
//! editors (`labspec-lsp`) translates them to its protocol, the checker of pages (`bindings/wasm`) to JavaScript.
//!
//! * [`Document`]: a text with its kind, its lesson and its findings; [`Context`]: the models and lessons around it
//! * `check`: findings while typing; [`fix`](fixes::fix), [`suppression`](fixes::suppression), [`fix_all`](fixes::fix_all):
//!   edits that resolve them
//! * [`completions`], [`hover`], [`signature_help`]: of lessons, of their programs (`complete_code`), and of MJCF (`mjcf`)
//! * [`outline`], [`folds`]: the parts of a lesson; [`formatting`]: its code as `labspec fmt` writes it
//! * [`run_lenses`], [`unclaimed_lenses`]: what stands above a line: values of the last check, numbers without a claim
//! * [`code`]: the programs in a lesson; [`elements`]: the names in a model; `start`: labs at their start
//! * [`lab_texts`]: the labs of a lesson, each as a text of its own
//! * [`EditorText`]: the answers for an editor on a page, as JSON: `bindings/wasm` and the server of the preview send them
//! * [`Utf16Offsets`]: offsets as JavaScript counts them
#![forbid(unsafe_code)]

mod answer;
mod check;
pub mod code;
mod complete;
mod complete_code;
mod document;
pub mod elements;
pub mod fixes;
mod folding;
mod formatting;
mod hover;
mod item;
mod labs;
mod lenses;
mod mjcf;
mod outline;
mod signature;
mod start;
mod tag;
mod utf16;

#[cfg(test)]
mod complete_tests;
#[cfg(test)]
mod hostile_tests;

pub use answer::{CompletionAnswer, EditAnswer, EditorText, FindingAnswer, FixAnswer, HoverAnswer};
pub use check::{check_claims_of, reported};
pub use complete::completions;
pub use document::{Context, Document, DocumentText};
pub use folding::{folded_lines, folds};
pub use formatting::formatting;
pub use hover::hover;
pub use item::{
    Completion, CompletionKind, Edit, FixKind, Fold, FoldKind, Hover, OutlineItem, OutlineKind, TextFix,
};
pub use labs::{LabText, lab_texts};
pub use lenses::{Lens, LensKind, RunValues, run_lenses, run_values, unclaimed_lenses, unclaimed_numbers};
pub use outline::outline;
pub use signature::signature_help;
pub use utf16::Utf16Offsets;
