//! Code actions: for findings the fix, all safe fixes, or suppression with a reason; for numbers a claim.

use super::convert;
use super::diagnostic::diagnostic;
use super::documents::OpenDocument;
use super::edits::workspace_edit;
use super::lenses::prove;
use labspec::bind::scene::Models;
use labspec::finding::Finding;
use labspec::spec::Lesson;
use labspec_assist::fixes::{fix, fix_all, suppression};
use labspec_assist::{FixKind, TextFix, unclaimed_numbers};
use lsp_types::{CodeAction, CodeActionKind, CodeActionOrCommand};
use std::ops::Range;

/// All safe fixes of a document at once.
const FIX_ALL: CodeActionKind = CodeActionKind::new("source.fixAll.labspec");

/// The code actions for a range of a document. `only` are the requested kinds; without it, all kinds are returned.
pub(super) fn code_actions(
    document: &OpenDocument,
    lesson: Option<&Lesson>,
    span: &Range<usize>,
    only: Option<&[CodeActionKind]>,
    models: &Models,
) -> Vec<CodeActionOrCommand> {
    let only = only.unwrap_or_default();
    let includes = |requested: &CodeActionKind, kind: &CodeActionKind| {
        let rest = kind.as_str().strip_prefix(requested.as_str());
        rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
    };
    let requested = |kind: &CodeActionKind| only.is_empty() || only.iter().any(|o| includes(o, kind));
    let touches = |f: &&Finding| f.span.start <= span.end && span.start <= f.span.end;
    let content = &document.content;
    let mut all = Vec::new();
    let findings = content.all_findings();
    let here = || findings.iter().filter(touches);
    if requested(&CodeActionKind::QUICKFIX) {
        let found = here().filter_map(|f| Some(quick_fix(document, f, fix(&content.file, f)?)));
        all.extend(found);
        let suppressed = |f: &Finding| Some(quick_fix(document, f, suppression(lesson?, f)?));
        all.extend(here().filter_map(suppressed));
    }
    if requested(&CodeActionKind::SOURCE_FIX_ALL) {
        let whole = lesson.and_then(|lesson| fix_all(content, lesson, models));
        all.extend(whole.map(|fix| CodeAction {
            title: format!("labspec: {}", fix.title),
            kind: Some(FIX_ALL),
            edit: Some(workspace_edit(document, fix.edit)),
            ..CodeAction::default()
        }));
    }
    all.into_iter().map(CodeActionOrCommand::from).collect()
}

/// The action that claims the numbers of a line, if the range touches one without a claim.
pub(super) fn proof_action(
    document: &OpenDocument,
    lesson: &Lesson,
    span: &Range<usize>,
) -> Option<CodeActionOrCommand> {
    let file = &lesson.file;
    let line = file.line_span(file.position(span.start).line)?;
    // This request follows every movement of the cursor, and most lines have no number.
    if !file.slice(line.clone()).contains(|c: char| c.is_ascii_digit()) {
        return None;
    }
    let mut numbers = unclaimed_numbers(lesson);
    numbers.retain(|number| line.start <= number.start && number.start <= line.end);
    let touches = |number: &Range<usize>| number.start <= span.end && span.start <= number.end;
    if !numbers.iter().any(touches) {
        return None;
    }
    let line = convert::position(file, line.start).line;
    let command = prove(numbers.len(), document.uri.as_str(), line);
    Some(CodeActionOrCommand::CodeAction(CodeAction {
        title: command.title.clone(),
        kind: Some(CodeActionKind::QUICKFIX),
        command: Some(command),
        ..CodeAction::default()
    }))
}

/// An action that resolves a finding.
fn quick_fix(document: &OpenDocument, f: &Finding, fix: TextFix) -> CodeAction {
    CodeAction {
        title: fix.title,
        kind: Some(CodeActionKind::QUICKFIX),
        diagnostics: Some(vec![diagnostic(f, &document.content.file, &document.uri)]),
        edit: Some(workspace_edit(document, fix.edit)),
        is_preferred: (fix.kind != FixKind::Suppression).then_some(fix.kind == FixKind::Safe),
        ..CodeAction::default()
    }
}
