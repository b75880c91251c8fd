//! Code lenses: the results of the last check above labs and runs, and above lines with numbers that no claim covers.

use super::convert;
use super::documents::OpenDocument;
use labspec::spec::Lesson;
use labspec_assist::{Lens, LensKind, run_lenses, unclaimed_lenses};
use lsp_types::{CodeLens, Command};
use serde_json::{Value, json};

/// Runs the labs and the claims of a lesson. The argument is the URI of the document.
pub(super) const CHECK: &str = "labspec.check";
/// Claims the numbers of a line with what `trace` finds. The arguments are the URI of the document, and the line from 0.
pub(super) const PROVE: &str = "labspec.prove";

/// Which lenses are wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct LensChoice {
    /// Results of runs.
    pub(super) values: bool,
    /// Numbers without a claim.
    pub(super) proofs: bool,
}

/// The lenses of a lesson.
pub(super) fn code_lenses(document: &OpenDocument, lesson: &Lesson, choice: LensChoice) -> Vec<CodeLens> {
    let mut all = Vec::new();
    if choice.values {
        all.extend(run_lenses(lesson, &document.values));
    }
    if choice.proofs {
        all.extend(unclaimed_lenses(lesson));
    }
    all.sort_by_key(|lens| lens.span.start);
    all.into_iter().map(|lens| code_lens(document, lens)).collect()
}

fn code_lens(document: &OpenDocument, lens: Lens) -> CodeLens {
    let range = convert::range(&document.content.file, &lens.span);
    let uri = document.uri.as_str();
    let command = match lens.kind {
        LensKind::Result(text) => command(text, CHECK, vec![json!(uri)]),
        LensKind::NotRun => command("run".to_string(), CHECK, vec![json!(uri)]),
        LensKind::Unclaimed(count) => prove(count, uri, range.start.line),
    };
    CodeLens { range, command: Some(command), data: None }
}

/// The command that claims the numbers of a line.
pub(super) fn prove(count: usize, uri: &str, line: u32) -> Command {
    let title = if count == 1 { "prove this number" } else { "prove these numbers" };
    command(title.to_string(), PROVE, vec![json!(uri), json!(line)])
}

fn command(title: String, name: &str, arguments: Vec<Value>) -> Command {
    Command { title, command: name.to_string(), arguments: Some(arguments) }
}
