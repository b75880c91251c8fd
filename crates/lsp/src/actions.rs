//! Code actions for findings: the fix, all safe fixes, or suppression with a reason.

use super::convert;
use super::diagnostic::diagnostic;
use super::documents::OpenDocument;
use labspec::bind::scene::Models;
use labspec::check::{self, CheckLevel};
use labspec::finding::{Applicability, Finding, Fix};
use labspec::lint::reload_lesson;
use labspec::repair::{CheckedText, repair as repair_text, traces};
use labspec::spec::{FileKind, Lesson};
use lsp_types::{
    CodeAction, CodeActionKind, CodeActionOrCommand, DocumentChanges, OneOf,
    OptionalVersionedTextDocumentIdentifier, TextDocumentEdit, TextEdit, WorkspaceEdit,
};
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
    let includes = |wanted: &CodeActionKind, kind: &CodeActionKind| {
        let rest = kind.as_str().strip_prefix(wanted.as_str());
        rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
    };
    let wanted = |kind: &CodeActionKind| only.is_empty() || only.iter().any(|o| includes(o, kind));
    let touches = |f: &&Finding| f.span.start <= span.end && span.start <= f.span.end;
    let mut all = Vec::new();
    let here = || document.findings.iter().filter(touches);
    if wanted(&CodeActionKind::QUICKFIX) {
        for f in here() {
            all.extend(f.fix.as_ref().and_then(|fix| apply_fix(document, f, fix)));
        }
        for f in here().filter(|f| !f.is_error()) {
            all.extend(lesson.and_then(|lesson| suppress(document, lesson, f)));
        }
    }
    if wanted(&CodeActionKind::SOURCE_FIX_ALL) {
        all.extend(lesson.and_then(|lesson| fix_all(document, lesson, models)));
    }
    all.into_iter().map(CodeActionOrCommand::from).collect()
}

/// The action that applies the fix of a finding.
fn apply_fix(document: &OpenDocument, f: &Finding, fix: &Fix) -> Option<CodeAction> {
    let file = &document.file;
    let (old, new) = (shorten(file.slice(fix.span.clone())), shorten(&fix.text));
    let change = match (old.is_empty(), new.is_empty()) {
        (true, _) => format!("write `{new}`"),
        (_, true) => format!("delete `{old}`"),
        _ => format!("write `{new}` instead of `{old}`"),
    };
    let (title, is_preferred) = match fix.applicability {
        Applicability::Safe => (change, true),
        Applicability::Unsafe => (format!("{change} (a guess)"), false),
        Applicability::Display => return None,
    };
    let edit = workspace_edit(document, fix.span.clone(), fix.text.clone());
    Some(CodeAction { is_preferred: Some(is_preferred), ..quick_fix(document, f, title, edit) })
}

/// An action that resolves a finding.
fn quick_fix(document: &OpenDocument, f: &Finding, title: String, edit: WorkspaceEdit) -> CodeAction {
    CodeAction {
        title,
        kind: Some(CodeActionKind::QUICKFIX),
        diagnostics: Some(vec![diagnostic(f, &document.file, &document.uri)]),
        edit: Some(edit),
        ..CodeAction::default()
    }
}

/// A text that fits into a menu.
fn shorten(text: &str) -> String {
    let line = text.lines().next().unwrap_or("");
    let cut: String = line.chars().take(40).collect();
    if cut.len() < text.len() { format!("{cut}…") } else { cut }
}

/// An edit that replaces a span of the document, in the version that the editor has.
fn workspace_edit(document: &OpenDocument, span: Range<usize>, new_text: String) -> WorkspaceEdit {
    let edit = TextEdit { range: convert::range(&document.file, &span), new_text };
    let edits = TextDocumentEdit {
        text_document: OptionalVersionedTextDocumentIdentifier {
            uri: document.uri.clone(),
            version: Some(document.version),
        },
        edits: vec![OneOf::Left(edit)],
    };
    WorkspaceEdit { document_changes: Some(DocumentChanges::Edits(vec![edits])), ..WorkspaceEdit::default() }
}

/// The action that applies all verified safe fixes at once.
fn fix_all(document: &OpenDocument, lesson: &Lesson, models: &Models) -> Option<CodeAction> {
    let is_safe = |f: &Finding| f.fix.as_ref().is_some_and(|fix| fix.applicability == Applicability::Safe);
    if !document.findings.iter().any(is_safe) {
        return None;
    }
    let level = CheckLevel { programs: true, ..CheckLevel::STATIC };
    let load = |text: &str| reload_lesson(lesson, text, models.folder());
    let check_text = |text: &str| {
        let lesson = load(text);
        let broken = lesson.broken.len();
        CheckedText {
            text: text.to_string(),
            findings: check::check_lesson(lesson, models, level).findings,
            broken,
        }
    };
    let old = lesson.file.text();
    // Findings that require runs of the labs are not computed again.
    let now = CheckedText {
        text: old.to_string(),
        findings: check_text(old).findings,
        broken: lesson.broken.len(),
    };
    let (new, made) = repair_text(now, false, &check_text, &|text| traces(&load(text), models));
    if made == 0 {
        return None;
    }
    let (span, text) = changed(old, &new);
    Some(CodeAction {
        title: "labspec: apply all safe fixes".to_string(),
        kind: Some(FIX_ALL),
        edit: Some(workspace_edit(document, span, text)),
        ..CodeAction::default()
    })
}

/// The range in which two texts differ, and the replacement from the second one.
fn changed(old: &str, new: &str) -> (Range<usize>, String) {
    let start: usize =
        old.chars().zip(new.chars()).take_while(|(a, b)| a == b).map(|(c, _)| c.len_utf8()).sum();
    let (old_rest, new_rest) = (old.get(start..).unwrap_or(""), new.get(start..).unwrap_or(""));
    let same = old_rest.chars().rev().zip(new_rest.chars().rev()).take_while(|(a, b)| a == b);
    let end: usize = same.map(|(c, _)| c.len_utf8()).sum();
    (start..old.len() - end, new_rest.get(..new_rest.len() - end).unwrap_or("").to_string())
}

/// The action that suppresses a finding. It adds the code to the `lint` of the lab, the question or the quiz, where the author
/// writes the reason; for prose, it inserts a comment before the text.
fn suppress(document: &OpenDocument, lesson: &Lesson, f: &Finding) -> Option<CodeAction> {
    let file = &document.file;
    if lesson.is_broken(&f.span) {
        return None;
    }
    let holds = |span: &Range<usize>| span.start <= f.span.start && f.span.start < span.end;
    let labs = lesson.all_labs().into_iter().map(|lab| (lab.span.clone(), lab.lint.clone()));
    let questions = lesson.quizzes.iter().flat_map(|quiz| {
        let whole = std::iter::once((quiz.span.clone(), quiz.lint.clone()));
        whole.chain(quiz.numbered().map(|(_, q)| (q.span.clone(), q.lint.clone())))
    });
    let object =
        labs.chain(questions).filter(|(span, _)| holds(span)).min_by_key(|(span, _)| span.end - span.start);
    let (at, text) = match object {
        Some((_, Some(lint))) => {
            // Adds a code to an existing list.
            let (_, last) = lint.codes.last()?;
            (last.end + 1, format!(", \"{}\"", f.code))
        }
        Some((span, None)) => {
            let inside = file.slice(span.start + 1..span.end);
            let gap = inside.get(..inside.find(['"', '}'])?)?;
            let comma = if inside.trim_start().starts_with('}') { "" } else { "," };
            (span.start + 1, format!("{gap}\"lint\": {{\"allow\": [\"{}\"], \"why\": \"\"}}{comma}", f.code))
        }
        None if document.kind == FileKind::Lesson => {
            let line = file.position(f.span.start).line;
            // Before the paragraph or the block, where a comment is valid.
            let empty =
                |line: usize| file.line_span(line).is_none_or(|span| file.slice(span).trim().is_empty());
            let block =
                lesson.scan.blocks.iter().find(|b| holds(&b.span)).map(|b| file.position(b.span.start).line);
            let first =
                block.unwrap_or_else(|| (1..=line).rev().find(|l| *l == 1 || empty(l - 1)).unwrap_or(line));
            let end = if file.text().contains("\r\n") { "\r\n" } else { "\n" };
            (file.line_span(first)?.start, format!("<!-- labspec allow {}:  -->{end}", f.code))
        }
        None => return None,
    };
    let title = format!("suppress `{}` here, with a reason", f.code);
    Some(quick_fix(document, f, title, workspace_edit(document, at..at, text)))
}
