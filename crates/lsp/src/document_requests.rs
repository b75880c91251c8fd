//! Requests about a whole document, or a part of its lines: the outline, folds, formatting, lenses and hints.

use super::answers::{Answer, not_open, open_document};
use super::convert;
use super::hints::hints;
use super::lenses::{LensChoice, code_lenses};
use super::outline::{folding_ranges, symbols};
use super::state::ServerState;
use labspec::spec::Lesson;
use labspec_assist::formatting;
use lsp_types::{
    CodeLens, CodeLensParams, DocumentFormattingParams, DocumentRangeFormattingParams, DocumentSymbol,
    DocumentSymbolParams, FoldingRange, FoldingRangeParams, InlayHint, InlayHintParams,
    TextDocumentIdentifier, TextEdit,
};
use std::ops::Range;
use std::sync::Arc;

/// The lesson of an open document; `None` if the document is not a lesson.
fn lesson(state: &mut ServerState<'_>, id: &TextDocumentIdentifier) -> Answer<Option<Arc<Lesson>>> {
    let (document, context) = state.document_in_context(&id.uri).ok_or_else(not_open)?;
    Ok(document.content.read_lesson(context))
}

pub(super) fn list_symbols(
    state: &mut ServerState<'_>,
    params: DocumentSymbolParams,
) -> Answer<Vec<DocumentSymbol>> {
    Ok(lesson(state, &params.text_document)?.map_or(Vec::new(), |lesson| symbols(&lesson)))
}

pub(super) fn list_folds(
    state: &mut ServerState<'_>,
    params: FoldingRangeParams,
) -> Answer<Vec<FoldingRange>> {
    Ok(lesson(state, &params.text_document)?.map_or(Vec::new(), |lesson| folding_ranges(&lesson)))
}

pub(super) fn format_document(
    state: &mut ServerState<'_>,
    params: DocumentFormattingParams,
) -> Answer<Option<Vec<TextEdit>>> {
    format_within(state, &params.text_document, None)
}

pub(super) fn format_range(
    state: &mut ServerState<'_>,
    params: DocumentRangeFormattingParams,
) -> Answer<Option<Vec<TextEdit>>> {
    let document = open_document(state, &params.text_document)?;
    let span = convert::byte_span(document.content.file.text(), params.range);
    format_within(state, &params.text_document, Some(&span))
}

fn format_within(
    state: &mut ServerState<'_>,
    id: &TextDocumentIdentifier,
    within: Option<&Range<usize>>,
) -> Answer<Option<Vec<TextEdit>>> {
    let (document, context) = state.document_in_context(&id.uri).ok_or_else(not_open)?;
    let Some(lesson) = document.content.read_lesson(context) else { return Ok(None) };
    let edits = formatting(&lesson, context.models.folder(), within).into_iter();
    let edit = |edit: labspec_assist::Edit| TextEdit {
        range: convert::range(&lesson.file, &edit.span),
        new_text: edit.text,
    };
    Ok(Some(edits.map(edit).collect()))
}

pub(super) fn list_lenses(state: &mut ServerState<'_>, params: CodeLensParams) -> Answer<Vec<CodeLens>> {
    let Some(lesson) = lesson(state, &params.text_document)? else { return Ok(Vec::new()) };
    let choice = LensChoice {
        values: state.settings.lens_values,
        proofs: state.settings.lens_proofs && state.editor.applies_edits,
    };
    Ok(code_lenses(open_document(state, &params.text_document)?, &lesson, choice))
}

pub(super) fn list_inlay_hints(
    state: &mut ServerState<'_>,
    params: InlayHintParams,
) -> Answer<Vec<InlayHint>> {
    if !state.settings.units {
        return Ok(Vec::new());
    }
    let document = open_document(state, &params.text_document)?;
    let span = convert::byte_span(document.content.file.text(), params.range);
    let (document, context) = state.document_in_context(&params.text_document.uri).ok_or_else(not_open)?;
    Ok(hints(document, context, &span))
}
