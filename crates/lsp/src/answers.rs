//! What all requests share: their results, their errors, and the document that they are about.

use super::convert;
use super::documents::OpenDocument;
use super::state::ServerState;
use lsp_server::{ErrorCode, ResponseError};
use lsp_types::{TextDocumentIdentifier, TextDocumentPositionParams};

/// The result of a request.
pub(super) type Answer<T> = Result<T, ResponseError>;

pub(super) fn error(code: ErrorCode, message: impl Into<String>) -> ResponseError {
    ResponseError { code: code as i32, message: message.into(), data: None }
}

pub(super) fn not_open() -> ResponseError {
    error(ErrorCode::InvalidParams, "this document is not open")
}

pub(super) fn open_document<'s>(
    state: &'s ServerState<'_>,
    id: &TextDocumentIdentifier,
) -> Answer<&'s OpenDocument> {
    state.documents.get(id.uri.as_str()).ok_or_else(not_open)
}

/// The byte of the document to which a request refers.
pub(super) fn byte_at(state: &ServerState<'_>, params: &TextDocumentPositionParams) -> Answer<usize> {
    let document = open_document(state, &params.text_document)?;
    Ok(convert::byte_offset(document.content.file.text(), params.position))
}
