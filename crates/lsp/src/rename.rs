//! Renames an element of a model, in the model and in all labs and claims that refer to it. If the meaning of a text is
//! uncertain, nothing is changed, and the response contains the reason.

use super::convert;
use super::names::{Occurrence, Occurrences, QualifiedName, SearchScope};
use labspec::source::SourceFile;
use lsp_types::TextEdit;
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::Path;

/// The response to a rename: a `WorkspaceEdit` in which the order of files is deterministic, unlike that of `lsp_types`.
#[derive(Debug, Default, Serialize)]
pub(super) struct FileEdits {
    /// The edits of each file, by URI.
    changes: BTreeMap<String, Vec<TextEdit>>,
}

/// Returns all edits for the new name.
///
/// # Errors
/// A sentence for the author: the name is invalid or in use, or some text with the old name is ambiguous.
pub(super) fn rename(
    name: &QualifiedName,
    found: &Occurrences,
    new: &str,
    scope: &SearchScope<'_>,
) -> Result<FileEdits, String> {
    let QualifiedName { noun, name: old, .. } = name;
    validate_name(new)?;
    if found.all.iter().filter(|occurrence| occurrence.defines).count() != 1 {
        return Err(format!("the model does not define the {noun} `{old}` in exactly one place"));
    }
    if let Some(ambiguity) = found.ambiguities.first() {
        return Err(format!(
            "{}: {}; nothing was changed",
            describe_position(&ambiguity.file, ambiguity.span.start),
            ambiguity.why
        ));
    }
    if let Some(escaped) = found.all.iter().find(|occurrence| !occurrence.plain) {
        let position = describe_position(&escaped.file, escaped.span.start);
        return Err(format!("{position}: the name is written with escapes here, so nothing was changed"));
    }
    let key = |occurrence: &Occurrence| (occurrence.file.path().clone(), occurrence.span.start);
    let mut occurrences: Vec<&Occurrence> = found.all.iter().collect();
    occurrences.sort_by_key(|occurrence| key(occurrence));
    occurrences.dedup_by_key(|occurrence| key(occurrence));
    let mut edits = FileEdits::default();
    for Occurrence { file, span, .. } in occurrences {
        let uri =
            scope.uri(Path::new(&**file.path())).ok_or_else(|| format!("`{}` has no URI", file.path()))?;
        let edit = TextEdit { range: convert::range(file, span), new_text: new.to_string() };
        edits.changes.entry(uri.as_str().to_string()).or_default().push(edit);
    }
    Ok(edits)
}

/// Checks that a name needs no escapes in MJCF, JSON or the language.
fn validate_name(new: &str) -> Result<(), String> {
    if new.is_empty() || new.trim() != new {
        return Err("a name needs at least one character, and no spaces around it".into());
    }
    match new.chars().find(|c| c.is_control() || "\"'`\\<>&/".contains(*c)) {
        Some(c) => Err(format!("a name cannot contain `{}`, which would need an escape", c.escape_default())),
        None => Ok(()),
    }
}

fn describe_position(file: &SourceFile, byte: usize) -> String {
    format!("{}, line {}", file.path(), file.position(byte).line)
}
